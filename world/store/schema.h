// The tables of a world file, and how older ones become newer ones. Private to world/store.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "world/store/chunk_blob.h"
#include "world/store/database.h"

namespace skerry::world {

/// "Skry", SQLite's application_id of a world file.
inline constexpr std::uint32_t kApplicationId = 0x536b7279;

/// Makes the tables of an empty file. @return SQLITE_OK or an error.
int make_schema(Database& file);
/// What a connection needs before its first question. @return SQLITE_OK or an error.
int set_up(Database& file, bool writes);
/// Checks that the file has the tables of its version and nothing else; with `migrate`, brings an
/// older one up to date, all of it or nothing.
/// @param version the one it has now. @return SQLITE_OK, SQLITE_CORRUPT for strange tables, or
/// another error. A version newer than this program's is no error, and its tables are not looked
/// at.
int check_schema(Database& file, bool migrate, int& version);
/// After each commit that counts: ends the log behind it with a commit without content, so that
/// none of its own frames is the last and damage to any of them shows (log.h); then brings all of
/// it into the file and empties the log, as far as readers allow.
/// @return SQLITE_OK or an error: what was committed is not safe.
int settle(Database& file);
/// Whether all pages hang together. Reads all of them. @return SQLITE_OK, SQLITE_CORRUPT if they do
/// not, or another error.
int check_whole(Database& file);

/// Replaces a row of `value`. @return SQLITE_OK or an error.
int write_value(Database& file, std::string_view name, std::span<const std::byte> bytes);
/// Keeps something a second time, where damage to its first place does not reach it.
/// @return SQLITE_OK or an error.
int write_spare(Database& file, std::uint64_t key, std::span<const std::byte> bytes);
/// What was kept so. None: nothing, or it is damaged, too.
std::optional<std::vector<std::byte>> read_spare(Database& file, std::uint64_t key);
/// Names a chunk in a statement's first four places.
void bind_name(Statement& statement, const ChunkName& name);
/// The name of a value, as its checksum covers it.
std::uint64_t name_key(std::string_view name);
/// A name for SQLite to read a file as an immutable one.
std::string immutable_uri(const std::filesystem::path& path);

}  // namespace skerry::world
