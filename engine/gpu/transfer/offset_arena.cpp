#include "engine/gpu/transfer/offset_arena.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "engine/core/check.h"

namespace skerry::gpu {

OffsetArena::OffsetArena(std::uint32_t capacity) : capacity_(capacity) {
  if (capacity > 0) free_.emplace(0, capacity);
}

Result<ArenaRange> OffsetArena::allocate(std::uint32_t count) {
  if (count == 0) return ArenaRange{};
  auto best = free_.end();
  for (auto run = free_.begin(); run != free_.end(); ++run) {
    if (run->second >= count && (best == free_.end() || run->second < best->second)) best = run;
  }
  if (best == free_.end()) {
    return Error{"the quad arena has no run of " + std::to_string(count) + ": " +
                 std::to_string(capacity_ - used_ - waiting_) + " of " + std::to_string(capacity_) +
                 " are free, the largest run is " + std::to_string(largest_free()) +
                 "; lower view.distance"};
  }
  const ArenaRange range{best->first, count};
  const std::uint32_t rest = best->second - count;
  const auto next = free_.erase(best);
  if (rest > 0) free_.emplace_hint(next, range.first + count, rest);
  used_ += count;
  return range;
}

void OffsetArena::free(ArenaRange range, std::uint64_t after_value) {
  if (range.count == 0) return;
  SKERRY_ASSERT(range.count <= used_ && range.first <= capacity_ - range.count);
  used_ -= range.count;
  waiting_ += range.count;
  waiting_ranges_.push_back({range, after_value});
}

void OffsetArena::collect(std::uint64_t completed) {
  const auto done = [&](const Waiting& waiting) { return waiting.value <= completed; };
  for (const Waiting& waiting : waiting_ranges_) {
    if (!done(waiting)) continue;
    waiting_ -= waiting.range.count;
    give_back(waiting.range);
  }
  std::erase_if(waiting_ranges_, done);
}

void OffsetArena::give_back(ArenaRange range) {
  auto next = free_.lower_bound(range.first);
  SKERRY_ASSERT(next == free_.end() ||
                range.first + range.count <= next->first);  // else freed twice
  if (next != free_.end() && range.first + range.count == next->first) {
    range.count += next->second;
    next = free_.erase(next);
  }
  if (next != free_.begin()) {
    const auto before = std::prev(next);
    SKERRY_ASSERT(before->first + before->second <= range.first);
    if (before->first + before->second == range.first) {
      before->second += range.count;
      return;
    }
  }
  free_.emplace_hint(next, range.first, range.count);
}

std::uint32_t OffsetArena::largest_free() const {
  std::uint32_t largest = 0;
  for (const auto& [first, count] : free_) largest = std::max(largest, count);
  return largest;
}

void OffsetArena::grow(std::uint32_t capacity) {
  SKERRY_ASSERT(capacity >= capacity_);
  if (capacity == capacity_) return;
  give_back({capacity_, capacity - capacity_});
  capacity_ = capacity;
}

}  // namespace skerry::gpu
