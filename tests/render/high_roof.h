#pragma once
#include <algorithm>
#include <cmath>

#include "world/voxel/blocks.h"

namespace skerry::render {

/// A plane of stone and, 59 blocks above it, the edge of a roof that covers where x is positive.
inline world::BlockId high_roof(int x, int y, int) {
  return y < 0 || (y == 59 && x >= 0) ? world::block::kStone : world::block::kAirBlock;
}

/// Part of a disc of radius 1 on the far side of a line at signed distance d from its centre.
inline double share_of_disc(double d) {
  if (std::abs(d) >= 1.0) return d > 0.0 ? 1.0 : 0.0;
  return 0.5 + (std::asin(d) + d * std::sqrt(1.0 - d * d)) / M_PI;
}

}  // namespace skerry::render
