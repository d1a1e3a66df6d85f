#pragma once
#include "world/generate/plan.h"

namespace skerry::world {

/// Draws the plants that glow at a coarse level. A plant as large as a voxel has the area and light
/// of 4^level plants and stands for so many of those in the chunk, at the place of one of them.
/// @param canvas of a coarse level, with all else in it.
void draw_glowing_plants(const IslandPlan& plan, const Canvas& canvas);

}  // namespace skerry::world
