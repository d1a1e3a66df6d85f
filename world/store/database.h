// SQLite as objects. Private to world/store.
#pragma once
#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/result.h"

namespace skerry::world {

/// One statement, reset and ready again after each run.
class Statement {
 public:
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}

  Statement& bind(int index, std::int64_t value);
  Statement& bind(int index, std::string_view text);
  Statement& bind(int index, std::span<const std::byte> blob);
  /// @return SQLITE_ROW, SQLITE_DONE or an error, extended.
  int step();
  void reset();
  /// Of the current row. Blobs and texts last until the next step or reset.
  std::int64_t integer(int column) const;
  std::span<const std::byte> blob(int column) const;
  std::string_view text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// An open database file.
class Database {
 public:
  /// @param flags SQLITE_OPEN_.... @return none: `code` says why.
  static std::optional<Database> open(const std::string& name, int flags, int& code);

  /// @return SQLITE_OK or an error, extended.
  int run(const char* sql);
  /// @return none: the text does not fit the schema, or the file is damaged; `code` says.
  std::optional<Statement> prepare(std::string_view sql, int& code);
  /// The one integer that a pragma answers, or an error.
  int integer(const char* sql, std::int64_t& value);
  /// Closing it leaves file and log as they are: a damaged pair is kept to the byte.
  void leave_log() {
    sqlite3_db_config(handle_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  }
  bool read_only() const { return sqlite3_db_readonly(handle_.get(), "main") == 1; }

 private:
  struct Close {
    void operator()(sqlite3* db) const { sqlite3_close_v2(db); }
  };
  explicit Database(sqlite3* handle) : handle_(handle) {}
  std::unique_ptr<sqlite3, Close> handle_;
};

/// Holds a file for one writer. The lock goes with the process, however that ends.
class WriterLock {
 public:
  /// @return none: another process, or another WorldFile, has it, or (errno) it cannot be opened.
  static std::optional<WriterLock> take(const std::filesystem::path& path, int& code);
  WriterLock(WriterLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  WriterLock& operator=(WriterLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~WriterLock();

 private:
  explicit WriterLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

/// A path within an error: one line, nothing that moves a cursor.
std::string quoted(const std::filesystem::path& path);
/// Whether a code says that a file is not as SQLite left it.
bool is_damage(int code);
/// "cannot <what> the world 'PATH': <why the code says>; <what to do>".
Error file_error(std::string_view what, const std::filesystem::path& path, int code);

}  // namespace skerry::world
