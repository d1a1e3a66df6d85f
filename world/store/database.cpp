#include "world/store/database.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace skerry::world {

Statement& Statement::bind(int index, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), index, value);
  return *this;
}

Statement& Statement::bind(int index, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), index, text.data(), text.size(), SQLITE_TRANSIENT,
                      SQLITE_UTF8);
  return *this;
}

Statement& Statement::bind(int index, std::span<const std::byte> blob) {
  // A null pointer would bind NULL.
  static constexpr std::byte kNothing{};
  sqlite3_bind_blob64(statement_.get(), index, blob.empty() ? &kNothing : blob.data(), blob.size(),
                      SQLITE_TRANSIENT);
  return *this;
}

int Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW) reset();
  return code;
}

void Statement::reset() {
  sqlite3_reset(statement_.get());
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::span<const std::byte> Statement::blob(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {static_cast<const std::byte*>(data), data ? static_cast<std::size_t>(size) : 0};
}

std::string_view Statement::text(int column) const {
  const unsigned char* data = sqlite3_column_text(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {reinterpret_cast<const char*>(data), data ? static_cast<std::size_t>(size) : 0};
}

std::optional<Database> Database::open(const std::string& name, int flags, int& code) {
  sqlite3* handle = nullptr;
  code = sqlite3_open_v2(name.c_str(), &handle, flags | SQLITE_OPEN_EXRESCODE, nullptr);
  Database database(handle);
  if (code != SQLITE_OK) return std::nullopt;
  // Nothing that a hostile file's schema could set in motion.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  constexpr int kBusyMs = 2000;
  sqlite3_busy_timeout(handle, kBusyMs);
  return database;
}

int Database::run(const char* sql) {
  return sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr);
}

std::optional<Statement> Database::prepare(std::string_view sql, int& code) {
  sqlite3_stmt* statement = nullptr;
  code = sqlite3_prepare_v2(handle_.get(), sql.data(), static_cast<int>(sql.size()), &statement,
                            nullptr);
  if (code != SQLITE_OK) return std::nullopt;
  return Statement(statement);
}

int Database::integer(const char* sql, std::int64_t& value) {
  int code = SQLITE_OK;
  std::optional<Statement> statement = prepare(sql, code);
  if (!statement) return code;
  code = statement->step();
  if (code != SQLITE_ROW) return code == SQLITE_DONE ? SQLITE_CORRUPT : code;
  value = statement->integer(0);
  return SQLITE_OK;
}

std::optional<WriterLock> WriterLock::take(const std::filesystem::path& path, int& code) {
  // SQLite's own locks are of the other kind (fcntl): the two do not see each other.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  code = descriptor < 0 ? errno : 0;
  if (descriptor < 0) return std::nullopt;
  WriterLock lock(descriptor);
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    code = errno;
    return std::nullopt;
  }
  // Another may have taken the name meanwhile (a damaged file's place): then this locks nothing.
  struct stat held {
  }, named{};
  if (::fstat(descriptor, &held) != 0 || ::stat(path.c_str(), &named) != 0 ||
      held.st_dev != named.st_dev || held.st_ino != named.st_ino) {
    code = EWOULDBLOCK;
    return std::nullopt;
  }
  return lock;
}

WriterLock::~WriterLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string quoted(const std::filesystem::path& path) {
  std::string text = "'";
  for (const char c : path.string())
    text += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  return text + "'";
}

bool is_damage(int code) {
  // The last is its answer to numbers in the first page that it does not know, and to tables that
  // are not there.
  return (code & 0xff) == SQLITE_CORRUPT || (code & 0xff) == SQLITE_NOTADB ||
         (code & 0xff) == SQLITE_ERROR;
}

Error file_error(std::string_view what, const std::filesystem::path& path, int code) {
  const auto say = [&](std::string_view why, std::string_view then) {
    return Error{fmt::format("cannot {} the world {}: {}; {}", what, quoted(path), why, then)};
  };
  switch (code & 0xff) {
    case SQLITE_FULL:
      return say("the disk is full", "free some space");
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return say("it may not be written", "check who owns the file and its folder");
    case SQLITE_CANTOPEN:
      return say("it cannot be opened", "check the path and who may use it");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return say("another program is using it", "close that program");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return say("it is damaged", "restore a copy of it");
    case SQLITE_NOMEM:
      return say("there is not enough memory", "close other programs");
    default:
      return say(sqlite3_errstr(code), "check the disk");
  }
}

}  // namespace skerry::world
