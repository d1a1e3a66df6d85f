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
  void give_back(std::uint64_t bytes) { taken_ -= std::min(bytes, taken_); }

 private:
  std::uint64_t limit_, taken_ = 0;
};

}  // namespace skerry::render
