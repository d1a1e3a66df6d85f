#pragma once
#include <algorithm>
#include <cstdint>

namespace skerry::render {

/// Device memory that the tables of a world share: quads, sections, occupancy, light of the sky.
/// What is asked for is refused rather than taken beyond the limit; buffers never shrink.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit_bytes) : limit_(limit_bytes) {}
  std::uint64_t limit() const { return limit_; }
  std::uint64_t taken() const { return taken_; }
  std::uint64_t left() const { return limit_ - std::min(limit_, taken_); }
  /// @return false, and nothing changes: more than is left.
  bool take(std::uint64_t bytes) {
    if (bytes > left()) return false;
    taken_ += bytes;
    return true;
  }
  /// What a table begins with: `usual` elements, as many as a flight at medium quality needs, so
  /// that it does not grow within a frame; with a small budget fewer, but at least `least`.
  std::uint32_t first_elements(std::uint64_t element_bytes, std::uint32_t least,
                               std::uint32_t usual) const {
    constexpr std::uint64_t kShare = 16;  // of the limit, or half of what is left
    const std::uint64_t bytes = std::min(limit_ / kShare, left() / 2);
    return static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(bytes / element_bytes, least, usual));
  }
  void give_back(std::uint64_t bytes) { taken_ -= std::min(bytes, taken_); }

 private:
  std::uint64_t limit_, taken_ = 0;
};

}  // namespace skerry::render
