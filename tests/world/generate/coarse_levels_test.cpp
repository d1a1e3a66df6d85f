// Coarse levels against the exact box filter of the voxels at full detail.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "tests/world/generate/island_voxels.h"

namespace skerry::world {
namespace {

bool is_tree(BlockId id) {
  return (id >= block::kOakLog && id <= block::kBlossomLeaves) || id == block::kMushroomCapRed ||
         id == block::kMushroomCapGlow || id == block::kMushroomStem;
}
bool is_crystal(BlockId id) {
  return id == block::kCrystalBlue || id == block::kCrystalViolet;
}
bool is_rock(BlockId id) {
  return block_kind(id) == BlockKind::kOpaque && !is_tree(id) && !is_crystal(id);
}
bool is_crown(BlockId id) {
  return block_kind(id) == BlockKind::kCutout || id == block::kMushroomCapRed ||
         id == block::kMushroomCapGlow;
}
/// Of all islands at a level, in blocks; `_f` is what is there at full detail.
struct Sums {
  double wrong = 0.0;    // voxels that are rock and should not be, or the other way around
  double surface = 0.0;  // voxels with a face in the open, of those that should be rock
  double rock = 0.0, rock_f = 0.0, crown = 0.0, crown_f = 0.0;
  double area = 0.0, area_f = 0.0;    // of silhouettes along the axes
  double off = 0.0;                   // what silhouettes lack or have too much
  double least_off = 0.0;             // what the best ones of voxels so large would
  double glow = 0.0, glow_f = 0.0;    // area of crystals that is seen from outside along the axes
  double lakes = 0.0, lakes_f = 0.0;  // area of liquids that is seen from above
  std::map<Texture, double> seen, seen_f;

  /// Share of the area seen that has another texture.
  double recolored() const {
    std::map<Texture, double> all = seen_f;
    all.insert(seen.begin(), seen.end());
    const auto total = [](const std::map<Texture, double>& of) {
      return std::accumulate(of.begin(), of.end(), 0.0,
                             [](double sum, const auto& entry) { return sum + entry.second; });
    };
    const auto share = [&](const std::map<Texture, double>& of, Texture texture) {
      const auto found = of.find(texture);
      return found == of.end() ? 0.0 : found->second / total(of);
    };
    double sum = 0.0;
    for (const auto& [texture, area_seen] : all)
      sum += std::abs(share(seen, texture) - share(seen_f, texture)) / 2.0;
    return sum;
  }
};

/// Calls f(u, w, first, last) with what is seen of each line of voxels along an axis from its ends.
template <class F>
void for_lines(const Voxels& v, int axis, F&& f) {
  const std::array<int, 3> low{v.low.x, v.low.y, v.low.z}, high{v.high.x, v.high.y, v.high.z};
  const auto along = static_cast<std::size_t>(axis);
  const std::size_t u = (along + 1) % 3, w = (along + 2) % 3;
  std::array<int, 3> at{};
  for (at[u] = low[u]; at[u] < high[u]; ++at[u]) {
    for (at[w] = low[w]; at[w] < high[w]; ++at[w]) {
      BlockId first = kAir, last = kAir;
      for (at[along] = low[along]; at[along] < high[along]; ++at[along]) {
        const BlockId id = v.at(at[0], at[1], at[2]);
        if (id == kAir || block_kind(id) == BlockKind::kPlant) continue;
        if (first == kAir) first = id;
        last = id;
      }
      if (first != kAir) f(at[u], at[w], first, last);
    }
  }
}

void add_rock(const Voxels& fine, const Voxels& coarse, int level, Sums& sums) {
  const double volume = std::pow(8.0, level);
  std::vector<int> rock(coarse.ids.size());
  fine.for_each([&](int x, int y, int z, BlockId id) {
    rock[coarse.index(x >> level, y >> level, z >> level)] += is_rock(id);
    sums.rock_f += is_rock(id);
    sums.crown_f += is_crown(id);
  });
  const auto solid = [&](int x, int y, int z) {
    return coarse.has(x, y, z) && 2 * rock[coarse.index(x, y, z)] >= volume;
  };
  coarse.for_each([&](int x, int y, int z, BlockId id) {
    sums.rock += is_rock(id) * volume;
    sums.crown += is_crown(id) * volume;
    sums.wrong += solid(x, y, z) != is_rock(id);
    sums.surface +=
        solid(x, y, z) && !(solid(x + 1, y, z) && solid(x - 1, y, z) && solid(x, y + 1, z) &&
                            solid(x, y - 1, z) && solid(x, y, z + 1) && solid(x, y, z - 1));
  });
}

void add_views(const Voxels& fine, const Voxels& coarse, int level, Sums& sums) {
  const double pixel = std::pow(4.0, level);
  for (int axis = 0; axis < 3; ++axis) {
    const auto texture = [axis](BlockId id, bool upper) {
      const BlockType& type = block_types()[id];
      return axis != 1 ? type.side : upper ? type.top : type.bottom;
    };
    const auto lake = [axis](BlockId last) {
      return axis == 1 && block_kind(last) == BlockKind::kTranslucent ? 1.0 : 0.0;
    };
    std::map<std::pair<int, int>, double> cover;  // of a pixel's area, and of what is drawn there
    for_lines(fine, axis, [&](int u, int w, BlockId first, BlockId last) {
      cover[{u >> level, w >> level}] += 1.0;
      ++sums.area_f;
      ++sums.seen_f[texture(first, false)];
      ++sums.seen_f[texture(last, true)];
      sums.glow_f += is_crystal(first) + is_crystal(last);
      sums.lakes_f += lake(last);
    });
    for (const auto& [at, area] : cover) {
      sums.off += area;
      sums.least_off += std::min(area, pixel - area);
    }
    for_lines(coarse, axis, [&](int u, int w, BlockId first, BlockId last) {
      sums.off += pixel - 2.0 * cover[{u, w}];
      sums.area += pixel;
      sums.seen[texture(first, false)] += pixel;
      sums.seen[texture(last, true)] += pixel;
      sums.glow += (is_crystal(first) + is_crystal(last)) * pixel;
      sums.lakes += lake(last) * pixel;
    });
  }
}

/// By level, of islands of all silhouettes and all biomes.
const std::array<Sums, kLevelCount>& sums_of_levels() {
  static const std::array<Sums, kLevelCount> all = [] {
    std::array<Sums, kLevelCount> sums;
    std::vector<IslandSpec> specs = one_of_each(70);
    for (int b = 0; b < static_cast<int>(Biome::kCount); ++b) {
      const auto archetype = static_cast<Archetype>((b + 3) % static_cast<int>(Archetype::kCount));
      specs.push_back(spec_for(archetype, static_cast<Biome>(b), 60,
                               mix64(static_cast<std::uint64_t>(b) + 100)));
    }
    for (const IslandSpec& spec : specs) {
      const Voxels fine(spec);
      for (int level = 1; level < kLevelCount; ++level) {
        const Voxels coarse(spec, level);
        add_rock(fine, coarse, level, sums[static_cast<std::size_t>(level)]);
        add_views(fine, coarse, level, sums[static_cast<std::size_t>(level)]);
      }
    }
    return sums;
  }();
  return all;
}

/// Calls f(level, sums, bound) with one bound for each coarse level.
template <class F>
void for_levels(const std::array<double, kLevelCount - 1>& bounds, F&& f) {
  for (std::size_t level = 1; level < kLevelCount; ++level) {
    SCOPED_TRACE(testing::Message() << "level " << level);
    f(sums_of_levels()[level], bounds[level - 1]);
  }
}

// One test: the sums take half a minute, and each test is a process of its own.
TEST(CoarseLevels, KeepWhatIsSeenOfFullDetail) {
  // Others are what is thin, which the filter loses, and ragged rock, which is looked at
  // in half of its blocks at level 1, in places at level 2, and is not shifted beyond.
  for_levels({0.08, 0.17, 0.16, 0.26}, [](const Sums& sums, double bound) {
    EXPECT_LT(sums.wrong / sums.surface, bound) << "rock is where half of the blocks are";
  });
  for_levels({0.05, 0.06, 0.05, 0.06}, [](const Sums& sums, double bound) {
    EXPECT_NEAR(sums.rock / sums.rock_f, 1.0, bound);
    EXPECT_NEAR(sums.crown / sums.crown_f, 1.0, bound);
  });
  // Islands of 70 blocks are nine voxels wide at level 4, and their rims are thinner than a voxel.
  for_levels({1.17, 1.21, 1.25, 1.24}, [](const Sums& sums, double bound) {
    EXPECT_LT(sums.off / sums.least_off, bound) << "silhouettes are nearly the best";
  });
  for_levels({0.02, 0.02, 0.05, 0.12}, [](const Sums& sums, double bound) {
    EXPECT_NEAR(sums.area / sums.area_f, 1.0, bound);
  });
  for_levels({0.05, 0.085, 0.16, 0.29},
             [](const Sums& sums, double bound) { EXPECT_LT(sums.recolored(), bound); });
  for_levels({0.12, 0.1, 0.1, 0.2}, [](const Sums& sums, double bound) {
    EXPECT_NEAR(sums.lakes / sums.lakes_f, 1.0, bound);
  });
  // A voxel of level 4 has the area of twenty crystals.
  for_levels({0.25, 0.15, 0.25, 1.0}, [](const Sums& sums, double bound) {
    EXPECT_NEAR(sums.glow / sums.glow_f, 1.0, bound) << "crystals";
  });
}

// Those that lie around the spawns of four seeds. At level 4 half of them are two voxels wide or
// less, and their keels are thinner than one.
TEST(CoarseLevels, SmallIslandsKeepTheirOutlines) {
  constexpr int kWidest = 60;  // radius, blocks
  std::array<Sums, kLevelCount> sums;
  for (const std::uint64_t seed : {1, 7, 11, 57})
    for (const IslandSpec& spec : islands_within(seed, {}, 1500.0)) {
      if (spec.box_max.x - kBoxMargin > kWidest) continue;
      const Voxels fine(spec);
      for (int level = 1; level < kLevelCount; ++level) {
        Sums island;
        add_views(fine, Voxels(spec, level), level, island);
        EXPECT_GT(island.area, 0.0) << "an islet is gone at level " << level << " of seed " << seed;
        Sums& all = sums[static_cast<std::size_t>(level)];
        all.area += island.area;
        all.area_f += island.area_f;
        all.off += island.off;
        all.least_off += island.least_off;
      }
    }
  constexpr std::array<double, kLevelCount> kOff{0.0, 1.17, 1.22, 1.23, 1.19},
      kArea{0.0, 0.03, 0.03, 0.06, 0.1};
  for (std::size_t level = 1; level < kLevelCount; ++level) {
    EXPECT_LT(sums[level].off / sums[level].least_off, kOff[level]) << "level " << level;
    EXPECT_NEAR(sums[level].area / sums[level].area_f, 1.0, kArea[level]) << "level " << level;
  }
}

/// Emission of all glowing plants, by id, times the area of their blocks.
std::map<BlockId, double> plants_that_glow(const IslandSpec& spec, int level) {
  std::map<BlockId, double> glow;
  Voxels(spec, level).for_each([&](int, int, int, BlockId id) {
    if (block_kind(id) == BlockKind::kPlant && block_types()[id].emission > 0.0f)
      glow[id] += static_cast<double>(block_types()[id].emission) * std::pow(4.0, level);
  });
  return glow;
}

// On the ground and in caves. A plant of level 4 stands for 256.
TEST(CoarseLevels, PlantsKeepTheirGlow) {
  std::array<std::map<BlockId, double>, kLevelCount> all;
  for (const Biome biome : {Biome::kMycelium, Biome::kMarsh, Biome::kVolcanic})
    for (int i = 0; i < 3; ++i) {
      const IslandSpec spec = spec_for(static_cast<Archetype>(2 * i + 1), biome, 170,
                                       mix64(static_cast<std::uint64_t>(i) + 40));
      for (int level = 0; level < kLevelCount; ++level)
        for (const auto& [id, glow] : plants_that_glow(spec, level))
          all[static_cast<std::size_t>(level)][id] += glow;
    }
  ASSERT_EQ(all[0].size(), 2u);
  constexpr std::array<double, kLevelCount> kBounds{0.0, 0.03, 0.03, 0.12, 0.25};
  for (std::size_t level = 1; level < kLevelCount; ++level)
    for (const auto& [id, glow] : all[0])
      EXPECT_NEAR(all[level][id] / glow, 1.0, kBounds[level])
          << "level " << level << ", " << block_types()[id].name;
}

// Each stands on ground.
TEST(CoarseLevels, PlantsThatGlowStandOnGround) {
  const IslandSpec spec = spec_for(Archetype::kTerraces, Biome::kMycelium, 120, 7);
  for (int level = 1; level < kLevelCount; ++level) {
    const Voxels coarse(spec, level);
    coarse.for_each([&](int x, int y, int z, BlockId id) {
      if (block_kind(id) == BlockKind::kPlant) {
        EXPECT_EQ(block_kind(coarse.at(x, y - 1, z)), BlockKind::kOpaque) << "level " << level;
      }
    });
  }
}

}  // namespace
}  // namespace skerry::world
