// Making, opening and mending world files.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>
#include <system_error>
#include <utility>

#include "engine/core/draft.h"
#include "world/generate/generate.h"
#include "world/store/pages.h"
#include "world/store/rows.h"
#include "world/store/salvage.h"
#include "world/store/schema.h"
#include "world/store/world_file_state.h"

namespace skerry::world {
namespace {

namespace fs = std::filesystem;

/// Why a file cannot be used as it is.
struct Trouble {
  Error error;
  bool damage = false;  ///< it may be a world nevertheless
};

/// Says of a file that it is newer than this program; it stays as it is.
Trouble newer_than_this(const fs::path& path, std::int64_t version) {
  return {
      {fmt::format("cannot open the world {}: a newer Skerry wrote it (its version is {}, this "
                   "one reads {}); update Skerry",
                   quoted(path), version, WorldFile::kVersion)}};
}

/// A first page's numbers that say whose file it is; big-endian at 60 and 68 of SQLite's header.
std::optional<Trouble> check_first_bytes(const fs::path& path, std::span<const char> header) {
  const auto refuse = [&](std::string_view why, std::string_view then, bool damage) {
    return Trouble{{fmt::format("cannot open the world {}: {}; {}", quoted(path), why, then)},
                   damage};
  };
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
      value = value << 8 | static_cast<unsigned char>(header[i]);
    return value;
  };
  constexpr std::size_t kHeaderBytes = 100;
  const bool is_sqlite =
      header.size() >= kHeaderBytes && std::memcmp(header.data(), "SQLite format 3", 16) == 0;
  const std::uint32_t id = header.size() >= kHeaderBytes ? number(68) : 0;
  // Before SQLite may touch it, and before damage is looked for: an older program cannot tell what
  // a newer one means by its tables. Beyond the signed range SQLite has no versions.
  const std::uint32_t version = id == kApplicationId ? number(60) : 0;
  if (version > WorldFile::kVersion && version <= std::numeric_limits<std::int32_t>::max())
    return newer_than_this(path, version);
  if (!is_sqlite) return refuse("it is no saved world of Skerry", "name another file", true);
  // One flipped bit is damage; anything else may be what a later version calls its files.
  if (id != kApplicationId)
    return refuse("it belongs to another program, or to a newer Skerry",
                  "name a saved world of Skerry", std::has_single_bit(id ^ kApplicationId));
  return std::nullopt;
}

/// What the first bytes of a file say, before SQLite may touch it: opening a stranger's database
/// for writing could already change it.
std::optional<Trouble> check_header(const fs::path& path) {
  const auto refuse = [&](std::string_view why, std::string_view then) {
    return Trouble{{fmt::format("cannot open the world {}: {}; {}", quoted(path), why, then)}};
  };
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found)
    return refuse("it does not exist", "use --seed for a new world");
  if (status.type() == fs::file_type::none) return refuse(code.message(), "check the path");
  if (status.type() == fs::file_type::directory) return refuse("it is a folder", "name a file");
  if (status.type() != fs::file_type::regular) return refuse("it is no file", "name a file");
  std::array<char, 100> header{};
  std::ifstream file(path, std::ios::binary);
  if (!file) return refuse("it may not be read", "check who owns it");
  file.read(header.data(), header.size());
  return check_first_bytes(path, std::span(header).first(static_cast<std::size_t>(file.gcount())));
}

/// What SQLite would not see: a newer version in the log, or commits there that it would leave out.
/// @param locked nobody else writes the file.
std::optional<Trouble> check_log(const fs::path& path, bool locked) {
  const auto look = [&]() -> std::optional<Trouble> {
    PageFile pages(path);
    if (PageBytes first; pages.read(1, first)) {
      const auto chars = std::as_writable_bytes(std::span(first));
      std::optional<Trouble> newer =
          check_first_bytes(path, {reinterpret_cast<const char*>(chars.data()), chars.size()});
      if (newer && !newer->damage) return newer;
    }
    if (!pages.log_damaged()) return std::nullopt;
    return Trouble{file_error("open", path, SQLITE_CORRUPT), true};
  };
  std::optional<Trouble> trouble = look();
  if (!trouble || !trouble->damage || locked) return trouble;
  // A log that is being written can look like that for a moment: only one at rest counts.
  int reason = 0;
  const std::optional<WriterLock> at_rest = WriterLock::take(path, reason);
  return at_rest ? look() : std::nullopt;
}

/// Whether a log holds what its file does not yet.
bool has_log(const fs::path& path) {
  std::error_code missing;
  const fs::path log = fs::path(path) += "-wal";
  return fs::exists(log, missing) && fs::file_size(log, missing) != 0;
}

/// Opens for reading, from read-only media and folders, too.
std::optional<Database> open_to_read(const fs::path& path, int& code) {
  // Who may write takes log and index away again at the end, and has nothing to write here without
  // a log or journal. With one, reading must not bring it into the file.
  std::error_code missing;
  const bool pending = has_log(path) || fs::exists(fs::path(path) += "-journal", missing);
  const int how = pending ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
  std::optional<Database> file = Database::open(path.string(), how, code);
  std::int64_t version = 0;
  if (file) code = file->run("PRAGMA query_only = ON");
  if (file && code == SQLITE_OK) code = file->integer("PRAGMA schema_version", version);
  if (code == SQLITE_OK) return file;
  const int kind = code & 0xff;
  if (kind != SQLITE_CANTOPEN && kind != SQLITE_READONLY) return std::nullopt;
  // Without a log there is nothing that a writer could have left there, and none that writes now.
  if (has_log(path)) return std::nullopt;
  return Database::open(immutable_uri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, code);
}

/// The log of a file that is no more would be taken for the one's that gets its name.
bool remove_companions(const fs::path& path) {
  for (const char* companion : {"-wal", "-shm", "-journal"}) {
    std::error_code code;
    fs::remove(fs::path(path) += companion, code);
    if (code) return false;
  }
  return true;
}

Error held_by_another(const fs::path& path) {
  return {fmt::format("cannot open the world {}: another Skerry has it open; close that one first",
                      quoted(path))};
}

Error not_made(const fs::path& path, const Error& why) {
  return {fmt::format("cannot make the world {}: {}", quoted(path), why.message)};
}

void sync_folder_of(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // may not be listed; the file is there
  ::fsync(descriptor);
  ::close(descriptor);
}

/// Puts a draft in a damaged file's place, which stays beside it, with its log, under another name.
/// @return that name; none: it could not be done.
std::optional<fs::path> replace_damaged(Draft& whole, const fs::path& path) {
  fs::path kept = path;
  kept += ".damaged";
  for (int count = 2; ::link(path.c_str(), kept.c_str()) != 0; ++count) {
    if (errno != EEXIST || count > 1000) return std::nullopt;
    (kept = path) += fmt::format(".damaged_{}", count);
  }
  // The log is part of the world: it is not given up before there is a second one.
  std::error_code code;
  const fs::path log = fs::path(path) += "-wal";
  if (fs::exists(log, code) && !fs::copy_file(log, fs::path(kept) += "-wal", code))
    return std::nullopt;
  if (!remove_companions(path) || !whole.publish()) return std::nullopt;
  sync_folder_of(path);
  return kept;
}

}  // namespace

Result<std::unique_ptr<WorldFile>> WorldFile::create(const fs::path& path, const WorldInfo& info) {
  if (!fits_file(info))
    return Error{
        fmt::format("cannot make the world {}: its name or seed is too long; choose a shorter one",
                    quoted(path))};
  std::error_code code;
  if (fs::exists(path, code))
    return Error{
        fmt::format("cannot make the world {}: there is one already; name another", quoted(path))};
  Result<Draft> draft = Draft::create(path);
  if (!draft) return not_made(path, draft.error());
  int failed = SQLITE_OK;
  {
    std::optional<Database> file =
        Database::open(draft->path().string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, failed);
    if (file) failed = make_schema(*file);
    if (file && failed == SQLITE_OK) failed = write_value(*file, "info", encode_info(info));
    if (file && failed == SQLITE_OK)
      failed = write_value(*file, "generator", std::as_bytes(std::span(&kGeneratorVersion, 1)));
  }
  const Result<OutputPlace> place = find_output(path);
  if (failed == SQLITE_OK && (!place || !remove_companions(place->path))) failed = SQLITE_CANTOPEN;
  if (failed != SQLITE_OK) return file_error("make", path, failed);
  if (const Result<void> done = draft->publish_new(); !done) return not_made(path, done.error());
  sync_folder_of(place->path);
  return open(path, Mode::kWrite);
}

Result<std::unique_ptr<WorldFile>> WorldFile::open(const fs::path& named, Mode mode) {
  auto state = std::make_unique<State>();
  // Its log lies beside the file itself, not beside a link to it.
  std::error_code unreadable;
  if (fs::is_symlink(named, unreadable)) state->path = fs::canonical(named, unreadable);
  if (state->path.empty()) state->path = named;
  const fs::path& path = state->path;
  state->mode = mode;
  std::optional<Trouble> trouble = check_header(path);
  if (trouble && !trouble->damage) return trouble->error;
  if (mode == Mode::kWrite) {
    int reason = 0;
    state->lock = WriterLock::take(path, reason);
    if (!state->lock && reason == EWOULDBLOCK) return held_by_another(path);
    if (!state->lock) return file_error("open", path, SQLITE_CANTOPEN);
  }
  const auto look = [&]() -> std::optional<Trouble> {
    bool newer = false;
    const int code = state->open_database(newer);
    if (code != SQLITE_OK) return Trouble{file_error("open", path, code), is_damage(code)};
    if (newer) return newer_than_this(path, state->version);
    if (!state->find_info()) return Trouble{file_error("open", path, SQLITE_CORRUPT), true};
    return std::nullopt;
  };
  if (auto of_log = check_log(path, mode == Mode::kWrite)) {
    trouble = std::move(of_log);
    if (trouble->damage)
      state->report(fmt::format(
          "the log of the world {} is damaged: what was saved last may be missing", quoted(path)));
  }
  if (!trouble) trouble = look();
  if (trouble && trouble->damage && state->recover() && state->find_info()) trouble.reset();
  if (trouble) return trouble->error;
  return std::unique_ptr<WorldFile>(new WorldFile(std::move(state)));
}

Result<void> WorldFile::check_free(const fs::path& path) {
  int reason = 0;
  if (!WriterLock::take(path, reason) && reason == EWOULDBLOCK) return held_by_another(path);
  return {};
}

/// @param newer it is of a later version than this program's, and not read further.
/// @return SQLITE_OK or an error.
int WorldFile::State::open_database(bool& newer) {
  int code = SQLITE_OK;
  if (mode == Mode::kWrite) {
    database = Database::open(path.string(), SQLITE_OPEN_READWRITE, code);
    if (database && database->read_only()) code = SQLITE_READONLY;
  } else {
    database = open_to_read(path, code);
  }
  if (code == SQLITE_OK) code = set_up(*database, mode == Mode::kWrite);
  if (code == SQLITE_OK) code = check_schema(*database, mode == Mode::kWrite, version);
  newer = code == SQLITE_OK && version > kVersion;
  // Nothing is written into a file that does not hang together.
  if (code != SQLITE_OK || newer || mode != Mode::kWrite) return code;
  code = check_whole(*database);
  // What a killed process left in the log, or what brought the tables up to date.
  return code == SQLITE_OK && has_log(path) ? settle(*database) : code;
}

bool WorldFile::State::find_info() {
  const auto bytes = value("info");
  const std::optional<WorldInfo> found = bytes ? decode_info(*bytes) : std::nullopt;
  if (found) info = *found;
  return found.has_value();
}

/// Goes on with what can be found in the pages of a damaged file: in memory to read, in a file of
/// its own in the damaged one's place to write. @return false: there is no world in it, or no room
/// for it; the file is as it was.
bool WorldFile::State::recover() {
  if (recovered) return false;
  recovered = true;
  const bool writes = mode == Mode::kWrite;
  std::optional<Draft> draft;
  if (writes)
    if (Result<Draft> made = Draft::create(path)) draft.emplace(*std::move(made));
  const fs::path place = draft ? draft->path() : fs::path(":memory:");
  int code = SQLITE_OK;
  std::optional<Database> rescued =
      Database::open(place.string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, code);
  bool found = (draft || !writes) && rescued && make_schema(*rescued) == SQLITE_OK &&
               salvage(path, *rescued, damage);
  std::optional<fs::path> kept;
  if (found) {
    statements.clear();
    // What waits in a log is damaged with its file, and stays; without one, nothing is left beside
    // it.
    if (database && has_log(path)) database->leave_log();
    database = std::exchange(rescued, std::nullopt);
    version = kVersion;
  }
  if (writes) {
    rescued.reset();
    if (found) database.reset();
    found = found && (kept = replace_damaged(*draft, path));
    int reason = 0;
    bool newer = false;
    found = found && (lock = WriterLock::take(path, reason)) && open_database(newer) == SQLITE_OK;
    // An empty one that takes nothing: who reads or saves receives an error.
    if (!database) database = Database::open(":memory:", SQLITE_OPEN_READONLY, code);
  }
  if (!found) return false;
  report(fmt::format("the world {} is damaged: all that could be found of it was read{}",
                     quoted(path), kept ? "; the damaged file is kept as " + quoted(*kept) : ""));
  return true;
}

}  // namespace skerry::world
