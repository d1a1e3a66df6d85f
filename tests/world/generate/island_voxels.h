// Islands of every kind, and all of their voxels, for tests of the generator.
#pragma once
#include <vector>

#include "world/generate/biome.h"
#include "world/generate/generate.h"
#include "world/generate/shape.h"
#include "world/voxel/hash.h"

namespace skerry::world {

inline constexpr int kPadded = 66;
inline constexpr std::size_t kPaddedCount = std::size_t{kPadded} * kPadded * kPadded;

inline BlockId padded_at(const std::vector<BlockId>& voxels, int x, int y, int z) {
  return voxels[static_cast<std::size_t>((z + 1) + kPadded * (x + 1) +
                                         kPadded * kPadded * (y + 1))];
}

/// A spec outside the archipelago, so that each archetype and biome can be asked for.
inline IslandSpec spec_for(Archetype archetype, Biome biome, int radius, std::uint64_t seed) {
  const Extent extent = extent_of(archetype, radius);
  IslandSpec spec;
  spec.seed = seed;
  spec.archetype = static_cast<std::uint32_t>(archetype);
  spec.biome = static_cast<std::uint32_t>(biome);
  const int side = radius + kBoxMargin;
  spec.box_min = {-side, -extent.depth - kKeelRoom, -side};
  spec.box_max = {side, extent.top + kTreeRoom, side};
  spec.bounding_radius = extent.sphere;
  return spec;
}

inline std::vector<IslandSpec> one_of_each(int radius) {
  std::vector<IslandSpec> specs;
  for (int a = 0; a < static_cast<int>(Archetype::kCount); ++a) {
    const auto biome = static_cast<Biome>(a % static_cast<int>(Biome::kCount));
    specs.push_back(spec_for(static_cast<Archetype>(a), biome, radius,
                             mix64(static_cast<std::uint64_t>(a) + 1)));
  }
  return specs;
}

/// All voxels of an island at a level of detail.
struct Voxels {
  IVec3 low, high;
  std::vector<BlockId> ids;
  std::size_t outside = 0;  // voxels beyond the spec's box

  explicit Voxels(const IslandSpec& spec, int level = 0)
      : low{spec.box_min.x >> level, spec.box_min.y >> level, spec.box_min.z >> level},
        high{((spec.box_max.x - 1) >> level) + 1, ((spec.box_max.y - 1) >> level) + 1,
             ((spec.box_max.z - 1) >> level) + 1} {
    ids.assign(static_cast<std::size_t>(high.x - low.x) * (high.y - low.y) * (high.z - low.z),
               kAir);
    const IslandGenerator generator(spec);
    std::vector<BlockId> voxels(kPaddedCount);
    for (const IVec3 c : generator.chunks(level)) {
      if (!generator.generate_padded(c, level, voxels)) continue;
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
          for (int z = 0; z < 64; ++z)
            put(c.x * 64 + x, c.y * 64 + y, c.z * 64 + z, padded_at(voxels, x, y, z));
        }
      }
    }
  }
  bool has(int x, int y, int z) const {
    return x >= low.x && x < high.x && y >= low.y && y < high.y && z >= low.z && z < high.z;
  }
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(y - low.y) * (high.x - low.x) + (x - low.x)) *
               (high.z - low.z) +
           (z - low.z);
  }
  BlockId at(int x, int y, int z) const { return has(x, y, z) ? ids[index(x, y, z)] : kAir; }
  template <class F>
  void for_each(F&& f) const {
    for (int y = low.y; y < high.y; ++y) {
      for (int x = low.x; x < high.x; ++x) {
        for (int z = low.z; z < high.z; ++z) f(x, y, z, ids[index(x, y, z)]);
      }
    }
  }

 private:
  void put(int x, int y, int z, BlockId id) {
    if (has(x, y, z)) {
      ids[index(x, y, z)] = id;
    } else if (id != kAir) {
      ++outside;
    }
  }
};

}  // namespace skerry::world
