#include "engine/gpu/transfer/offset_arena.h"

#include <iterator>
#include <string>

#include "engine/core/check.h"

namespace skerry::gpu {

OffsetArena::OffsetArena(std::uint32_t capacity) : capacity_(capacity) {
  if (capacity > 0) add_run(0, capacity);
}

Result<ArenaRange> OffsetArena::allocate(std::uint32_t count) {
  if (count == 0) return ArenaRange{};
  const auto best = by_count_.lower_bound({count, 0});
  if (best == by_count_.end()) {
    return Error{"the quad arena has no run of " + std::to_string(count) + ": " +
                 std::to_string(capacity_ - used_ - waiting_) + " of " + std::to_string(capacity_) +
                 " are free, the largest run is " + std::to_string(largest_free()) +
                 "; lower view.distance"};
  }
  const auto [had, first] = *best;
  const ArenaRange range{first, count};
  take_run(free_.find(first));
  if (had > count) add_run(first + count, had - count);
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
    take_run(next++);
  }
  if (next != free_.begin()) {
    const auto before = std::prev(next);
    SKERRY_ASSERT(before->first + before->second <= range.first);
    if (before->first + before->second == range.first) {
      range = {before->first, before->second + range.count};
      take_run(before);
    }
  }
  add_run(range.first, range.count);
}

void OffsetArena::add_run(std::uint32_t first, std::uint32_t count) {
  free_.emplace(first, count);
  by_count_.emplace(count, first);
}

void OffsetArena::take_run(std::map<std::uint32_t, std::uint32_t>::iterator run) {
  by_count_.erase({run->second, run->first});
  free_.erase(run);
}

std::uint32_t OffsetArena::largest_free() const {
  return by_count_.empty() ? 0 : by_count_.rbegin()->first;
}

void OffsetArena::grow(std::uint32_t capacity) {
  SKERRY_ASSERT(capacity >= capacity_);
  if (capacity == capacity_) return;
  give_back({capacity_, capacity - capacity_});
  capacity_ = capacity;
}

}  // namespace skerry::gpu
