#include "game/map/island_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "game/map/map_maker.h"
#include "game/map/map_picture.h"
#include "game/ui/map_facts.h"
#include "world/generate/generate.h"
#include "world/voxel/blocks.h"

namespace skerry::game {
namespace {

/// The voxels of an island, generated chunk by chunk.
class Voxels {
 public:
  explicit Voxels(const world::IslandSpec& spec) : generator_(spec) {}
  world::BlockId at(int x, int y, int z) {
    const auto chunk = [](int v) { return static_cast<int>(world::floor_div(v, 64)); };
    const world::IVec3 c{chunk(x), chunk(y), chunk(z)};
    const auto [entry, fresh] = chunks_.try_emplace(c);
    if (fresh) {
      entry->second.resize(std::size_t{66} * 66 * 66);
      generator_.generate_padded(c, 0, entry->second);
    }
    return entry->second[static_cast<std::size_t>((z - c.z * 64 + 1) + 66 * (x - c.x * 64 + 1) +
                                                  66 * 66 * (y - c.y * 64 + 1))];
  }

 private:
  world::IslandGenerator generator_;
  std::map<world::IVec3, std::vector<world::BlockId>> chunks_;
};

/// A chart is of the plan; the voxels are what it must agree with. Cliffs are shifted sideways and
/// arches and crowns are left out, so not every column can.
TEST(IslandChart, AgreesWithTheVoxelsThatAreGenerated) {
  for (const world::IslandSpec& spec : world::islands_within(1, {}, 200.0)) {
    if (spec.bounding_radius > 140.0) continue;
    const IslandChart chart = chart_of(spec);
    Voxels voxels(spec);
    int land = 0, right = 0, exact = 0, empty = 0, right_empty = 0;
    for (int x = -100; x < 100; x += 6) {
      for (int z = -100; z < 100; z += 6) {
        const int height_at = [&] {
          const IslandChart::Cell* cell = chart.at(x, z);
          return cell ? int{cell->height} : IslandChart::kNoLand;
        }();
        if (height_at == IslandChart::kNoLand) {
          ++empty;
          right_empty += voxels.at(x, 0, z) == world::kAir;
          continue;
        }
        ++land;
        // Cliffs are ragged: their surface is some blocks up or down.
        const auto ground = [&](int y) {
          const world::BlockId block = voxels.at(x, y, z);
          return world::is_solid(block) || block == world::block::kWater ||
                 block == world::block::kLava;
        };
        bool surface = false;
        for (int y = height_at - 3; y <= height_at + 3; ++y) surface |= ground(y - 1) && !ground(y);
        right += surface;
        exact += ground(height_at - 1) && !ground(height_at);
      }
    }
    ASSERT_GT(land, 0);
    EXPECT_GE(right, land * 8 / 10) << spec.id << ": " << right << " of " << land;
    EXPECT_GE(exact, land / 2) << spec.id << ": " << exact << " of " << land;
    EXPECT_GE(right_empty, empty * 95 / 100) << spec.id;
  }
}

TEST(IslandChart, AnIslandWithoutAPlanIsTheOutlineOfItsBox) {
  world::IslandSpec spec;
  spec.box_min = {-10, -3, -4};
  spec.box_max = {20, 7, 6};
  const IslandChart chart = outline_of(spec);
  ASSERT_TRUE(chart.at(-10.0, -4.0));
  EXPECT_EQ(chart.at(-10.0, -4.0)->height, 7);
  EXPECT_TRUE(chart.at(19.5, 5.5));
  for (const auto& [x, z] : {std::pair(-10.1, 0.0), {20.1, 0.0}, {0.0, -4.1}, {0.0, 6.1}})
    EXPECT_FALSE(chart.at(x, z)) << x << ", " << z;
}

/// One cell of a height at a place of the lattice.
std::shared_ptr<const IslandChart> post(int x, int z, std::int16_t height, std::uint8_t red) {
  IslandChart chart;
  chart.low_x = x;
  chart.low_z = z;
  chart.cells_x = chart.cells_z = 1;
  chart.cells = {{height, red, 100, 100}};
  return std::make_shared<const IslandChart>(chart);
}

/// Blocks east and south of the middle where a picture has land: its centre of mass.
glm::dvec2 middle_of_land(const ui::Rgba& map, double radius) {
  glm::dvec2 sum{};
  int count = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const std::size_t at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                              static_cast<std::size_t>(x)) *
                             4;
      if (map.pixels[at + 3] == 0) continue;
      sum += glm::dvec2((x + 0.5) / map.width * 2.0 - 1.0, (y + 0.5) / map.height * 2.0 - 1.0) *
             radius;
      ++count;
    }
  }
  EXPECT_GT(count, 0);
  return sum / double(std::max(count, 1));
}

TEST(MapPicture, PutsLandWhereItsPoseHasIt) {
  constexpr double kRadius = 50.0;
  for (const double heading : {0.0, 0.7, 1.9, -2.5}) {
    const MapLand land{post(20, -6, 3, 100), {5.0, 8.0}, 0.0, heading};
    const glm::dvec2 found = middle_of_land(draw_map({&land, 1}, kRadius, 400), kRadius);
    // The cell's middle, turned as a pose turns it.
    const glm::dquat turn = glm::angleAxis(heading, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 there = turn * glm::dvec3(21.0, 0.0, -5.0);
    EXPECT_NEAR(found.x, 5.0 + there.x, 0.2) << heading;
    EXPECT_NEAR(found.y, 8.0 + there.z, 0.2) << heading;
  }
}

TEST(MapPicture, WhatIsHigherCoversWhatIsLowerInAnyOrder) {
  std::vector<MapLand> lands{{post(-1, -1, 40, 250), {}, -30.0, 0.0},
                             {post(-1, -1, 5, 10), {}, 8.0, 0.0}};
  const auto red = [&] {
    const ui::Rgba map = draw_map(lands, 4.0, 64);
    return int{map.pixels[(32 * 64 + 32) * 4]};
  };
  EXPECT_LT(red(), 40);  // 13 over 10
  std::swap(lands[0], lands[1]);
  EXPECT_LT(red(), 40);
}

MapMaker::Request map_of(std::uint64_t seed, double radius) {
  MapMaker::Request request;
  request.radius = radius;
  for (const world::IslandSpec& spec : world::islands_within(seed, {}, radius * 1.5)) {
    const glm::dvec3 at = world::difference_blocks(spec.origin, request.middle);
    request.islands.push_back({spec, true, {nullptr, {at.x, at.z}, at.y, spec.yaw_rad}});
  }
  return request;
}

MapMaker::Map drawn(MapMaker& maker, const MapMaker::Request& request) {
  maker.ask(request);
  while (!maker.idle()) std::this_thread::yield();
  return maker.take().value();
}

TEST(MapMaker, DrawsAllThatWasAskedForAndKeepsCharts) {
  MapMaker maker;
  const MapMaker::Request request = map_of(3, 400.0);
  ASSERT_FALSE(request.islands.empty());
  MapMaker::Map map = drawn(maker, request);
  for (int round = 0; round < 100 && map.to_come != 0; ++round) map = drawn(maker, request);
  EXPECT_EQ(map.to_come, 0u);
  EXPECT_EQ(map.picture.width, MapMaker::kEdge);
  EXPECT_FALSE(maker.take());  // once
  EXPECT_EQ(drawn(maker, request).picture.pixels, map.picture.pixels);
}

/// SKERRY_MAP_COST=1: what maps cost, for docs/performance.md.
TEST(MapMaker, SaysWhatMapsCost) {
  if (!std::getenv("SKERRY_MAP_COST")) GTEST_SKIP() << "for measuring";
  for (const double radius : ui::kMapRadii) {
    MapMaker maker;
    const MapMaker::Request request = map_of(1, radius);
    double chart_ms = 0.0;
    MapMaker::Map map;
    do {
      map = drawn(maker, request);
      chart_ms += map.chart_ms;
    } while (map.to_come != 0);
    std::vector<double> draw_ms;
    for (int i = 0; i < 9; ++i) draw_ms.push_back(drawn(maker, request).draw_ms);
    std::sort(draw_ms.begin(), draw_ms.end());
    std::printf("%6.0f blocks: %zu islands, charts %.1f ms, a map %.2f ms (%.2f to %.2f)\n", radius,
                request.islands.size(), chart_ms, draw_ms[4], draw_ms[0], draw_ms[8]);
  }
}

}  // namespace
}  // namespace skerry::game
