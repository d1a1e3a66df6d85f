// A SQLite file as pages, without SQLite. Private to world/store.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <vector>

#include "world/store/log.h"
#include "world/store/page_bytes.h"

namespace skerry::world {

/// A value of a row: what kind it is, an integer, or the bytes of a text or a blob.
struct Field {
  enum class Kind : std::uint8_t { kNull, kInteger, kReal, kText, kBlob } kind = Kind::kNull;
  std::int64_t integer = 0;
  std::span<const std::byte> bytes;
};

/// The pages of a file as its last commit left them, those of its write-ahead log included. Trusts
/// nothing that it reads.
class PageFile {
 public:
  explicit PageFile(const std::filesystem::path& path);

  std::uint32_t count() const { return count_; }
  /// Whether commits are in the log that SQLite would leave out.
  bool log_damaged() const { return in_log_.damaged; }
  /// When a page was written, to compare: 0 if no log has it.
  std::uint64_t age(std::uint32_t number) const;
  /// @param number 1 .. count(). @return false: it cannot be read.
  bool read(std::uint32_t number, PageBytes& out);

  /// Calls with each row that a page holds, if it is of a kind that holds rows.
  /// @param take rowid (0 for tables without), fields; good during the call.
  using TakeRow = std::function<void(std::int64_t, std::span<const Field>)>;
  void rows_of(std::uint32_t number, const TakeRow& take);

 private:
  bool payload(const PageBytes& page, std::size_t at, std::uint64_t size, std::size_t most_here,
               std::vector<std::byte>& out);

  std::ifstream file_, log_;
  std::uint32_t count_ = 0;
  std::uint64_t overflow_left_ = 0;  // pages that chains may still be followed through
  LogPages in_log_;
};

}  // namespace skerry::world
