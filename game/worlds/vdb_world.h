#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/vdb_options.h"
#include "world/islands/world.h"
#include "world/vdb_import/import.h"

namespace skerry::game {

/// What a .vdb file gave.
struct VdbIslands {
  std::vector<world::ImportedIsland> islands;
  std::vector<std::string>
      notes;  ///< for the user, one line each: what looks damaged, which grids it took
};

/// The islands of a .vdb file. Errors: those of world::read_vdb and world::import_islands, with the
/// file's name.
/// @param progress called with the share that is done.
Result<VdbIslands> islands_of_vdb(const std::filesystem::path& path,
                                  const world::ImportOptions& options,
                                  const world::ReadProgress& progress = {});

/// A world of the islands of a .vdb file and nothing else; notes go to stderr. Errors: as above.
Result<std::unique_ptr<world::World>> world_of_vdb(const std::filesystem::path& path,
                                                   const world::ImportOptions& options);

/// Writes a world file of imported islands: complete or not at all. Errors: the file is there
/// already, or cannot be written.
Result<void> save_imported(const std::vector<world::ImportedIsland>& islands,
                           const std::filesystem::path& path);

}  // namespace skerry::game
