// How much of the sky islands hide from each other, against rays through their voxels.
#include "engine/render/sky/island_shade.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "game/view/light_setup.h"
#include "tools/reference/tracer.h"
#include "world/islands/world.h"

namespace skerry::game {
namespace {

constexpr double kPi = std::numbers::pi;

render::FixedPos fixed_at(glm::dvec3 blocks) {
  return {std::llround(blocks.x * 65536.0), std::llround(blocks.y * 65536.0),
          std::llround(blocks.z * 65536.0)};
}

render::IslandShade shade_of_first(const std::vector<render::IslandPlacement>& islands) {
  return {islands, render::islands_that_hide(islands), 0, 1.0f};
}

render::IslandShade::Open open_towards(const render::IslandShade& shade, const glm::vec3& d) {
  return shade.towards(d).value_or(render::IslandShade::Open{});
}

glm::dvec3 axis_of(int face) {
  glm::dvec3 n(0.0);
  n[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
  return n;
}

/// Random directions before a face, as likely as their cosine.
glm::dvec3 by_cosine(int face, std::mt19937_64& random) {
  std::uniform_real_distribution<double> even(0.0, 1.0);
  const double r = even(random), turn = 2.0 * kPi * even(random);
  glm::dvec3 d = axis_of(face) * std::sqrt(1.0 - r);
  d[(face / 2 + 1) % 3] = std::sqrt(r) * std::cos(turn);
  d[(face / 2 + 2) % 3] = std::sqrt(r) * std::sin(turn);
  return d;
}

/// A generated island, and another one that stands beside or above it.
struct Pair {
  reference::Island here, there;
  std::vector<render::IslandPlacement> placed;

  Pair(world::World& world, const world::IslandSpec& a, const world::IslandSpec& b,
       glm::dvec3 between)
      : here{world::Volume::of_island(world, a), glm::dmat3(1.0), glm::dvec3(0.0)},
        there{world::Volume::of_island(world, b), glm::dmat3(1.0), between} {
    for (const auto& [spec, at] : {std::pair(&a, glm::dvec3(0.0)), std::pair(&b, between)})
      placed.push_back(
          {fixed_at(at), {1.0, 0.0, 0.0, 0.0}, spec->bounding_radius, false, 0, land_of(*spec)});
  }
  /// Share of what arrives at the side of the first that looks one way.
  double by_voxels(int face, double reach, std::mt19937_64& random) const {
    const reference::Tracer own({here}), other({there});
    std::uniform_real_distribution<double> even(-reach, reach);
    int open = 0, all = 0;
    reference::Trace trace;
    while (all < 4000) {
      glm::dvec3 from = axis_of(face) * (2.0 * reach);
      from[(face / 2 + 1) % 3] = even(random);
      from[(face / 2 + 2) % 3] = even(random);
      own.trace(from, -axis_of(face), trace);
      if (!trace.hit) continue;
      const glm::dvec3 place = from - axis_of(face) * (trace.hit->t - 1e-3);
      open += other.hidden(place, by_cosine(face, random)) ? 0 : 1;
      ++all;
    }
    return static_cast<double>(open) / all;
  }
  double by_shade(int face, std::mt19937_64& random) const {
    const render::IslandShade shade = shade_of_first(placed);
    double sum = 0.0;
    for (int i = 0; i < 4000; ++i)
      sum += static_cast<double>(open_towards(shade, glm::vec3(by_cosine(face, random)))
                                     .face[static_cast<std::size_t>(face)]);
    return sum / 4000.0;
  }
};

TEST(IslandShade, HidesAboutAsMuchAsTheVoxelsDo) {
  std::mt19937_64 random(7);
  double hidden = 0.0, found = 0.0;
  for (const std::uint64_t seed : {1, 4}) {
    world::World world({.seed = seed});
    const std::vector<world::IslandSpec> specs = world.islands_near(world.spawn().feet, 600.0, 0.0);
    ASSERT_GE(specs.size(), 2u);
    const world::IslandSpec &a = specs[0], &b = specs[1];
    const double apart = 0.8 * (a.bounding_radius + b.bounding_radius);
    for (const auto& [face, between] :
         {std::pair(0, glm::dvec3(apart, 0.0, 0.0)), std::pair(2, glm::dvec3(0.0, apart, 0.0)),
          std::pair(3, glm::dvec3(0.3 * apart, -apart, 0.0)),
          std::pair(5, glm::dvec3(0.0, 0.2 * apart, -1.2 * apart))}) {
      const Pair pair(world, a, b, between);
      const double right = 1.0 - pair.by_voxels(face, a.bounding_radius, random),
                   shade = 1.0 - pair.by_shade(face, random);
      EXPECT_GT(right, 0.01) << seed << ' ' << face;
      EXPECT_NEAR(shade, right, 0.02 + 0.4 * right) << seed << ' ' << face;
      hidden += right, found += shade;
    }
  }
  EXPECT_NEAR(found / hidden, 1.0, 0.2);
}

/// Two islands of one shape, the second at a place.
std::vector<render::IslandPlacement> two_at(glm::dvec3 between, glm::dquat turned = {1, 0, 0, 0}) {
  const render::IslandLand land{{0.0f, -10.0f, 0.0f}, {60.0f, 30.0f, 45.0f}};
  return {{{}, {1.0, 0.0, 0.0, 0.0}, 80.0, false, 0, land},
          {fixed_at(between), turned, 80.0, false, 0, land}};
}

std::vector<glm::vec3> all_around() {
  std::vector<glm::vec3> out;
  for (int i = 0; i < 500; ++i) {
    const double y = 1.0 - (2.0 * i + 1.0) / 500.0, turn = i * 2.399963;
    const double r = std::sqrt(1.0 - y * y);
    out.emplace_back(r * std::cos(turn), y, r * std::sin(turn));
  }
  return out;
}

// 6 blocks a second and a turn in two seconds, 60 frames a second: more than islands do.
TEST(IslandShade, ChangesBySmallStepsWhileIslandsPassAndTurn) {
  const std::vector<glm::vec3> directions = all_around();
  double before = -1.0, most = 0.0, least = 1.0;
  for (int frame = 0; frame < 4000; ++frame) {
    const auto islands = two_at({-200.0 + 0.1 * frame, 75.0, 10.0},
                                glm::angleAxis(frame * kPi / 60.0, glm::dvec3(0.0, 1.0, 0.0)));
    const render::IslandShade shade = shade_of_first(islands);
    double open = 0.0;
    for (const glm::vec3& d : directions)
      open += static_cast<double>(open_towards(shade, d).face[2]) / 500.0;
    if (before >= 0.0) most = std::max(most, std::abs(open - before));
    before = open;
    least = std::min(least, open);
  }
  EXPECT_LT(least, 0.9);  // it passed
  EXPECT_LT(most, 1.0 / 255.0);
}

// More islands than a word has bits.
TEST(IslandShade, SaysWhichOfACrowdMayHideADirection) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> at(-900.0, 900.0);
  std::vector<render::IslandPlacement> islands = two_at({300.0, 40.0, 0.0});
  while (islands.size() < 60) {
    islands.push_back(islands.front());
    islands.back().origin = fixed_at({at(random), at(random), at(random)});
  }
  const render::IslandShade shade = shade_of_first(islands);
  render::IslandShade::Directions directions;
  const std::vector<glm::vec3> all = all_around();
  constexpr std::size_t kCount = render::IslandShade::kDirections;
  for (std::size_t i = 0; i < kCount; ++i) directions.set(i, all[i * all.size() / kCount]);
  const render::IslandShade::Near near = shade.near(directions);
  int hidden = 0, passed = 0;
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto by_all = shade.towards(directions.at(i)),
               by_near = shade.towards(directions.at(i), near[i]);
    ASSERT_EQ(by_all.has_value(), by_near.has_value());
    hidden += by_all ? 1 : 0, passed += std::popcount(~near[i]);
    any |= near[i];
    if (!by_all) continue;
    EXPECT_EQ(by_all->face, by_near->face);
    EXPECT_EQ(by_all->all, by_near->all);
  }
  EXPECT_GT(hidden, 30);
  EXPECT_GT(passed, 256 * 8);
  EXPECT_EQ(any >> 31, 1u);
}

TEST(IslandShade, TurnsWithTheWorld) {
  const glm::dquat turn = glm::angleAxis(1.1, glm::normalize(glm::dvec3(0.3, 1.0, -0.4)));
  const glm::dvec3 between(90.0, 60.0, -20.0);
  auto islands = two_at(between);
  const render::IslandShade shade = shade_of_first(islands);
  for (render::IslandPlacement& island : islands) island.rotation = turn;
  islands[1].origin = fixed_at(turn * between);
  const render::IslandShade turned = shade_of_first(islands);
  double hidden = 0.0;
  for (const glm::vec3& d : all_around()) {
    const auto a = open_towards(shade, d),
               b = open_towards(turned, glm::vec3(turn * glm::dvec3(d)));
    for (std::size_t face = 0; face < 6; ++face) EXPECT_NEAR(a.face[face], b.face[face], 1e-3);
    hidden += 1.0 - static_cast<double>(a.all);
  }
  EXPECT_GT(hidden, 1.0);
}

TEST(IslandShade, FadesAsTheShadedIslandGetsSmall) {
  const auto islands = two_at({100.0, 50.0, 0.0});
  float before = 1.0f;
  for (double away = 0.0; away < 4000.0; away += 1.0) {
    const float share = render::share_of_shade(islands[0], fixed_at({0.0, away, 0.0}));
    EXPECT_LE(share, before);
    EXPECT_GT(share, before - 0.01f);
    if (away <= 500.0) {
      EXPECT_EQ(share, 1.0f);
    }
    before = share;
  }
  EXPECT_EQ(before, 0.0f);
  EXPECT_TRUE(render::IslandShade(islands, render::islands_that_hide(islands), 0, 0.0f).empty());
}

TEST(IslandShade, WhatIsFarOffOrWithoutLandHidesNothing) {
  EXPECT_TRUE(shade_of_first(two_at({3000.0, 0.0, 0.0})).empty());
  auto islands = two_at({100.0, 50.0, 0.0});
  EXPECT_FALSE(shade_of_first(islands).empty());
  islands[1].land = {};
  EXPECT_TRUE(shade_of_first(islands).empty());
  islands = two_at({100.0, 50.0, 0.0});
  islands[1].far = true;
  EXPECT_TRUE(shade_of_first(islands).empty());
}

}  // namespace
}  // namespace skerry::game
