#include "world/islands/medium.h"

#include <cmath>

#include "world/voxel/blocks.h"

namespace skerry::world {

Medium medium_at(const World& world, std::uint64_t island, const glm::dvec3& place) {
  IVec3 voxel{static_cast<std::int32_t>(std::floor(place.x)),
              static_cast<std::int32_t>(std::floor(place.y)),
              static_cast<std::int32_t>(std::floor(place.z))};
  const BlockId block = world.block_at(island, voxel).value_or(kAir);
  if (block_kind(block) != BlockKind::kTranslucent) return {};
  constexpr int kDeepest = 64;  // blocks
  for (int depth = 0; depth < kDeepest; ++depth) {
    const IVec3 below = voxel;
    ++voxel.y;
    const BlockId above = world.block_at(island, voxel).value_or(kAir);
    if (above == block) continue;
    if (block_kind(above) == BlockKind::kOpaque) break;
    return {block, below};
  }
  return {block, {}};
}

}  // namespace skerry::world
