// Which shadow maps are kept, and that a kept one shows what a fresh one would.
#include "engine/render/light/shadow_maps.h"

#include <algorithm>

#include "tests/render/passes_on_gpu.h"

namespace skerry::render {
namespace {

Celestial afternoon() {
  return celestial_at(15.0 * 3600.0, 0.0);
}

world::BlockId hills(int x, int y, int z) {
  const int height = (x * x / 31 + z * 3 / 7 + x * z / 53) & 15;
  return y < height ? world::block::kStone : world::block::kAirBlock;
}

class KeptShadowMaps : public PassesOnGpu {
 protected:
  FrameInput input_;
  std::vector<IslandPlacement> islands_;
  GeometryChanges geometry_;

  std::vector<ActiveCascade> update(const RenderSettings& settings = {}) {
    input_.islands = islands_;
    return update_shadows(input_, settings, geometry_);
  }
};

glm::dvec3 place_of(const IslandPlacement& island, const glm::dvec3& point) {
  return blocks_at(island.origin) + island.rotation * point;
}

/// Whether a place shows in a map. The camera is at the origin.
bool shows(const ActiveCascade& c, const glm::dvec3& place) {
  const glm::vec4 clip = c.cascade.clip_from_world * glm::vec4(glm::vec3(place), 1.0f);
  return std::abs(clip.x) < 1.0f && std::abs(clip.y) < 1.0f && clip.z > 0.0f;
}

shared::Section whole_chunk(std::uint32_t island, glm::ivec3 origin) {
  shared::Section section{};
  section.origin = origin;
  section.island = island;
  section.bounds_max = 64u | 64u << 7 | 64u << 14;
  return section;
}

/// A turn of `angle` about a random axis, laid over what was there.
glm::dquat turned(const glm::dquat& from, RandomPlaces& random, double angle) {
  return glm::normalize(glm::angleAxis(angle, random.direction()) * from);
}

TEST_F(KeptShadowMaps, AreDrawnAfreshWhenAnyPointOfAnIslandMovedByAQuarterTexel) {
  RandomPlaces random(1);
  input_.sky = afternoon();
  int kept = 0, redrawn = 0;
  for (int round = 0; round < 300; ++round) {
    invalidate_shadows();
    const double radius = random.uniform(10.0, 3000.0);
    islands_ = {{fixed_at(random.in_box(500.0)), random.turn(), radius}};
    const IslandPlacement before = islands_[0];
    for (const ActiveCascade& c : update()) EXPECT_TRUE(c.redraw);
    const double scale = std::exp(random.uniform(std::log(1e-4), std::log(1.0)));
    islands_[0].origin = sum(before.origin, fixed_at(random.in_box(scale)));
    const double angle = random.uniform(0.0, 2.0 * scale / radius);
    islands_[0].rotation = turned(before.rotation, random, angle);
    if (round % 2 == 0) islands_[0].rotation = -islands_[0].rotation;  // the same rotation
    const double bound =
        glm::length(blocks_at(islands_[0].origin) - blocks_at(before.origin)) + angle * radius;
    std::vector<glm::dvec3> points;  // of the island's ball
    for (int i = 0; i < 200; ++i)
      points.push_back(random.direction() * radius * random.uniform(0.8, 1.0));
    for (const ActiveCascade& c : update()) {
      // Brute force: how far did points move that show in the map, before or now?
      double most = 0.0;
      for (const glm::dvec3& p : points) {
        const glm::dvec3 was = place_of(before, p), is = place_of(islands_[0], p);
        if (shows(c, was) || shows(c, is)) most = std::max(most, glm::length(is - was));
      }
      const double quarter = 0.25 * static_cast<double>(c.cascade.texel_blocks);
      if (most > quarter) {
        EXPECT_TRUE(c.redraw) << "a point moved " << most << " blocks, texel " << 4.0 * quarter;
      }
      if (bound < 0.99 * quarter) {
        EXPECT_FALSE(c.redraw) << "no point can have moved " << bound << " blocks";
      }
      (c.redraw ? redrawn : kept) += 1;
    }
  }
  EXPECT_GT(kept, 200);
  EXPECT_GT(redrawn, 200);
}

TEST_F(KeptShadowMaps, SmallMovesAddUpUntilTheMapIsDrawnAfresh) {
  input_.sky = afternoon();
  islands_ = {{{}, {1.0, 0.0, 0.0, 0.0}, 100.0}};
  std::vector<std::int64_t> drawn_at;
  for (const ActiveCascade& c : update()) {
    ASSERT_TRUE(c.redraw);
    drawn_at.push_back(0);
  }
  for (std::int64_t units = 100; units < 100000; units += 100) {
    islands_[0].origin[0] = units;
    for (const ActiveCascade& c : update()) {
      const auto layer = static_cast<std::size_t>(c.layer);
      if (c.redraw) drawn_at[layer] = units;
      const double moved = static_cast<double>(units - drawn_at[layer]) / 65536.0;
      ASSERT_LE(moved, 0.25 * static_cast<double>(c.cascade.texel_blocks));
    }
  }
}

TEST_F(KeptShadowMaps, AreKeptWhenTheWholeWorldMovesAndNotWhenItsGeometryChanges) {
  input_.sky = afternoon();
  islands_ = {{fixed_at({3, 4, 5}), {1.0, 0.0, 0.0, 0.0}, 100.0}};
  update();
  const FixedPos offset{kUnits << 40, -(kUnits << 40), kUnits << 24};
  islands_[0].origin = sum(islands_[0].origin, offset);
  input_.camera.position = sum(input_.camera.position, offset);
  input_.anchor = sum(input_.anchor, offset);
  for (const ActiveCascade& c : update()) EXPECT_FALSE(c.redraw);
  geometry_.note(whole_chunk(0, {0, 0, 0}));
  for (const ActiveCascade& c : update()) EXPECT_TRUE(c.redraw);
  islands_.push_back(islands_[0]);
  for (const ActiveCascade& c : update()) EXPECT_FALSE(c.redraw) << "an island of no sections";
  geometry_.note(whole_chunk(1, {0, 0, 0}));
  for (const ActiveCascade& c : update()) EXPECT_TRUE(c.redraw) << "its first section came";
  islands_.pop_back();
  for (const ActiveCascade& c : update()) EXPECT_TRUE(c.redraw) << "an island is missing";
}

TEST_F(KeptShadowMaps, AreDrawnAfreshWhenASectionThatTheyCouldShowComesOrGoes) {
  RandomPlaces random(7);
  input_.sky = afternoon();
  int kept = 0, redrawn = 0;
  for (int round = 0; round < 300; ++round) {
    islands_ = {{fixed_at(random.in_box(800.0)), random.turn(), 3000.0}};
    update();
    const shared::Section section = whole_chunk(0, glm::ivec3(random.in_box(1200.0)));
    geometry_.note(section);
    for (const ActiveCascade& c : update()) {
      // Brute force: does any of many points of the chunk fall into the map?
      bool inside = false;
      for (int i = 0; i < 1000 && !inside; ++i) {
        const glm::dvec3 at = glm::dvec3(section.origin) + 32.0 + random.in_box(32.0);
        const glm::dvec3 p = blocks_at(islands_[0].origin) + islands_[0].rotation * at -
                             blocks_at(input_.camera.position);
        const glm::vec4 clip = c.cascade.clip_from_world * glm::vec4(glm::vec3(p), 1.0f);
        inside = std::abs(clip.x) < 1.0f && std::abs(clip.y) < 1.0f && clip.z > 0.0f;
      }
      if (inside) {
        EXPECT_TRUE(c.redraw) << "round " << round << ", map " << c.layer;
      }
      (c.redraw ? redrawn : kept) += 1;
    }
  }
  EXPECT_GT(kept, 200);
  EXPECT_GT(redrawn, 50);
}

TEST_F(KeptShadowMaps, AreDrawnAfreshWhenMoreChangedThanIsKnown) {
  input_.sky = afternoon();
  islands_ = {{{}, {1.0, 0.0, 0.0, 0.0}, 100.0}};
  update();
  for (int i = 0; i < 10000; ++i) geometry_.note(whole_chunk(0, {1 << 20, 0, 0}));
  for (const ActiveCascade& c : update()) EXPECT_TRUE(c.redraw);
  geometry_.note(whole_chunk(0, {1 << 20, 0, 0}));
  for (const ActiveCascade& c : update()) EXPECT_FALSE(c.redraw) << "it is far from any map";
}

TEST_F(KeptShadowMaps, AreDrawnAfreshWhenTheSunMoves) {
  islands_ = {{{}, {1.0, 0.0, 0.0, 0.0}, 100.0}};
  input_.sky = celestial_at(50000.0, 0.0);
  update();
  for (const ActiveCascade& c : update()) EXPECT_FALSE(c.redraw);
  input_.sky = celestial_at(50120.0, 0.0);
  for (const ActiveCascade& c : update()) EXPECT_TRUE(c.redraw);
}

// Coarse maps are kept longer than fine ones, and what is a little late never adds up.
TEST_F(KeptShadowMaps, ShowTheShadowsOfASunThatMovesWithinAQuarterTexelOrTenSeconds) {
  islands_ = {{{}, {1.0, 0.0, 0.0, 0.0}, 100.0}};
  input_.sky = celestial_at(50000.0, 0.0);
  update();
  std::array<int, 4> redrawn{};
  for (int i = 1; i <= 480; ++i) {
    input_.sky = celestial_at(50000.0 + 1.0 * i, 0.0);
    const std::vector<ActiveCascade> kept = update();
    ASSERT_EQ(kept.size(), 4u);
    for (std::size_t c = 0; c < kept.size(); ++c) {
      redrawn[c] += kept[c].redraw ? 1 : 0;
      // Where the tip of a pole throws its shadow, along the sun's way and along the map's.
      const glm::dvec3 tip = kShadowBlocks * input_.sky.to_sun;
      const glm::vec4 at = kept[c].cascade.clip_from_world * glm::vec4(glm::vec3(tip), 1.0f),
                      foot = kept[c].cascade.clip_from_world * glm::vec4(0, 0, 0, 1);
      const double texels = 0.5 * kept[c].cascade.key.map_size *
                            static_cast<double>(glm::length(glm::vec2(at - foot)));
      const double blocks = texels * static_cast<double>(kept[c].cascade.texel_blocks);
      EXPECT_TRUE(texels <= 0.2501 + 1e-3 || blocks <= 1.01 * kShadowStepBlocks)
          << "map " << c << ", step " << i;
      if (kept[c].redraw) {
        EXPECT_LT(texels, 1e-2) << "drawn by the sun as it stands";
      }
    }
  }
  // 10 s of the day, or what of them the sun's way across its light takes; and longer.
  EXPECT_GE(redrawn[0], 480 / 11);
  EXPECT_LE(redrawn[0], 480 / 10);
  EXPECT_LT(redrawn[3], 35);
  EXPECT_GT(redrawn[3], 10);
  input_.parts = 4;  // of a still, whose suns stand all over the disc
  input_.sky = celestial_at(50000.0 + 480.0 + 2.0, 0.0);
  for (const ActiveCascade& c : update()) EXPECT_TRUE(c.redraw);
}

// Else each redrawn map would have its texels elsewhere, and the edges of all shadows flicker.
TEST_F(KeptShadowMaps, KeepTheirTexelsInPlaceNearTheCameraAsTheSunMoves) {
  islands_ = {{{}, {1.0, 0.0, 0.0, 0.0}, 100.0}};
  input_.camera.position = fixed_at({3000.3, 80.0, -2000.7});  // from the anchor
  input_.sky = celestial_at(33000.0, 0.0);
  const auto texel_at_camera = [](const ActiveCascade& c) {
    const glm::dvec4 at = c.cascade.clip_from_world * glm::vec4(0, 0, 0, 1);
    return 0.5 * c.cascade.key.map_size * (glm::dvec2(at) + 1.0);
  };
  std::vector<ActiveCascade> before = update();
  int redrawn = 0;
  for (int i = 1; i <= 400; ++i) {
    input_.sky = celestial_at(33000.0 + 1.0 * i, 0.0);
    const std::vector<ActiveCascade> now = update();
    for (std::size_t c = 0; c < now.size(); ++c) {
      redrawn += now[c].redraw ? 1 : 0;
      // The light turns by no more than kShadowStepBlocks / kShadowBlocks or a quarter texel there,
      // about a pivot that is half a snap step away at most.
      const Cascade& map = now[c].cascade;
      const double texel = map.texel_blocks;
      const double turn = std::max(kShadowStepBlocks, 0.25 * texel) / kShadowBlocks;
      const double most = 1.1 * turn * std::sqrt(0.75) * map.key.map_size / 16;
      const glm::dvec2 moved = texel_at_camera(now[c]) - texel_at_camera(before[c]);
      EXPECT_LE(glm::length(moved - glm::round(moved)), most + 2e-3) << "map " << c;
    }
    before = now;
  }
  EXPECT_GT(redrawn, 60);
}

// A shot's bytes are those of a program that has drawn nothing before.
TEST_F(KeptShadowMaps, ShowNothingOfWhereTheSunStoodBeforeItsClockWasSet) {
  islands_ = {{{}, {1.0, 0.0, 0.0, 0.0}, 100.0}};
  input_.camera.position = fixed_at({3000.3, 80.0, -2000.7});
  input_.sky = afternoon();
  const std::vector<ActiveCascade> fresh = update();
  for (const double jump_s : {600.0, -3600.0}) {
    input_.sky = celestial_at(15.0 * 3600.0 + jump_s, 0.0);
    update();
    input_.sky = afternoon();
    const std::vector<ActiveCascade> again = update();
    for (std::size_t c = 0; c < again.size(); ++c)
      EXPECT_TRUE(again[c].cascade.key == fresh[c].cascade.key) << "map " << c;
  }
}

TEST_F(KeptShadowMaps, ACameraThatMovesLessThanATexelChangesNoTexel) {
  add_chunk(store(), uploader(), hills, {0, 0, 0}, 0);
  islands_ = {{fixed_at({-31.7, -20.2, -30.4}), glm::angleAxis(0.4, glm::dvec3(0, 1, 0)), 120.0}};
  input_.islands = islands_;
  input_.sky = afternoon();
  RenderSettings settings;
  settings.shadow_size = 512;
  const DrawnMaps first = shadow_maps(input_, settings);
  EXPECT_EQ(first.redrawn, std::vector<bool>(4, true));
  // The scene is in the maps at all.
  const auto covered =
      std::count_if(first.texels.begin(), first.texels.end(), [](float t) { return t > 0.0f; });
  EXPECT_GT(covered, 1000);
  RandomPlaces random(2);
  for (int i = 0; i < 12; ++i) {
    // Well below the first cascade's texel of a quarter of a block.
    input_.camera.position = fixed_at(random.in_box(0.05));
    const DrawnMaps kept = shadow_maps(input_, settings);
    EXPECT_EQ(kept.texels, first.texels);
    invalidate_shadows();
    const DrawnMaps fresh = shadow_maps(input_, settings);
    EXPECT_EQ(fresh.redrawn, std::vector<bool>(4, true));
    EXPECT_EQ(fresh.texels, first.texels) << "drawn again in the same window, step " << i;
  }
}

TEST_F(KeptShadowMaps, DrawnInPartShowWhatFreshOnesDo) {
  RandomPlaces random(11);
  const auto add = [&](world::IVec3 chunk, std::size_t island) {
    tools::stability::MeshedChunk meshed = tools::stability::mesh_chunk_of(hills, chunk, 0);
    meshed.section.island = static_cast<std::uint32_t>(island);
    return *store().add(uploader(), meshed.section, meshed.quads);
  };
  const auto place = [&](int most) { return static_cast<std::int32_t>(random.whole(-most, most)); };
  std::vector<SectionId> sections;
  for (int i = 0; i < 6; ++i) sections.push_back(add({i % 3 - 1, 0, i / 3}, 0));
  sections.push_back(add({0, 0, 0}, 1));
  islands_ = {{fixed_at({-31.7, -20.2, -30.4}), glm::angleAxis(0.4, glm::dvec3(0, 1, 0)), 300.0},
              {fixed_at({5.0, 30.0, 9.0}), random.turn(), 100.0}};
  input_.sky = afternoon();
  input_.reach_blocks = 400.0;
  RenderSettings settings;
  settings.shadow_size = 512;
  const auto maps = [&] {
    input_.islands = islands_;
    return shadow_maps(input_, settings);
  };
  maps();
  int parts = 0;
  for (int round = 0; round < 24; ++round) {
    const auto which = static_cast<std::size_t>(random.whole(0, 5));
    if (round % 3 == 0) {
      store().remove(uploader(), sections[which]);
      sections[which] = add({place(2), 0, place(2)}, 0);
    } else if (round % 3 == 1) {
      islands_[1].origin = fixed_at(random.in_box(60.0));
      islands_[1].rotation = random.turn();
    } else {
      islands_.push_back({fixed_at(random.in_box(80.0)), random.turn(), 100.0});
      add({0, 0, 0}, islands_.size() - 1);
    }
    const DrawnMaps kept = maps();
    for (std::size_t i = 0; i < kept.areas.size(); ++i)
      parts += kept.redrawn[i] && kept.areas[i].extent.width < 512;
    invalidate_shadows();
    EXPECT_EQ(kept.texels, maps().texels) << "round " << round;
  }
  EXPECT_GT(parts, 10);
}

TEST_F(KeptShadowMaps, AreTheSameToTheLastBitAnywhereInTheWorld) {
  add_chunk(store(), uploader(), hills, {0, 0, 0}, 0);
  const IslandPlacement island{fixed_at({-31.7, -20.2, -30.4}),
                               glm::angleAxis(0.4, glm::dvec3(0, 1, 0)), 120.0};
  input_.sky = afternoon();
  RenderSettings settings;
  settings.shadow_size = 256;
  std::vector<float> first;
  for (const int bits : {0, 24, 40}) {
    const FixedPos offset{bits ? kUnits << bits : 0, bits ? -(kUnits << bits) + 7 : 0, 0};
    islands_ = {island};
    islands_[0].origin = sum(island.origin, offset);
    input_.islands = islands_;
    input_.camera.position = offset;
    input_.anchor = offset;
    invalidate_shadows();
    const DrawnMaps maps = shadow_maps(input_, settings);
    if (bits == 0) first = maps.texels;
    EXPECT_EQ(maps.texels, first) << bits;
  }
}

}  // namespace
}  // namespace skerry::render
