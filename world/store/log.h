// A write-ahead log of SQLite, read without SQLite. Private to world/store.
#pragma once
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <unordered_map>

namespace skerry::world {

/// The pages that a log adds to its file.
struct LogPages {
  /// Where in the log the bytes of a page's last version begin; greater is later. Committed pages
  /// only.
  std::unordered_map<std::uint32_t, std::uint64_t> where;
  std::uint32_t file_pages = 0;  ///< of the file after the last commit; 0: there is no commit
  /// SQLite would leave out commits that are there. `where` then has what can be proved whole.
  bool damaged = false;
};

/// Reads a log, whatever is in it.
///
/// SQLite takes a log up to the first frame whose checksum or salt is wrong: that is how it finds
/// the end, and so damage looks to it like an end. Here a frame behind that place that carries the
/// log's salt is proof that the log once went on. The last commit of a log cannot be distinguished
/// so from one that a kill cut short; write_mark() puts one without content behind each that
/// counts.
///
/// The checksum of a frame continues that of the frame before, which stands in its header: from
/// there a frame behind a damaged one is proved, too.
/// Source: https://www.sqlite.org/fileformat2.html#walformat.
LogPages read_log(std::istream& log);

}  // namespace skerry::world
