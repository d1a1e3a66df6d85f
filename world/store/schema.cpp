#include "world/store/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "world/store/bytes.h"
#include "world/store/page_bytes.h"
#include "world/store/rows.h"
#include "world/store/world_contents.h"

namespace skerry::world {
namespace {

/// Tables in the order of the versions that brought them.
struct Table {
  int since;
  std::string_view name, sql;
};
constexpr std::array<Table, 5> kTables{
    {{1, "value", "CREATE TABLE value(name TEXT PRIMARY KEY, data BLOB NOT NULL)"},
     {1, "island",
      "CREATE TABLE island(id INTEGER PRIMARY KEY, added INTEGER NOT NULL, spec BLOB NOT NULL)"},
     {1, "chunk",
      "CREATE TABLE chunk(island INTEGER NOT NULL, x INTEGER NOT NULL, y INTEGER NOT NULL, "
      "z INTEGER NOT NULL, data BLOB NOT NULL, PRIMARY KEY(island, x, y, z)) WITHOUT ROWID"},
     {2, "motion", "CREATE TABLE motion(island INTEGER PRIMARY KEY, data BLOB NOT NULL)"},
     {3, "spare", "CREATE TABLE spare(id INTEGER PRIMARY KEY, data BLOB NOT NULL)"}}};

/// Of a file from before there were spares: what cannot be done without gets one.
int make_spares(Database& file) {
  int code = SQLITE_OK;
  std::optional<Statement> values = file.prepare("SELECT name, data FROM value", code);
  while (values && (code = values->step()) == SQLITE_ROW) {
    const std::string name(values->text(0));
    const auto bytes = unsealed("value", name_key(name), values->blob(1));
    if (!is_vital(name) || !bytes) continue;
    if ((code = write_spare(file, name_key(name), *bytes)) != SQLITE_OK) return code;
  }
  if (code != SQLITE_DONE) return code;
  std::optional<Statement> islands = file.prepare("SELECT id, added, spec FROM island", code);
  while (islands && (code = islands->step()) == SQLITE_ROW) {
    const auto id = static_cast<std::uint64_t>(islands->integer(0));
    const bool added = islands->integer(1) != 0;
    const auto bytes = unsealed(added ? "added" : "island", id, islands->blob(2));
    const std::optional<IslandSpec> spec = bytes ? decode_spec(id, *bytes) : std::nullopt;
    if (!spec) continue;
    if ((code = write_spare(file, id, encode_spare({*spec, added, {}}))) != SQLITE_OK) return code;
  }
  return code == SQLITE_DONE ? SQLITE_OK : code;
}

/// Makes the tables that are newer than a version, and says so in the file.
int bring_up_to_date(Database& file, int from) {
  int code = file.run("BEGIN IMMEDIATE");
  for (const Table& table : kTables) {
    if (code == SQLITE_OK && table.since > from) code = file.run(std::string(table.sql).c_str());
  }
  if (code == SQLITE_OK && from > 0) code = make_spares(file);
  if (code == SQLITE_OK)
    code = file.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}; COMMIT",
                                kApplicationId, kWorldFileVersion)
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
  const int code = file.run(fmt::format("PRAGMA page_size = {}", kPageBytes).c_str());
  return code == SQLITE_OK ? bring_up_to_date(file, 0) : code;
}

int set_up(Database& file, bool writes) {
  int code = file.run("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0");
  // A log is brought into the file by settle() alone, never before it has its mark; and it has no
  // frames that are written again, whose checksums fit no more if a kill comes between.
  if (code == SQLITE_OK && writes)
    code = file.run("PRAGMA wal_autocheckpoint = 0; PRAGMA cache_spill = OFF");
  if (code == SQLITE_OK && writes)
    // What is taken away is overwritten: nothing that was undone is left for salvage() to find.
    // A log, so that readers never wait for a writer; on the disk, not on its way there, when a
    // transaction is done.
    code =
        file.run("PRAGMA secure_delete = ON; PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
  return code;
}

int check_schema(Database& file, bool migrate, int& version) {
  std::int64_t found = 0;
  int code = file.integer("PRAGMA user_version", found);
  version = static_cast<int>(found);
  if (code != SQLITE_OK || version > kWorldFileVersion) return code;
  bool same = false;
  if (version > 0) code = compare_schema(file, version, same);
  if (code == SQLITE_OK && !same) code = SQLITE_CORRUPT;
  if (code != SQLITE_OK || version == kWorldFileVersion || !migrate) return code;
  code = bring_up_to_date(file, version);
  if (code == SQLITE_OK) version = kWorldFileVersion;
  return code;
}

int settle(Database& file) {
  // Writes the first page, whether or not that changes.
  int code = file.run(fmt::format("PRAGMA user_version = {}", kWorldFileVersion).c_str());
  if (code != SQLITE_OK) return code;
  std::int64_t busy = 0;
  code = file.integer("PRAGMA wal_checkpoint(TRUNCATE)", busy);
  // The log keeps what the file has no room for, or what readers keep it from taking now.
  const int kind = code & 0xff;
  return kind == SQLITE_FULL || kind == SQLITE_BUSY || kind == SQLITE_LOCKED ? SQLITE_OK : code;
}

int check_whole(Database& file) {
  int code = SQLITE_OK;
  std::optional<Statement> check = file.prepare("PRAGMA quick_check(1)", code);
  if (check) code = check->step();
  if (code != SQLITE_ROW) return code == SQLITE_DONE ? SQLITE_OK : code;
  return check->text(0) == "ok" ? SQLITE_OK : SQLITE_CORRUPT;
}

int write_value(Database& file, std::string_view name, std::span<const std::byte> bytes) {
  int code = SQLITE_OK;
  std::optional<Statement> insert =
      file.prepare("INSERT OR REPLACE INTO value(name, data) VALUES(?1, ?2)", code);
  if (!insert) return code;
  code = insert->bind(1, name).bind(2, sealed("value", name_key(name), bytes)).step();
  if (code == SQLITE_DONE && is_vital(name)) return write_spare(file, name_key(name), bytes);
  return code == SQLITE_DONE ? SQLITE_OK : code;
}

void bind_name(Statement& statement, const ChunkName& name) {
  statement.bind(1, static_cast<std::int64_t>(name.island));
  statement.bind(2, std::int64_t{name.chunk.x});
  statement.bind(3, std::int64_t{name.chunk.y});
  statement.bind(4, std::int64_t{name.chunk.z});
}

int write_spare(Database& file, std::uint64_t key, std::span<const std::byte> bytes) {
  int code = SQLITE_OK;
  std::optional<Statement> insert =
      file.prepare("INSERT OR REPLACE INTO spare(id, data) VALUES(?1, ?2)", code);
  if (!insert) return code;
  code =
      insert->bind(1, static_cast<std::int64_t>(key)).bind(2, sealed("spare", key, bytes)).step();
  return code == SQLITE_DONE ? SQLITE_OK : code;
}

std::optional<std::vector<std::byte>> read_spare(Database& file, std::uint64_t key) {
  int code = SQLITE_OK;
  std::optional<Statement> select = file.prepare("SELECT data FROM spare WHERE id = ?1", code);
  if (!select || select->bind(1, static_cast<std::int64_t>(key)).step() != SQLITE_ROW)
    return std::nullopt;
  const auto bytes = unsealed("spare", key, select->blob(0));
  if (!bytes) return std::nullopt;
  return std::vector<std::byte>(bytes->begin(), bytes->end());
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
