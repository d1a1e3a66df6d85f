#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/result.h"

namespace skerry::gpu {

/// A run of elements in an arena.
struct ArenaRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// Sub-allocates [0, capacity) elements by offset: best fit, neighbours merge on free. A range
/// freed at timeline value v is only handed out again once `completed >= v`, so that the GPU never
/// reads what is being overwritten.
class OffsetArena {
 public:
  explicit OffsetArena(std::uint32_t capacity);
  /// Errors when nothing fits: says wanted, free, largest free run and what to lower.
  Result<ArenaRange> allocate(std::uint32_t count);
  void free(ArenaRange range, std::uint64_t after_value);
  /// Makes ranges freed at or before `completed` available.
  void collect(std::uint64_t completed);
  /// Appends room. @pre capacity >= capacity().
  void grow(std::uint32_t capacity);
  std::uint32_t capacity() const { return capacity_; }
  std::uint32_t used() const { return used_; }        ///< allocated, not yet freed
  std::uint32_t waiting() const { return waiting_; }  ///< freed, still in flight
  std::uint32_t largest_free() const;

 private:
  void give_back(ArenaRange range);
  void add_run(std::uint32_t first, std::uint32_t count);
  void take_run(std::map<std::uint32_t, std::uint32_t>::iterator run);
  std::uint32_t capacity_, used_ = 0, waiting_ = 0;
  std::map<std::uint32_t, std::uint32_t> free_;                 // first -> count
  std::set<std::pair<std::uint32_t, std::uint32_t>> by_count_;  // of free_: count, first
  struct Waiting {
    ArenaRange range;
    std::uint64_t value;
  };
  std::vector<Waiting> waiting_ranges_;
};

}  // namespace skerry::gpu
