#include "game/view/light_chunk.h"

#include <utility>

namespace skerry::game {

std::vector<world::WeakLamp> take_weak(std::vector<LatticeLight>& lights, int level) {
  const float voxel = static_cast<float>(1 << level);  // blocks
  std::vector<world::WeakLamp> weak;
  std::erase_if(lights, [&](const LatticeLight& light) {
    if (light.range > kWeakLampRange * voxel) return false;
    weak.push_back({light.place / voxel, light.intensity / (voxel * voxel), light.range / voxel});
    return true;
  });
  return weak;
}

world::LightChunk light_chunk_of(const world::ReadySection& ready,
                                 std::vector<world::WeakLamp> weak,
                                 const std::vector<LatticeLight>& strong) {
  const float voxel = static_cast<float>(1 << ready.key.level);  // blocks
  std::vector<world::StrongLamp> places;
  for (const LatticeLight& light : strong)
    places.push_back({light.place / voxel, light.range / voxel, light.intensity / (voxel * voxel)});
  return {ready.occupancy, ready.leaves, ready.mesh.quads, std::move(weak), std::move(places),
          ready.stained,   voxel};
}

}  // namespace skerry::game
