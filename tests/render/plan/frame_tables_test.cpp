#include "engine/render/plan/frame_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/render/random_scenes.h"
#include "tests/same_bits.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{640, 360};

std::vector<ActiveCascade> cascades_of(const FrameInput& input, const RenderSettings& settings) {
  CascadeInput in;
  in.to_light = input.sky.to_sun;
  in.camera = input.camera.position;
  in.anchor = input.anchor;
  in.far_blocks = input.reach_blocks;
  in.map_size = settings.shadow_size;
  std::vector<ActiveCascade> out;
  for (const Cascade& cascade : make_cascades(in)) {
    const auto index = static_cast<std::uint32_t>(out.size());
    const auto edge = static_cast<std::uint32_t>(settings.shadow_size);
    out.push_back({0,
                   static_cast<int>(index),
                   index,
                   index,
                   index != 1,
                   {{0, 0}, {edge, edge}},
                   input.sky.to_sun,
                   cascade});
  }
  return out;
}

FrameInput random_input(RandomPlaces& random, std::vector<IslandPlacement>& islands) {
  islands.clear();
  for (int i = 0; i < 20; ++i)
    islands.push_back({fixed_at(random.in_box(3000.0)), random.turn(), 200.0});
  FrameInput input;
  input.camera.position = fixed_at(random.in_box(1000.0));
  input.camera.yaw_deg = random.uniform(0.0, 360.0);
  input.camera.pitch_deg = random.uniform(-80.0, 80.0);
  input.islands = islands;
  input.sky = celestial_at(random.uniform(25000.0, 60000.0), 0.5);
  return input;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(FrameTables, IslandsAreExactAtTheEdgeOfTheWorld) {
  RandomPlaces random(1);
  for (int i = 0; i < 5000; ++i) {
    const std::int64_t far = kUnits << 40;
    const FixedPos camera{random.whole(-far, far), random.whole(-far, far),
                          random.whole(-far, far)};
    // Up to 2^24 units a float holds any whole number: then the very place must come out.
    const std::int64_t reach = std::int64_t{1} << random.whole(1, 24);
    const FixedPos offset{random.whole(-reach, reach), random.whole(-reach, reach),
                          random.whole(-reach, reach)};
    IslandPlacement island;
    island.origin = sum(camera, offset);
    const shared::IslandTransform t = transform_of(island, camera);
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_EQ(static_cast<double>(t.translation[axis]) * static_cast<double>(kUnits),
                static_cast<double>(offset[static_cast<std::size_t>(axis)]));
  }
}

TEST(FrameTables, IslandsTurnTheirLatticeByTheirRotation) {
  RandomPlaces random(2);
  for (int i = 0; i < 2000; ++i) {
    const IslandPlacement island{fixed_at(random.in_box(500.0)), random.turn(), 100.0};
    const FixedPos camera = fixed_at(random.in_box(500.0));
    const shared::IslandTransform t = transform_of(island, camera);
    const glm::dvec3 p = random.in_box(300.0);
    // Rodrigues' formula, independent of quaternion arithmetic.
    const double angle = 2.0 * std::acos(std::min(1.0, std::abs(island.rotation.w)));
    const double sign = island.rotation.w < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 vector{island.rotation.x, island.rotation.y, island.rotation.z};
    const glm::dvec3 axis =
        glm::length(vector) > 0.0 ? sign * glm::normalize(vector) : glm::dvec3(0, 1, 0);
    const glm::dvec3 turned = p * std::cos(angle) + glm::cross(axis, p) * std::sin(angle) +
                              axis * glm::dot(axis, p) * (1.0 - std::cos(angle));
    const glm::dvec3 expected = turned + blocks_at(island.origin) - blocks_at(camera);
    const glm::dvec3 got = glm::dvec3(t.axis_x) * p.x + glm::dvec3(t.axis_y) * p.y +
                           glm::dvec3(t.axis_z) * p.z + glm::dvec3(t.translation);
    EXPECT_LT(glm::length(got - expected), 3e-4);
  }
}

TEST(FrameTables, MovingEverythingAlikeChangesNoByte) {
  RandomPlaces random(3);
  const RenderSettings settings;
  for (int i = 0; i < 20; ++i) {
    std::vector<IslandPlacement> islands;
    FrameInput input = random_input(random, islands);
    const FrameTables here = build_tables(input, settings, kSize, cascades_of(input, settings));
    for (const int bits : {24, 40}) {
      const FixedPos offset{kUnits << bits, -(kUnits << bits) + 3, (kUnits << bits) / 3};
      std::vector<IslandPlacement> moved = islands;
      for (IslandPlacement& island : moved) island.origin = sum(island.origin, offset);
      FrameInput away = input;
      away.islands = moved;
      away.camera.position = sum(input.camera.position, offset);
      away.anchor = sum(input.anchor, offset);
      const FrameTables there = build_tables(away, settings, kSize, cascades_of(away, settings));
      EXPECT_TRUE(same_bits(here.constants, there.constants));
      EXPECT_TRUE(same_bytes(here.views, there.views));
      EXPECT_TRUE(same_bytes(here.matrices, there.matrices));
      EXPECT_TRUE(same_bytes(here.islands, there.islands));
    }
  }
}

TEST(FrameTables, HaveTheCameraFirstAndThenTheCascadesToDraw) {
  RandomPlaces random(4);
  std::vector<IslandPlacement> islands;
  const FrameInput input = random_input(random, islands);
  const RenderSettings settings;
  const std::vector<ActiveCascade> cascades = cascades_of(input, settings);  // number 1 is kept
  const FrameTables tables = build_tables(input, settings, kSize, cascades);
  ASSERT_EQ(tables.views.size(), 4u);
  ASSERT_EQ(tables.matrices.size(), 4u);
  ASSERT_EQ(tables.islands.size(), 4 * islands.size());
  EXPECT_EQ(tables.views[0].orthographic, 0u);
  constexpr std::array<std::size_t, 3> kDrawn{0, 2, 3};
  for (std::size_t view = 1; view < 4; ++view) {
    const Cascade& cascade = cascades[kDrawn[view - 1]].cascade;
    EXPECT_EQ(tables.views[view].orthographic, 1u);
    EXPECT_EQ(tables.matrices[view], cascade.clip_from_centre);
    for (std::size_t i = 0; i < islands.size(); ++i) {
      const glm::vec3 expected(blocks_at(islands[i].origin) - blocks_at(cascade.centre));
      EXPECT_LT(glm::length(tables.islands[view * islands.size() + i].translation - expected),
                1e-3f);
    }
  }
  EXPECT_EQ(tables.constants.bodies[0].cascade_count, 4u);
  EXPECT_EQ(tables.constants.bodies[1].cascade_count, 0u);
}

TEST(FrameTables, CastersBeyondAMapsRangeAreNotCulled) {
  RandomPlaces random(5);
  for (int i = 0; i < 50; ++i) {
    std::vector<IslandPlacement> islands;
    const FrameInput input = random_input(random, islands);
    const RenderSettings settings;
    const std::vector<ActiveCascade> cascades = cascades_of(input, settings);
    const FrameTables tables = build_tables(input, settings, kSize, cascades);
    // Straight above the middle of every map, towards the light, however far.
    for (const double distance : {0.0, 1e3, 1e5, 1e6}) {
      const glm::dvec3 p = input.sky.to_sun * distance;
      for (std::size_t view = 1; view < tables.views.size(); ++view)
        for (const glm::vec4& plane : tables.views[view].planes)
          EXPECT_GE(glm::dot(glm::dvec3(plane), p) + static_cast<double>(plane.w),
                    -1e-6 * distance);
    }
  }
}

// What a shader samples and what was drawn are the same map: through either matrix a point of the
// world falls on the same texel and depth.
TEST(FrameTables, ShadersFindAPointWhereItWasDrawn) {
  RandomPlaces random(6);
  for (int i = 0; i < 50; ++i) {
    std::vector<IslandPlacement> islands;
    const FrameInput input = random_input(random, islands);
    const RenderSettings settings;
    const std::vector<ActiveCascade> cascades = cascades_of(input, settings);
    const FrameTables tables = build_tables(input, settings, kSize, cascades);
    constexpr std::array<std::size_t, 3> kDrawn{0, 2, 3};
    for (std::size_t view = 1; view < 4; ++view) {
      const std::size_t layer = kDrawn[view - 1];
      const shared::Cascade& c = tables.constants.cascades[layer];
      EXPECT_EQ(c.layer, layer);
      const glm::dvec3 p = random.direction() * static_cast<double>(c.radius) * 0.9;
      const glm::dvec3 from_centre =
          p + blocks_at(input.camera.position) - blocks_at(cascades[layer].cascade.centre);
      const glm::dvec4 clip = glm::dmat4(tables.matrices[view]) * glm::dvec4(from_centre, 1.0);
      const double size = settings.shadow_size;
      EXPECT_NEAR(glm::dot(glm::dvec4(c.map_from_world_x), glm::dvec4(p, 1.0)),
                  (clip.x * 0.5 + 0.5) * size, 0.02);
      EXPECT_NEAR(glm::dot(glm::dvec4(c.map_from_world_y), glm::dvec4(p, 1.0)),
                  (clip.y * 0.5 + 0.5) * size, 0.02);
      EXPECT_NEAR(glm::dot(glm::dvec4(c.map_from_world_z), glm::dvec4(p, 1.0)), clip.z, 1e-5);
    }
  }
}

TEST(ShiftView, KeepsThePlanesWhereTheyStoodInTheWorld) {
  RandomPlaces random(7);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 frozen = random.in_box(500.0), now = frozen + random.in_box(50.0);
    shared::CullView view{};
    for (glm::vec4& plane : view.planes)
      plane = glm::vec4(glm::vec3(random.direction()), static_cast<float>(random.uniform(-9, 9)));
    const shared::CullView before = view;
    shift_view(view, fixed_at(frozen), fixed_at(now));
    EXPECT_LT(glm::length(glm::dvec3(view.eye) - (frozen - now)), 1e-4);
    const glm::dvec3 p = random.in_box(600.0);
    for (std::size_t k = 0; k < 6; ++k) {
      const auto side = [&](const glm::vec4& plane, glm::dvec3 camera) {
        return glm::dot(glm::dvec3(plane), p - camera) + static_cast<double>(plane.w);
      };
      EXPECT_NEAR(side(view.planes[k], now), side(before.planes[k], frozen), 1e-3);
    }
  }
}

}  // namespace
}  // namespace skerry::render
