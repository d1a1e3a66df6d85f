// What the tests of smooth edges share: a world of many edges, and how far pictures are apart.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "world/voxel/blocks.h"

namespace skerry::render {

using Bytes = std::vector<std::uint8_t>;

/// Steps and towers of one block, so that all edges are of faces.
inline world::BlockId rough(int x, int y, int z) {
  const unsigned h =
      (static_cast<unsigned>(x / 2) * 73856093u) ^ (static_cast<unsigned>(z / 2) * 19349663u);
  const int height = static_cast<int>((h >> 7) % 3) + (x + 64) / 8 % 2 * 2;
  return y > height ? world::block::kAirBlock : world::block::kStone;
}
inline double light_of(std::uint8_t encoded) {
  return encoded / 255.0 * (encoded / 255.0);
}

/// Mean distance of light, of 255.
inline double error_of(const Bytes& picture, const Bytes& exact) {
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.size(); ++i)
    sum += std::abs(light_of(picture[i]) - light_of(exact[i]));
  return 255.0 * sum / static_cast<double>(picture.size());
}

/// Pixels of which a channel differs by more than 40.
inline int far_off(const Bytes& a, const Bytes& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); i += 4)
    count += std::abs(a[i] - b[i]) > 40 || std::abs(a[i + 1] - b[i + 1]) > 40 ||
             std::abs(a[i + 2] - b[i + 2]) > 40;
  return count;
}

}  // namespace skerry::render
