#include "world/voxel/coords.h"

#include <cmath>

namespace skerry::world {

WorldPos moved(WorldPos from, glm::dvec3 by_blocks) {
  const auto units = [](double blocks) {
    return static_cast<std::int64_t>(std::llround(blocks * static_cast<double>(kUnitsPerBlock)));
  };
  return from + WorldPos{units(by_blocks.x), units(by_blocks.y), units(by_blocks.z)};
}

}  // namespace skerry::world
