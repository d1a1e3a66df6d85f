// Volumes for tests.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <set>
#include <utility>

#include "world/vdb/volume_grid.h"
#include "world/voxel/hash.h"

namespace skerry::world {

inline void sort_parts(VolumeGrid& grid) {
  const auto by_origin = [](const auto& a, const auto& b) { return a.origin < b.origin; };
  std::sort(grid.bricks.begin(), grid.bricks.end(), by_origin);
  std::sort(grid.tiles.begin(), grid.tiles.end(), by_origin);
}

/// Bricks at random places within +-64 and tiles of 16 and 32 beyond them, values within +-1.
inline VolumeGrid random_volume(std::uint64_t seed, int bricks, int tiles) {
  Rng random(seed);
  VolumeGrid grid;
  grid.kind = VolumeKind::kFog;
  grid.world_from_index[3] = {0.5, -0.25, 3.0, 1.0};
  std::set<IVec3> taken;
  const auto place = [&](int edge, int offset) {
    const IVec3 at{random.in(-4, 3) * edge + offset, random.in(-4, 3) * edge,
                   random.in(-4, 3) * edge};
    return std::pair(at, taken.insert(at).second);
  };
  const auto value = [&random] { return static_cast<float>(random.in(-1000, 1000)) * 1e-3f; };
  for (int i = 0; i < bricks; ++i) {
    const auto [at, fresh] = place(kBrickEdge, 0);
    if (!fresh) continue;
    VolumeBrick& brick = grid.bricks.emplace_back(VolumeBrick{at, {}});
    for (float& v : brick.values) v = value();
  }
  for (int i = 0; i < tiles; ++i) {
    const int edge = i % 2 == 0 ? 16 : 32;
    const auto [at, fresh] = place(edge, 256 + 256 * (i % 2));
    if (fresh) grid.tiles.push_back({at, edge, value()});
  }
  sort_parts(grid);
  return grid;
}

/// A grid with a value for each index in [low, high), from a function.
inline VolumeGrid filled_volume(VolumeKind kind, IVec3 low, IVec3 high, float background,
                                const std::function<float(IVec3)>& value) {
  VolumeGrid grid;
  grid.kind = kind;
  grid.name = "grid";
  grid.background = background;
  grid.min_value = grid.max_value = background;
  double sum = 0.0, count = 0.0;
  const auto down = [](std::int32_t v) { return static_cast<std::int32_t>(floor_div(v, 8)) * 8; };
  for (std::int32_t bx = down(low.x); bx < high.x; bx += 8) {
    for (std::int32_t by = down(low.y); by < high.y; by += 8) {
      for (std::int32_t bz = down(low.z); bz < high.z; bz += 8) {
        VolumeBrick& brick = grid.bricks.emplace_back(VolumeBrick{{bx, by, bz}, {}});
        for (int i = 0; i < 512; ++i) {
          const IVec3 at{bx + (i >> 6), by + (i >> 3 & 7), bz + (i & 7)};
          const bool inside = at.x >= low.x && at.x < high.x && at.y >= low.y && at.y < high.y &&
                              at.z >= low.z && at.z < high.z;
          const float v = inside ? value(at) : background;
          brick.values[static_cast<std::size_t>(i)] = v;
          grid.min_value = std::min(grid.min_value, v);
          grid.max_value = std::max(grid.max_value, v);
          if (v == background) continue;
          ++grid.active_voxels;
          sum += static_cast<double>(v);
          count += 1.0;
        }
      }
    }
  }
  if (count > 0.0) grid.mean_value = static_cast<float>(sum / count);
  return grid;
}

}  // namespace skerry::world
