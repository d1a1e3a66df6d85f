#include "world/store/log.h"

#include <array>
#include <istream>
#include <optional>
#include <vector>

#include "world/store/bytes.h"
#include "world/store/page_bytes.h"

namespace skerry::world {
namespace {

constexpr std::size_t kLogHeader = 32, kFrameHeader = 24;
constexpr std::uint64_t kMagic = 0x377f0682;  // the last bit: words are big-endian

/// The checksum of a log, which runs on from frame to frame.
struct LogSum {
  bool big_endian_words = false;
  std::uint32_t first = 0, second = 0;

  bool operator==(const LogSum&) const = default;
  static LogSum stored(bool big_endian_words, std::span<const std::byte> eight) {
    return {big_endian_words, static_cast<std::uint32_t>(big_endian(eight.first(4))),
            static_cast<std::uint32_t>(big_endian(eight.subspan(4, 4)))};
  }
  LogSum with(std::span<const std::byte> bytes) const {
    LogSum sum = *this;
    const auto word = [&](std::size_t at) {
      const auto value = static_cast<std::uint32_t>(big_endian(bytes.subspan(at, 4)));
      return big_endian_words ? value : __builtin_bswap32(value);
    };
    for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
      sum.first += word(at) + sum.second;
      sum.second += word(at + 4) + sum.first;
    }
    return sum;
  }
};

struct RawFrame {
  std::array<std::byte, kFrameHeader> header;
  PageBytes page;

  std::span<const std::byte> head() const { return header; }
  std::uint64_t salts() const { return big_endian(head().subspan(8, 8)); }
  LogSum stored(bool big_endian_words) const {
    return LogSum::stored(big_endian_words, head().subspan(16, 8));
  }
  LogSum after(const LogSum& before) const { return before.with(head().first(8)).with(page); }
};

struct Frame {
  std::uint32_t page = 0;
  std::uint32_t file_pages = 0;  // of the file; 0: no end of a commit
  bool has_salts = false;        // those of the log
  bool proved = false;           // its checksum continues that of the frame before
  bool accepted = false;         // by SQLite: it and all before it are sound
  bool current = false;          // no leftover of an earlier log
};

/// How a log begins: the sums that the first frame may continue.
struct LogStart {
  bool sound = false;
  std::uint64_t salts = 0;
  LogSum stored, computed;
};

std::uint64_t place_of(std::size_t frame) {
  return kLogHeader + std::uint64_t{frame} * (kFrameHeader + kPageBytes);
}

bool read_frame(std::istream& log, std::size_t index, RawFrame& out) {
  return read_at(log, place_of(index), std::span(out.header)) &&
         read_at(log, place_of(index) + kFrameHeader, std::span(out.page));
}

/// None: nothing here is a log of pages of our size.
std::optional<LogStart> read_start(std::istream& log) {
  std::array<std::byte, kLogHeader> header;
  if (!read_at(log, 0, std::span(header))) return std::nullopt;
  const std::span<const std::byte> head(header);
  const auto start_with = [&](bool big_endian_words) {
    LogStart start;
    start.stored = LogSum::stored(big_endian_words, head.subspan(24));
    start.computed = LogSum{big_endian_words}.with(head.first(24));
    return start;
  };
  const std::uint64_t magic = big_endian(head.first(4));
  LogStart start = start_with((magic & 1) != 0);
  start.salts = big_endian(head.subspan(16, 8));
  if ((magic & ~std::uint64_t{1}) == kMagic && start.stored == start.computed) {
    start.sound = true;
    return big_endian(head.subspan(8, 4)) == kPageBytes ? std::optional(start) : std::nullopt;
  }
  // Damaged, or no log: the frames decide. Their salts are those of the header that was.
  RawFrame first;
  if (!read_frame(log, 0, first)) return std::nullopt;
  for (const bool big_endian_words : {false, true}) {
    start = start_with(big_endian_words);
    start.salts = first.salts();
    const LogSum stored = first.stored(big_endian_words);
    if (first.after(start.stored) == stored || first.after(start.computed) == stored) return start;
  }
  return std::nullopt;
}

std::vector<Frame> read_frames(std::istream& log, const LogStart& start) {
  std::vector<Frame> frames;
  LogSum stored = start.stored, computed = start.computed;
  bool accepted = start.sound, current = true;
  RawFrame raw;
  while (read_frame(log, frames.size(), raw)) {
    Frame frame;
    frame.page = static_cast<std::uint32_t>(big_endian(raw.head().first(4)));
    frame.file_pages = static_cast<std::uint32_t>(big_endian(raw.head().subspan(4, 4)));
    frame.has_salts = raw.salts() == start.salts;
    const LogSum its_own = raw.stored(stored.big_endian_words);
    const LogSum after = raw.after(stored);
    frame.proved = after == its_own;
    accepted = accepted && frame.proved && frame.has_salts && frame.page != 0;
    frame.accepted = accepted;
    if (!frame.proved && stored != computed && raw.after(computed) == its_own) {
      // Only the sum in the frame before is damaged; what it was made of fits.
      frame.proved = true;
      if (!frames.empty()) frames.back().proved = true;
    }
    frame.current = frame.has_salts || (frame.proved && current);
    current = frame.current;
    stored = its_own;
    computed = frame.proved ? its_own : after;
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace

LogPages read_log(std::istream& log) {
  LogPages pages;
  const std::optional<LogStart> start = read_start(log);
  if (!start) return pages;
  const std::vector<Frame> frames = read_frames(log, *start);
  std::size_t accepted = 0;
  while (accepted < frames.size() && frames[accepted].accepted) ++accepted;
  pages.damaged = !start->sound && !frames.empty();
  for (std::size_t i = accepted + 1; i < frames.size(); ++i)
    pages.damaged = pages.damaged || frames[i].has_salts;
  std::size_t committed = 0;  // frames
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    const bool counts = pages.damaged ? frame.current && frame.proved : frame.accepted;
    if (!counts || frame.file_pages == 0) continue;
    committed = i + 1;
    pages.file_pages = frame.file_pages;
  }
  for (std::size_t i = 0; i < committed; ++i)
    if (frames[i].proved && frames[i].current)
      pages.where[frames[i].page] = place_of(i) + kFrameHeader;
  return pages;
}

}  // namespace skerry::world
