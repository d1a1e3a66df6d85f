#include "world/islands/medium.h"

#include <algorithm>
#include <cmath>

#include "world/voxel/blocks.h"

namespace skerry::world {

Medium medium_at(const World& world, std::uint64_t island, const glm::dvec3& place) {
  IVec3 voxel{static_cast<std::int32_t>(std::floor(place.x)),
              static_cast<std::int32_t>(std::floor(place.y)),
              static_cast<std::int32_t>(std::floor(place.z))};
  const BlockId block = world.block_at(island, voxel).value_or(kAir);
  if (block_kind(block) != BlockKind::kTranslucent) return {};
  constexpr int kFull = 32, kDeepest = 64;  // blocks
  for (int depth = 0; depth < kDeepest; ++depth) {
    const IVec3 below = voxel;
    ++voxel.y;
    const BlockId above = world.block_at(island, voxel).value_or(kAir);
    if (above == block) continue;
    if (block_kind(above) == BlockKind::kOpaque) break;
    const double deep = (voxel.y - place.y - kFull) / (kDeepest - kFull);
    const double t = std::clamp(deep, 0.0, 1.0);
    return {block, below, static_cast<float>(1.0 - t * t * (3.0 - 2.0 * t))};
  }
  return {block, {}, 0.0f};
}

}  // namespace skerry::world
