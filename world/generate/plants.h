#pragma once
#include "world/generate/plan.h"

namespace skerry::world {

/// What grows in the air on a column's ground, unless something else is there; kAir: nothing.
/// @param ground the block under it.
BlockId plant_on(const IslandPlan& plan, BlockId ground, int x, int z);

/// Draws the plants that glow at a coarse level. A plant as large as a voxel has the area and light
/// of 4^level plants and stands for so many of those in the chunk, at the place of one of them.
/// @param canvas of a coarse level, with all else in it.
void draw_glowing_plants(const IslandPlan& plan, const Canvas& canvas);

}  // namespace skerry::world
