// How a .vdb file becomes a world, as typed.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "world/vdb_import/import.h"

namespace skerry::game {

/// Whether a path names a .vdb file, by its ending.
bool is_vdb(const std::filesystem::path& path);

/// A SHA-256 as 64 digits, upper or lower case. @return lower case. Errors: it is none.
Result<std::string> parse_sha256(const std::string& value, const std::string& named);

/// Sets one option: grid, scale, size, threshold, up or expect. @param named how messages name it.
/// Errors: no such key (names the nearest), no value that fits; scale and size exclude each other.
Result<void> set_import(std::string_view key, const std::string& value, const std::string& named,
                        world::ImportOptions& options);

/// The same of KEY=VALUE.
Result<void> apply_import(const std::string& assignment, world::ImportOptions& options);

/// What apply_import makes these options of.
std::vector<std::string> import_assignments(const world::ImportOptions& options);

}  // namespace skerry::game
