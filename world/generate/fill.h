#pragma once
#include <span>

#include "world/generate/plan.h"

namespace skerry::world {

/// The two ways of fill_padded(): all blocks, and the voxels of a coarse level.
/// @param chunk not outside of all that the plan holds. @param out 66^3 ids, all of them set.
void fill_fine(const IslandPlan& plan, IVec3 chunk, std::span<BlockId> out);
/// @param level 1 or more.
void fill_coarse(const IslandPlan& plan, IVec3 chunk, int level, std::span<BlockId> out);

}  // namespace skerry::world
