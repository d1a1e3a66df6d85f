// The tables of a world file, and how older ones become newer ones. Private to world/store.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/result.h"
#include "world/store/database.h"

namespace skerry::world {

/// "Skry", SQLite's application_id of a world file.
inline constexpr std::uint32_t kApplicationId = 0x536b7279;

/// Makes the tables of an empty file. @return SQLITE_OK or an error.
int make_schema(Database& file);
/// What a connection needs before its first question. @return SQLITE_OK or an error.
int set_up(Database& file, bool writes);
/// Checks that the file has the tables of its version and nothing else; with `migrate`, brings an
/// older one up to date, all of it or nothing. @return the version it has now.
Result<int> check_schema(Database& file, const std::filesystem::path& path, bool migrate);

/// Replaces a row of `value`. @return SQLITE_OK or an error.
int write_value(Database& file, std::string_view name, std::span<const std::byte> bytes);
/// Under which a value's checksum knows its name.
std::uint64_t name_key(std::string_view name);
/// A name for SQLite to read a file as one that nobody writes.
std::string immutable_uri(const std::filesystem::path& path);

}  // namespace skerry::world
