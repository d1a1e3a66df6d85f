// The player's worlds as files in a folder.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace skerry::game {

/// A world file, without its voxels.
struct WorldEntry {
  std::filesystem::path path;
  std::string name, seed_text;
  std::int64_t played_s = 0;  ///< when it was written last, Unix time
  std::uint64_t bytes = 0;
  std::string problem;  ///< not empty: why it cannot be played, in one line
};

/// Those of a folder, the last played first. A folder that is not there holds none.
std::vector<WorldEntry> list_worlds(const std::filesystem::path& folder);

/// Deletes a world with all that belongs to it. Errors: it is being played, or cannot be deleted.
Result<void> remove_world(const std::filesystem::path& path);

/// Where a world's picture is, written when it is left.
std::filesystem::path picture_of_world(const std::filesystem::path& path);

}  // namespace skerry::game
