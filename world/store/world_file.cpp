#include "world/store/world_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>

#include "engine/core/check.h"
#include "world/generate/generate.h"
#include "world/store/chunk_blob.h"
#include "world/store/rows.h"
#include "world/store/schema.h"
#include "world/store/world_file_state.h"

namespace skerry::world {
namespace {

namespace fs = std::filesystem;

/// What the first bytes of a file say, before SQLite may touch it: opening a stranger's database
/// for writing could already change it.
Result<void> check_header(const fs::path& path) {
  const auto refuse = [&](std::string_view why, std::string_view then) {
    return Error{fmt::format("cannot open the world {}: {}; {}", quoted(path), why, then)};
  };
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found)
    return refuse("it does not exist", "use --seed for a new world");
  if (status.type() == fs::file_type::none) return refuse(code.message(), "check the path");
  if (status.type() == fs::file_type::directory) return refuse("it is a folder", "name a file");
  if (status.type() != fs::file_type::regular) return refuse("it is no file", "name a file");
  std::array<char, 100> header{};  // of SQLite; big-endian numbers at 60 and 68
  std::ifstream file(path, std::ios::binary);
  if (!file) return refuse("it may not be read", "check who owns it");
  file.read(header.data(), header.size());
  if (file.gcount() != static_cast<std::streamsize>(header.size()) ||
      std::memcmp(header.data(), "SQLite format 3", 16) != 0)
    return refuse("it is no saved world of Skerry", "name another file");
  std::uint32_t id = 0;
  for (std::size_t i = 68; i < 72; ++i) id = id << 8 | static_cast<unsigned char>(header[i]);
  if (id != kApplicationId)
    return refuse("it belongs to another program", "name a saved world of Skerry");
  return {};
}

/// Opens for reading, from read-only media and folders, too.
std::optional<Database> open_to_read(const fs::path& path, int& code) {
  std::optional<Database> file = Database::open(path.string(), SQLITE_OPEN_READONLY, code);
  std::int64_t version = 0;
  if (file) code = file->integer("PRAGMA schema_version", version);
  if (code == SQLITE_OK) return file;
  const int kind = code & 0xff;
  if (kind != SQLITE_CANTOPEN && kind != SQLITE_READONLY) return std::nullopt;
  // Without a log there is nothing that a writer could have left there, and none that writes now.
  std::error_code missing;
  fs::path log = path;
  log += "-wal";
  if (fs::exists(log, missing) && fs::file_size(log, missing) != 0) return std::nullopt;
  return Database::open(immutable_uri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, code);
}

/// Gives a complete file its name, unless there is such a file by now. @return SQLITE_OK or an
/// error.
int publish(const fs::path& temporary, const fs::path& path) {
  // The log of a file that is no more would be taken for the new one's.
  for (const char* companion : {"-wal", "-shm", "-journal"}) {
    std::error_code code;
    fs::remove(fs::path(path) += companion, code);
    if (code) return SQLITE_CANTOPEN;
  }
  int done = ::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
  // Not all file systems know that; those that do not mostly know links, which replace nothing.
  if (done != 0 && errno == EINVAL && (done = ::link(temporary.c_str(), path.c_str())) == 0)
    ::unlink(temporary.c_str());
  if (done != 0) return SQLITE_CANTOPEN;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return SQLITE_OK;  // may not be listed; the file is there
  ::fsync(descriptor);
  ::close(descriptor);
  return SQLITE_OK;
}

}  // namespace

bool WorldInfo::operator==(const WorldInfo& o) const {
  return name == o.name && seed_text == o.seed_text && desc.seed == o.desc.seed &&
         desc.offset_blocks == o.desc.offset_blocks && desc.island_limit == o.desc.island_limit &&
         desc.generated == o.desc.generated;
}

WorldFile::WorldFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
WorldFile::~WorldFile() = default;
const fs::path& WorldFile::path() const {
  return state_->path;
}
const WorldInfo& WorldFile::info() const {
  return state_->info;
}
WorldFile::Mode WorldFile::mode() const {
  return state_->mode;
}
const std::vector<std::string>& WorldFile::damage() const {
  return state_->damage;
}

void WorldFile::note_damage(std::string line) {
  state_->tell(std::move(line));
}

Result<std::unique_ptr<WorldFile>> WorldFile::create(const fs::path& path, const WorldInfo& info) {
  if (!fits_file(info))
    return Error{
        fmt::format("cannot make the world {}: its name or seed is too long; choose a shorter one",
                    quoted(path))};
  std::error_code code;
  if (fs::exists(path, code))
    return Error{
        fmt::format("cannot make the world {}: there is one already; name another", quoted(path))};
  fs::path temporary = path;
  temporary += fmt::format(".{}.tmp", ::getpid());
  fs::remove(temporary, code);
  int failed = SQLITE_OK;
  {
    std::optional<Database> file =
        Database::open(temporary.string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, failed);
    if (file) failed = make_schema(*file);
    if (file && failed == SQLITE_OK) failed = write_value(*file, "info", encode_info(info));
    if (file && failed == SQLITE_OK)
      failed = write_value(*file, "generator", std::as_bytes(std::span(&kGeneratorVersion, 1)));
  }
  if (failed == SQLITE_OK) failed = publish(temporary, path);
  if (failed != SQLITE_OK) fs::remove(temporary, code);
  if (failed != SQLITE_OK) return file_error("make", path, failed);
  return open(path, Mode::kWrite);
}

Result<std::unique_ptr<WorldFile>> WorldFile::open(const fs::path& path, Mode mode) {
  if (const Result<void> header = check_header(path); !header) return header.error();
  auto state = std::make_unique<State>();
  state->path = path;
  state->mode = mode;
  int code = SQLITE_OK;
  if (mode == Mode::kWrite) {
    int reason = 0;
    state->lock = WriterLock::take(path, reason);
    if (!state->lock && reason == EWOULDBLOCK)
      return Error{
          fmt::format("cannot open the world {}: another Skerry has it open; close that one first",
                      quoted(path))};
    if (!state->lock) return file_error("open", path, SQLITE_CANTOPEN);
    state->database = Database::open(path.string(), SQLITE_OPEN_READWRITE, code);
    if (state->database && state->database->read_only()) code = SQLITE_READONLY;
  } else {
    state->database = open_to_read(path, code);
  }
  if (code == SQLITE_OK) code = set_up(*state->database, mode == Mode::kWrite);
  if (code != SQLITE_OK) return file_error("open", path, code);
  const Result<int> version = check_schema(*state->database, path, mode == Mode::kWrite);
  if (!version) return version.error();
  state->version = *version;
  std::unique_ptr<WorldFile> file(new WorldFile(std::move(state)));
  const auto bytes = file->value("info");
  const std::optional<WorldInfo> info = bytes ? decode_info(*bytes) : std::nullopt;
  if (!info) return file_error("open", path, SQLITE_CORRUPT);
  file->state_->info = *info;
  return file;
}

std::optional<std::vector<std::byte>> WorldFile::value(std::string_view name) {
  int code = SQLITE_OK;
  std::optional<Statement> select =
      state_->database->prepare("SELECT data FROM value WHERE name = ?1", code);
  if (select) code = select->bind(1, name).step();
  if (code == SQLITE_DONE) return std::nullopt;
  if (code == SQLITE_ROW) {
    if (const auto bytes = unsealed("value", name_key(name), select->blob(0)))
      return std::vector<std::byte>(bytes->begin(), bytes->end());
  }
  state_->tell(fmt::format("the world {} has lost its '{}': it is damaged", quoted(path()), name));
  return std::nullopt;
}

WorldFile::Transaction WorldFile::begin() {
  SKERRY_ASSERT(state_->mode == Mode::kWrite && !state_->in_transaction);
  return Transaction(*this);
}

WorldFile::Transaction::Transaction(WorldFile& file) : file_(&file) {
  State& s = *file.state_;
  s.in_transaction = true;
  if (const int code = s.database->run("BEGIN IMMEDIATE"); code != SQLITE_OK)
    error_ = file_error("save", s.path, code);
}

WorldFile::Transaction::Transaction(Transaction&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)), error_(std::move(other.error_)) {}

WorldFile::Transaction::~Transaction() {
  if (!file_) return;
  file_->state_->database->run("ROLLBACK");
  file_->state_->in_transaction = false;
}

void WorldFile::Transaction::put_island(const IslandRow& island) {
  State& s = *file_->state_;
  const auto id = static_cast<std::int64_t>(island.spec.id);
  s.put(error_, "INSERT OR REPLACE INTO island(id, added, spec) VALUES(?1, ?2, ?3)",
        [&](Statement& statement) {
          statement.bind(1, id).bind(2, std::int64_t{island.added});
          statement.bind(3, sealed(island.added ? "added" : "island", island.spec.id,
                                   encode_spec(island.spec)));
        });
  if (!island.motion) return;
  s.put(error_, "INSERT OR REPLACE INTO motion(island, data) VALUES(?1, ?2)",
        [&](Statement& statement) {
          statement.bind(1, id).bind(
              2, sealed("motion", island.spec.id, encode_motion(*island.motion)));
        });
}

void WorldFile::Transaction::put_new_island(const IslandRow& island) {
  for (const std::string_view sql :
       {"DELETE FROM chunk WHERE island = ?1", "DELETE FROM motion WHERE island = ?1"})
    file_->state_->put(error_, sql, [&](Statement& statement) {
      statement.bind(1, static_cast<std::int64_t>(island.spec.id));
    });
  put_island(island);
}

void WorldFile::Transaction::put_edits(std::uint64_t island, IVec3 chunk,
                                       std::span<const VoxelEdit> edits) {
  if (!edits.empty())
    return file_->state_->put_blob(error_, {island, chunk}, encode_edits({island, chunk}, edits));
  file_->state_->put(error_, "DELETE FROM chunk WHERE island = ?1 AND x = ?2 AND y = ?3 AND z = ?4",
                     [&](Statement& statement) {
                       bind_name(statement, {island, chunk});
                     });
}

void WorldFile::Transaction::put_chunk(std::uint64_t island, IVec3 chunk, const Chunk& voxels) {
  file_->state_->put_blob(error_, {island, chunk}, encode_chunk({island, chunk}, voxels));
}

void WorldFile::Transaction::put_value(std::string_view name, std::span<const std::byte> bytes) {
  SKERRY_ASSERT(bytes.size() <= kMaxValueBytes);
  if (error_) return;
  State& s = *file_->state_;
  if (const int code = write_value(*s.database, name, bytes); code != SQLITE_OK)
    error_ = file_error("save", s.path, code);
}

Result<void> WorldFile::Transaction::commit() {
  State& s = *file_->state_;
  if (!error_) {
    if (const int code = s.database->run("COMMIT"); code != SQLITE_OK)
      error_ = file_error("save", s.path, code);
  }
  if (error_) s.database->run("ROLLBACK");
  s.in_transaction = false;
  file_ = nullptr;
  return error_ ? Result<void>(*error_) : Result<void>();
}

}  // namespace skerry::world
