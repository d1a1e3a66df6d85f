#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "world/vdb/export.h"
#include "world/vdb_import/import.h"

namespace skerry::tools {

struct VdbImportOptions {
  std::filesystem::path file, out;
  world::ImportOptions how;
  bool json = false;
};
/// `skerry vdb import`: makes a world file of a .vdb file and prints what became of each grid.
/// JSON: {"islands": [{grid, blocks, chunks, threshold, error_blocks, unknown_ids, origin,
/// yaw_deg, box_min, box_max}], "read_s", "import_s", "write_s", "bytes_per_s"}.
/// @return exit status.
int vdb_import(const VdbImportOptions& options);

struct VdbExportOptions {
  std::string seed_text = "1";
  std::optional<std::string> world;    ///< a file in place of a seed
  std::optional<world::BlockBox> box;  ///< none: all islands of a world that no seed made
  std::filesystem::path out;
  bool partial = false;  ///< a damaged world's rest, too
};
/// `skerry vdb export`: writes islands to a .vdb file. @return exit status: kFailed for a world
/// that has lost something, unless a part is enough.
int vdb_export(const VdbExportOptions& options);

}  // namespace skerry::tools
