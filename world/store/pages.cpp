#include "world/store/pages.h"

#include <algorithm>
#include <optional>
#include <system_error>

namespace skerry::world {
namespace {

namespace fs = std::filesystem;

// Kinds of pages that hold rows: their first byte.
constexpr unsigned kIndexInterior = 0x02, kIndexLeaf = 0x0a, kTableLeaf = 0x0d;
// What a row may take on the page itself; the rest goes to overflow pages.
constexpr std::size_t kMostInTable = kPageBytes - 35;
constexpr std::size_t kMostInIndex = (kPageBytes - 12) * 64 / 255 - 23;
constexpr std::size_t kLeast = (kPageBytes - 12) * 32 / 255 - 23;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 23;  // of a row: no writer makes more
constexpr std::size_t kMostFields = 8;
constexpr std::uint32_t kMostPages = 1u << 31;  // as SQLite has it
constexpr std::uint64_t kOverflowReads = 4;     // of pages, a page of the file: a whole one has 1

/// Up to nine bytes, seven bits each, the ninth all eight. None: the bytes end first.
std::optional<std::uint64_t> take_varint(std::span<const std::byte>& bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < 9; ++i) {
    if (bytes.empty()) return std::nullopt;
    const auto byte = std::to_integer<std::uint64_t>(bytes.front());
    bytes = bytes.subspan(1);
    if (i == 8) return value << 8 | byte;
    value = value << 7 | (byte & 0x7f);
    if (byte < 0x80) return value;
  }
  return value;
}

/// A value by its serial type. @return false: the bytes end first, or there is no such type.
bool take_field(std::uint64_t type, std::span<const std::byte>& bytes, Field& out) {
  static constexpr std::size_t kIntegerBytes[] = {0, 1, 2, 3, 4, 6, 8, 8, 0, 0};
  if (type == 10 || type == 11) return false;
  const std::uint64_t size = type < 10 ? kIntegerBytes[type] : (type - 12) / 2;
  if (size > bytes.size()) return false;
  const std::span<const std::byte> own = bytes.first(static_cast<std::size_t>(size));
  bytes = bytes.subspan(own.size());
  out = {};
  if (type >= 12) {
    out.kind = type % 2 == 0 ? Field::Kind::kBlob : Field::Kind::kText;
    out.bytes = own;
  } else if (type == 7) {
    out.kind = Field::Kind::kReal;
  } else if (type != 0) {
    out.kind = Field::Kind::kInteger;
    const int unused = 64 - 8 * static_cast<int>(own.size());
    out.integer = type >= 8 ? static_cast<std::int64_t>(type - 8)
                            : static_cast<std::int64_t>(big_endian(own) << unused) >> unused;
  }
  return true;
}

/// The fields of a row; none if the bytes are no row.
std::vector<Field> fields_of(std::span<const std::byte> row) {
  std::span<const std::byte> types = row;
  const std::optional<std::uint64_t> header = take_varint(types);
  if (!header || *header > row.size() || *header < row.size() - types.size()) return {};
  std::span<const std::byte> values = row.subspan(static_cast<std::size_t>(*header));
  types = types.first(types.size() - values.size());
  std::vector<Field> fields;
  while (!types.empty()) {
    const std::optional<std::uint64_t> type = take_varint(types);
    Field field;
    if (!type || fields.size() == kMostFields || !take_field(*type, values, field)) return {};
    fields.push_back(field);
  }
  return fields;
}

}  // namespace

PageFile::PageFile(const fs::path& path) : file_(path, std::ios::binary) {
  std::error_code code;
  const std::uintmax_t bytes = fs::file_size(path, code);
  if (!code)
    count_ = static_cast<std::uint32_t>(std::min<std::uintmax_t>(bytes / kPageBytes, kMostPages));
  const std::uint32_t in_file = count_;
  const fs::path log = fs::path(path) += "-wal";
  log_.open(log, std::ios::binary);
  if (log_) in_log_ = read_log(log_);
  if (in_log_.file_pages != 0) {
    std::uint32_t last_in_log = 0;
    for (const auto& [number, where] : in_log_.where) last_in_log = std::max(last_in_log, number);
    // No more than there are, whatever the log says.
    count_ = std::min(in_log_.file_pages, std::max(in_file, last_in_log));
  }
  overflow_left_ = kOverflowReads * count_;
}

std::uint64_t PageFile::age(std::uint32_t number) const {
  const auto found = in_log_.where.find(number);
  return found == in_log_.where.end() ? 0 : found->second;
}

bool PageFile::read(std::uint32_t number, PageBytes& out) {
  if (number == 0 || number > count_) return false;
  if (const std::uint64_t where = age(number); where != 0) return read_at(log_, where, out);
  return read_at(file_, std::uint64_t{number - 1} * kPageBytes, out);
}

/// The bytes of a row that begins at `at`: what is on the page, then its chain of overflow pages.
bool PageFile::payload(const PageBytes& page, std::size_t at, std::uint64_t size,
                       std::size_t most_here, std::vector<std::byte>& out) {
  out.clear();
  if (size > kMostBytes) return false;
  std::size_t here = static_cast<std::size_t>(size);
  if (here > most_here) {
    here = kLeast + (here - kLeast) % (kPageBytes - 4);
    if (here > most_here) here = kLeast;
  }
  const bool whole = here == size;
  if (at + here + (whole ? 0 : 4) > kPageBytes) return false;
  const std::span<const std::byte> bytes(page);
  out.insert(out.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
             bytes.begin() + static_cast<std::ptrdiff_t>(at + here));
  if (whole) return true;
  auto next = static_cast<std::uint32_t>(big_endian(bytes.subspan(at + here, 4)));
  PageBytes more;
  while (out.size() < size) {
    // Chains may be crossed and bent into rings.
    if (overflow_left_ == 0 || !read(next, more)) return false;
    --overflow_left_;
    const std::size_t count = std::min<std::size_t>(kPageBytes - 4, size - out.size());
    out.insert(out.end(), more.begin() + 4, more.begin() + 4 + static_cast<std::ptrdiff_t>(count));
    next = static_cast<std::uint32_t>(big_endian(std::span(more).first(4)));
  }
  return true;
}

void PageFile::rows_of(std::uint32_t number, const TakeRow& take) {
  PageBytes page;
  // The first page holds the list of tables only.
  if (number == 1 || !read(number, page)) return;
  const std::span<const std::byte> bytes(page);
  const auto kind = std::to_integer<unsigned>(page[0]);
  if (kind != kIndexInterior && kind != kIndexLeaf && kind != kTableLeaf) return;
  const std::size_t list = kind == kIndexInterior ? 12 : 8;
  const std::size_t cells =
      std::min<std::size_t>(big_endian(bytes.subspan(3, 2)), (kPageBytes - list) / 2);
  std::vector<std::byte> row;
  for (std::size_t i = 0; i < cells; ++i) {
    const auto at = static_cast<std::size_t>(big_endian(bytes.subspan(list + 2 * i, 2)));
    if (at >= kPageBytes) continue;
    std::span<const std::byte> cell = bytes.subspan(at);
    if (kind == kIndexInterior) cell = cell.subspan(std::min<std::size_t>(4, cell.size()));
    const std::optional<std::uint64_t> size = take_varint(cell);
    const std::optional<std::uint64_t> rowid = kind == kTableLeaf ? take_varint(cell) : 0;
    if (!size || !rowid) continue;
    const std::size_t most = kind == kTableLeaf ? kMostInTable : kMostInIndex;
    if (!payload(page, kPageBytes - cell.size(), *size, most, row)) continue;
    const std::vector<Field> fields = fields_of(row);
    if (!fields.empty()) take(static_cast<std::int64_t>(*rowid), fields);
  }
}

}  // namespace skerry::world
