#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace skerry::world {

/// A set of small numbers that lists what it holds, in the order of its coming.
class Marked {
 public:
  /// @return whether it is new.
  bool add(std::uint32_t number) {
    if (number / 64 >= bits_.size()) bits_.resize(number / 64 + 1, 0);
    std::uint64_t& word = bits_[number / 64];
    const std::uint64_t bit = std::uint64_t{1} << number % 64;
    if ((word & bit) != 0) return false;
    list_.push_back(number);
    word |= bit;
    return true;
  }
  bool has(std::uint32_t number) const {
    return number / 64 < bits_.size() && (bits_[number / 64] >> number % 64 & 1) != 0;
  }
  std::span<const std::uint32_t> all() const { return list_; }
  bool empty() const { return list_.empty(); }
  void clear() {
    for (const std::uint32_t number : list_) bits_[number / 64] = 0;
    list_.clear();
  }

 private:
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint32_t> list_;
};

}  // namespace skerry::world
