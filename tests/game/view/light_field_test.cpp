#include "game/view/light_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <set>

#include "game/view/light_setup.h"
#include "game/view/scatter_lights.h"

namespace skerry::game {
namespace {

using Emitters = std::map<world::SectionKey, std::vector<world::Emitter>>;

/// Twenty islands, turned and overlapping, with emitters in sections of three levels.
struct MadeWorld {
  Emitters emitters;
  std::vector<PlacedIsland> islands;

  explicit MadeWorld(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto in = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    constexpr std::array<world::BlockId, 4> kIds{world::block::kLava, world::block::kTorch,
                                                 world::block::kLamp, world::block::kGlowFern};
    for (std::uint32_t i = 0; i < 20; ++i) {
      PlacedIsland island;
      island.id = 7 * i;
      island.index = (i * 13) % 20;
      const double yaw = in(0.0, 3.0);
      island.rotation = glm::mat3_cast(glm::angleAxis(yaw, glm::dvec3(0.0, 1.0, 0.0)));
      island.origin = {in(-400, 400), in(-100, 100), in(-400, 400)};
      island.radius = in(20, 120);
      islands.push_back(island);
      for (int s = 0; s < 4; ++s) {
        const world::SectionKey key{island.id,
                                    {static_cast<int>(in(-2, 2)), 0, static_cast<int>(in(-2, 2))},
                                    static_cast<int>(i % 3)};
        std::vector<world::Emitter>& list = emitters[key];
        for (int e = static_cast<int>(in(0, 20)); e > 0; --e)
          list.push_back({glm::vec3(in(0, 64), in(0, 64), in(0, 64)),
                          kIds[static_cast<std::size_t>(in(0, 3.99))],
                          static_cast<std::uint16_t>(in(1, 8)), in(0, 1) < 0.3});
      }
    }
  }
};

/// A light as it follows from the definitions, section by section.
struct Expected {
  glm::dvec3 position;
  glm::vec3 intensity;
  double range;
  std::set<std::uint32_t> islands;
};

std::vector<Expected> brute_force(const MadeWorld& world) {
  const std::vector<BlockEmission> table = emission_table();
  std::vector<Expected> out;
  for (const auto& [key, list] : world.emitters) {
    const auto island =
        std::find_if(world.islands.begin(), world.islands.end(),
                     [&, id = key.island](const PlacedIsland& i) { return i.id == id; });
    const double voxel = 1 << key.level;
    for (const world::Emitter& emitter : list) {
      Expected light;
      const glm::dvec3 in_chunk = glm::dvec3(emitter.place + table[emitter.block].offset) * voxel;
      const glm::dvec3 chunk(key.chunk.x, key.chunk.y, key.chunk.z);
      light.position = island->rotation * (chunk * 64.0 * voxel + in_chunk) + island->origin;
      light.intensity = table[emitter.block].face_intensity *
                        static_cast<float>(emitter.faces * voxel * voxel * (emitter.one_way + 1));
      light.range = light_range(light.intensity);
      for (const PlacedIsland& other : world.islands)
        if (glm::length(other.origin - light.position) <= other.radius + light.range)
          light.islands.insert(other.index);
      out.push_back(light);
    }
  }
  return out;
}

std::set<std::uint32_t> islands_of(const FrameLights& frame, const shared::Light& light) {
  const auto first = frame.islands.begin() + light.first_island;
  return {first, first + light.island_count};
}

void expect_light(const FrameLights& frame, const shared::Light& found, const Expected& light) {
  EXPECT_LT(glm::length(glm::dvec3(found.position) - light.position), 1e-3);
  EXPECT_LT(glm::length(found.intensity - light.intensity), 1e-5f * glm::length(light.intensity));
  EXPECT_FLOAT_EQ(found.range, static_cast<float>(light.range));
  EXPECT_EQ(islands_of(frame, found), light.islands);
}

LightField field_of(const Emitters& emitters) {
  LightField field;
  for (const auto& [key, list] : emitters) field.add(key, list);
  return field;
}

TEST(LightField, GathersWhatBruteForceFinds) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const MadeWorld world(seed);
    FrameLights frame;
    field_of(world.emitters).gather({}, std::nullopt, world.islands, std::nullopt, false, frame);
    const std::vector<Expected> expected = brute_force(world);
    ASSERT_EQ(frame.lights.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      expect_light(frame, frame.lights[i], expected[i]);
    EXPECT_LT(frame.islands.size(), 3 * frame.lights.size()) << "neighbours share their lists";
  }
}

TEST(LightField, UsesWhereLightsArriveOnlyWhileItHolds) {
  const world::SectionKey a{1, {0, 0, 0}, 0}, b{1, {1, 0, 0}, 0}, other{2, {0, 0, 0}, 0};
  const std::vector<world::Emitter> torch{{glm::vec3(32.0f), world::block::kTorch, 1, false}};
  LightField field = field_of({{a, torch}, {b, torch}, {other, torch}});
  const std::vector<PlacedIsland> islands{{1, 0, glm::dmat3(1.0), {}, 100.0},
                                          {2, 1, glm::dmat3(1.0), {1e4, 0.0, 0.0}, 100.0}};
  const auto reaches = [&] {
    FrameLights frame;
    field.gather({}, std::nullopt, islands, std::nullopt, false, frame);
    EXPECT_EQ(frame.lights.size(), 3u);
    return frame.reaches.size();
  };
  world::LampReach::Bricks somewhere;
  somewhere.size = {1, 1, 1};
  for (const world::SectionKey& key : {a, b, other}) field.set_reach(key, {somewhere});
  EXPECT_EQ(reaches(), 3u);
  field.invalidate_reach(1);
  EXPECT_EQ(reaches(), 1u) << "both sections of the island that changed";
  field.set_reach(a, {somewhere});
  EXPECT_EQ(reaches(), 2u) << "what was found before the change does not come back";
  field.set_reach(b, {somewhere});
  EXPECT_EQ(reaches(), 3u);
}

TEST(LightField, ListsTheNearestPanesInALightsRange) {
  const world::SectionKey here{1, {0, 0, 0}, 0}, coarse{1, {0, 0, 0}, 1}, beside{1, {1, 0, 0}, 0},
      other{2, {0, 0, 0}, 0};
  LightField field = field_of({{here, {{glm::vec3(32.0f), world::block::kTorch, 1, false}}}});
  std::mt19937 random(8);
  const auto in = [&](int low, int high) {
    return low + static_cast<int>(random() % static_cast<unsigned>(high - low));
  };
  std::vector<world::StainedBox> boxes;
  for (int i = 0; i < 60; ++i)
    boxes.push_back(
        {{in(0, 60), in(0, 60), in(0, 60)}, {in(1, 5), 1, in(1, 5)}, world::block::kRedGlass});
  field.add_glass(here, boxes);
  field.add_glass(beside, std::vector<world::StainedBox>{{{0, 32, 32}, {1, 1, 1}, 1}});
  field.add_glass(coarse, std::vector<world::StainedBox>{{{15, 15, 15}, {2, 2, 2}, 2}});
  field.add_glass(other, boxes);
  // Turned, and moved so that the lamp is where the camera is not.
  const glm::dmat3 turn =
      glm::mat3_cast(glm::angleAxis(1.1, glm::normalize(glm::dvec3(1.0, 2.0, 0.5))));
  const std::vector<PlacedIsland> islands{{1, 3, turn, {50.0, -20.0, 10.0}, 200.0},
                                          {2, 1, glm::dmat3(1.0), {1e4, 0.0, 0.0}, 100.0}};
  field.show(coarse, false);
  FrameLights frame;
  field.gather({}, std::nullopt, islands, std::nullopt, false, frame);
  ASSERT_EQ(frame.lights.size(), 1u);
  const shared::Light& torch = frame.lights.front();
  const glm::vec3 place(glm::transpose(turn) * (glm::dvec3(torch.position) - islands[0].origin));
  std::vector<float> distances;
  const auto distance_to = [&](glm::vec3 low, glm::vec3 high) {
    return glm::length(place - glm::clamp(place, low, high));
  };
  for (const world::StainedBox& box : boxes)
    distances.push_back(distance_to(box.low, box.low + box.size));
  distances.push_back(distance_to({64.0f, 32.0f, 32.0f}, {65.0f, 33.0f, 33.0f}));
  std::ranges::sort(distances);
  const auto in_range = static_cast<std::size_t>(std::ranges::lower_bound(distances, torch.range) -
                                                 distances.begin());
  ASSERT_EQ(torch.pane_count, std::min(in_range, kMostPanes));
  for (std::uint32_t i = 0; i < torch.pane_count; ++i) {
    const shared::LightPane& pane = frame.panes.at(torch.first_pane + i);
    EXPECT_EQ(pane.island, 3u);
    EXPECT_LE(distance_to(pane.low, pane.high), distances[torch.pane_count - 1] + 1e-4f);
  }
  field.remove(here);
  field.show(coarse, true);
  field.gather({}, std::nullopt, islands, torch, false, frame);
  ASSERT_EQ(frame.lights.size(), 1u) << "the one in the hand";
  EXPECT_EQ(frame.panes.at(frame.lights.front().first_pane).high, glm::vec3(34.0f))
      << "of two blocks a voxel";
}

TEST(LightField, LeavesOutOnlyWhatCannotReachTheView) {
  const MadeWorld world(9);
  const LightField field = field_of(world.emitters);
  const std::vector<Expected> all = brute_force(world);
  std::size_t left_out = 0;
  for (int turn = 0; turn < 24; ++turn) {
    const render::CameraView view =
        render::view_of({{}, turn * 15.0, turn * 5.0 - 60.0, 40.0}, 16, 9);
    FrameLights frame;
    field.gather({}, view, world.islands, std::nullopt, false, frame);
    left_out += all.size() - frame.lights.size();
    // In order, and with every light that shines on some point of the view. Points near the light
    // stand for what it shines on.
    auto at = frame.lights.begin();
    std::mt19937 random(static_cast<std::uint32_t>(turn));
    std::normal_distribution<double> normal;
    for (const Expected& light : all) {
      const bool gathered =
          at != frame.lights.end() && glm::length(glm::dvec3(at->position) - light.position) < 1e-3;
      if (gathered) {
        ++at;
        continue;
      }
      for (int i = 0; i < 50; ++i) {
        const glm::dvec3 way =
            glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const glm::dvec3 p = light.position + way * (light.range * std::cbrt(i / 50.0));
        const double ahead = glm::dot(p, glm::dvec3(view.forward));
        const bool seen = ahead > 0.0 &&
                          std::abs(glm::dot(p, glm::dvec3(view.right))) < ahead * view.tan_half_x &&
                          std::abs(glm::dot(p, glm::dvec3(view.up))) < ahead * view.tan_half_y;
        EXPECT_FALSE(seen);
      }
    }
    EXPECT_EQ(at, frame.lights.end());
  }
  EXPECT_GT(left_out, 8 * all.size()) << "most lights are not in a narrow view";
}

TEST(LightField, OrderDoesNotDependOnWhatCameAndWent) {
  const MadeWorld world(3);
  FrameLights expected;
  field_of(world.emitters).gather({}, std::nullopt, world.islands, std::nullopt, false, expected);
  std::vector<world::SectionKey> keys;
  for (const auto& [key, list] : world.emitters) keys.push_back(key);
  std::mt19937 random(5);
  std::shuffle(keys.begin(), keys.end(), random);
  LightField field;
  for (const world::SectionKey& key : keys) {
    field.add(key, world.emitters.at(key));
    field.remove(keys.front());
    field.add(keys.front(), world.emitters.at(keys.front()));
  }
  FrameLights frame;
  for (int again = 0; again < 2; ++again) {
    field.gather({}, std::nullopt, world.islands, std::nullopt, false, frame);
    EXPECT_EQ(frame.islands, expected.islands);
    ASSERT_EQ(frame.lights.size(), expected.lights.size());
    for (std::size_t i = 0; i < frame.lights.size(); ++i)
      EXPECT_EQ(frame.lights[i].position, expected.lights[i].position);
  }
}

TEST(LightField, NoEmittersNoLights) {
  LightField field;
  field.add({1, {0, 0, 0}, 0}, {});
  FrameLights frame;
  field.gather({}, std::nullopt, MadeWorld(1).islands, std::nullopt, false, frame);
  EXPECT_TRUE(frame.lights.empty());
  EXPECT_TRUE(frame.islands.empty());
}

TEST(LightField, WorldLightsStayWhereTheyAreAndDirectionalOnesAreBlockedByAll) {
  const MadeWorld world(2);
  LightField field;
  const world::WorldPos far{std::int64_t{1} << 55, 0, 0};
  WorldLight lamp, sun, lost;
  lamp.position = world::moved(far, {3.0, -2.0, 5.0});
  lamp.light.kind = shared::kLightSphere;
  lamp.light.range = 10.0f;
  sun.light.kind = shared::kLightDirectional;
  sun.light.range = 20.0f;
  lost.light.range = 1.0f;  // at the world's origin, far away
  field.set_world_lights({lamp, sun, lost});
  FrameLights frame;
  field.gather(far, std::nullopt, world.islands, std::nullopt, false, frame);
  ASSERT_EQ(frame.lights.size(), 2u);
  EXPECT_EQ(frame.lights[0].position, glm::vec3(3.0f, -2.0f, 5.0f));
  EXPECT_EQ(frame.lights[1].island_count, world.islands.size());
}

TEST(ScatterLights, StandOnWhatTheCameraSeesSoThatTensLightAPixel) {
  SceneOptions options;
  options.settings.lights_random = 2000;
  options.settings.view_distance = 300;
  world::World world({.seed = 1});
  const world::Spawn spawn = world.spawn();
  render::Camera camera;
  const world::WorldPos eye = world::moved(spawn.feet, {0.0, 1.6, 0.0});
  camera.position = {eye.x, eye.y, eye.z};
  camera.yaw_deg = spawn.yaw_deg;
  const ScatterView view{eye, render::view_of(camera, 16, 9), 300.0, 0.0};
  const auto lights = scatter_lights(world, view, 2000);
  EXPECT_EQ(scatter_lights(world, view, 2000).size(), lights.size());
  std::size_t count = 0;
  double covered = 0.0;  // of the picture, by the discs of what they reach
  for (const auto& [key, list] : lights) {
    const world::Pose pose = *world.pose(key.island, 0.0);
    for (const LatticeLight& light : list) {
      ++count;
      const glm::dvec3 place =
          glm::dvec3(key.chunk.x, key.chunk.y, key.chunk.z) * 64.0 + glm::dvec3(light.place);
      const glm::dvec3 seen = pose.rotation * place + world::difference_blocks(pose.origin, eye);
      const double ahead = glm::dot(seen, glm::dvec3(view.lens.forward));
      ASSERT_GT(ahead, 0.0);
      EXPECT_LT(std::abs(glm::dot(seen, glm::dvec3(view.lens.right))),
                1.5 * ahead * view.lens.tan_half_x + 1.0);
      const double radius = light.range / glm::length(seen);
      covered += 3.14159 * radius * radius / (4.0 * view.lens.tan_half_x * view.lens.tan_half_y);
      // Within three quarters of a block there is something to stand on.
      const world::IVec3 chunk = key.chunk;
      ASSERT_TRUE(world.ensure_chunk(key.island, chunk));
      bool stands = false;
      for (int axis = 0; axis < 3; ++axis) {
        for (const double step : {-0.76, 0.76}) {
          glm::dvec3 beside = place;
          beside[axis] += step;
          const world::IVec3 voxel{static_cast<int>(std::floor(beside.x)),
                                   static_cast<int>(std::floor(beside.y)),
                                   static_cast<int>(std::floor(beside.z))};
          world.ensure_chunk(key.island, world::chunk_of(voxel));
          stands = stands || world.block_at(key.island, voxel).value_or(world::kAir) != world::kAir;
        }
      }
      EXPECT_TRUE(stands);
    }
  }
  EXPECT_EQ(count, 2000u);
  EXPECT_GT(covered, 5.0);
  EXPECT_LT(covered, 60.0);
}

TEST(ScatterLights, AnEmptySkyHasNone) {
  world::World world({.seed = 1, .island_limit = 0});
  const ScatterView view{world.origin(), render::view_of({}, 16, 9), 300.0, 0.0};
  EXPECT_TRUE(scatter_lights(world, view, 100).empty());
}

}  // namespace
}  // namespace skerry::game
