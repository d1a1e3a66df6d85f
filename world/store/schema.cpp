#include "world/store/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "world/store/bytes.h"
#include "world/store/rows.h"
#include "world/store/world_file.h"

namespace skerry::world {
namespace {

/// Tables in the order of the versions that brought them.
struct Table {
  int since;
  std::string_view name, sql;
};
constexpr std::array<Table, 4> kTables{
    {{1, "value", "CREATE TABLE value(name TEXT PRIMARY KEY, data BLOB NOT NULL)"},
     {1, "island",
      "CREATE TABLE island(id INTEGER PRIMARY KEY, added INTEGER NOT NULL, spec BLOB NOT NULL)"},
     {1, "chunk",
      "CREATE TABLE chunk(island INTEGER NOT NULL, x INTEGER NOT NULL, y INTEGER NOT NULL, "
      "z INTEGER NOT NULL, data BLOB NOT NULL, PRIMARY KEY(island, x, y, z)) WITHOUT ROWID"},
     {2, "motion", "CREATE TABLE motion(island INTEGER PRIMARY KEY, data BLOB NOT NULL)"}}};

/// Makes the tables that are newer than a version, and says so in the file.
int bring_up_to_date(Database& file, int from) {
  int code = file.run("BEGIN IMMEDIATE");
  for (const Table& table : kTables) {
    if (code == SQLITE_OK && table.since > from) code = file.run(std::string(table.sql).c_str());
  }
  if (code == SQLITE_OK)
    code = file.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}; COMMIT",
                                kApplicationId, WorldFile::kVersion)
                        .c_str());
  if (code != SQLITE_OK) file.run("ROLLBACK");
  return code;
}

/// Whether the tables are those of a version, letter for letter, and there is nothing else that a
/// hostile file might bring along: no view, no trigger.
int compare_schema(Database& file, int version, bool& same) {
  std::size_t found = 0;
  int code = SQLITE_OK;
  std::optional<Statement> select = file.prepare(
      "SELECT name, sql FROM sqlite_schema WHERE name NOT LIKE 'sqlite_autoindex%'", code);
  if (!select) return code;
  same = true;
  while ((code = select->step()) == SQLITE_ROW) {
    const auto table = std::find_if(kTables.begin(), kTables.end(), [&](const Table& t) {
      return t.since <= version && t.name == select->text(0) && t.sql == select->text(1);
    });
    same = same && table != kTables.end();
    ++found;
  }
  const auto expected = std::count_if(kTables.begin(), kTables.end(),
                                      [&](const Table& t) { return t.since <= version; });
  same = same && found == static_cast<std::size_t>(expected);
  return code == SQLITE_DONE ? SQLITE_OK : code;
}

}  // namespace

int make_schema(Database& file) {
  return bring_up_to_date(file, 0);
}

int set_up(Database& file, bool writes) {
  int code = file.run("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0");
  if (code == SQLITE_OK && writes)
    // A log, so that readers never wait for a writer; on the disk, not on its way there, when a
    // transaction is done.
    code = file.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
  return code;
}

Result<int> check_schema(Database& file, const std::filesystem::path& path, bool migrate) {
  std::int64_t version = 0;
  int code = file.integer("PRAGMA user_version", version);
  if (code != SQLITE_OK) return file_error("open", path, code);
  if (version > WorldFile::kVersion)
    return Error{fmt::format(
        "cannot open the world {}: a newer Skerry wrote it (its version is {}, this one knows {}); "
        "update Skerry",
        quoted(path), version, WorldFile::kVersion)};
  bool same = false;
  if (version > 0) code = compare_schema(file, static_cast<int>(version), same);
  if (code != SQLITE_OK || !same)
    return file_error("open", path, code == SQLITE_OK ? SQLITE_CORRUPT : code);
  if (version == WorldFile::kVersion || !migrate) return static_cast<int>(version);
  code = bring_up_to_date(file, static_cast<int>(version));
  if (code != SQLITE_OK) return file_error("update", path, code);
  return WorldFile::kVersion;
}

int write_value(Database& file, std::string_view name, std::span<const std::byte> bytes) {
  int code = SQLITE_OK;
  std::optional<Statement> insert =
      file.prepare("INSERT OR REPLACE INTO value(name, data) VALUES(?1, ?2)", code);
  if (!insert) return code;
  code = insert->bind(1, name).bind(2, sealed("value", name_key(name), bytes)).step();
  return code == SQLITE_DONE ? SQLITE_OK : code;
}

std::uint64_t name_key(std::string_view name) {
  return checksum(std::as_bytes(std::span(name)));
}

std::string immutable_uri(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       c == '/' || c == '.' || c == '-' || c == '_';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?immutable=1";
}

}  // namespace skerry::world
