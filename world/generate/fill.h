#pragma once
#include <cstdint>
#include <span>

#include "world/generate/plan.h"

namespace skerry::world {

/// The two ways of fill_padded(): all blocks, and the voxels of a coarse level.
/// @param chunk not outside of all that the plan holds. @param out 66^3 ids, all of them set.
void fill_fine(const IslandPlan& plan, IVec3 chunk, std::span<BlockId> out);
/// @param level 1 or more.
void fill_coarse(const IslandPlan& plan, IVec3 chunk, int level, std::span<BlockId> out);

// What both know of ground.
inline constexpr int kLedgeTurf = 4;              // blocks under the top that may still bear turf
inline constexpr std::int16_t kUnderground = 64;  // depth of rock below a cave: no turf there
inline constexpr std::int16_t kDeepest = 2 * kUnderground;
inline constexpr Ball kOpenHole = {0, 0, 0, 0, 0, true};
inline constexpr Ball kClosedHole = {0, 0, 0, 0, 0, false};

/// `yes` where the condition holds, else `no`, as a mask: vectorisers keep it free of branches.
inline std::int16_t select(bool condition, std::int16_t yes, std::int16_t no) {
  const auto mask = static_cast<std::int16_t>(-static_cast<int>(condition));
  return static_cast<std::int16_t>((yes & mask) | (no & ~mask));
}

}  // namespace skerry::world
