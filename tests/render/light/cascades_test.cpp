#include "engine/render/light/cascades.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>
#include <vector>

#include "engine/render/frame/celestial.h"
#include "tests/same_bits.h"

namespace skerry::render {
namespace {

constexpr double kUnits = 65536.0;

class Random {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  std::int64_t whole(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(engine_);
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      const double squared = glm::dot(v, v);
      if (squared > 1e-3 && squared < 1.0) return v / std::sqrt(squared);
    }
  }
  FixedPos place(int bits) {
    const std::int64_t limit = std::int64_t{1} << bits;
    return {whole(-limit, limit), whole(-limit, limit), whole(-limit, limit)};
  }

 private:
  std::mt19937_64 engine_{20261120};
};

glm::dvec3 clip(const glm::mat4& m, glm::dvec3 p) {
  return glm::dvec3(glm::dmat4(m) * glm::dvec4(p, 1.0));
}

glm::dvec2 texel_of(const Cascade& c, glm::dvec3 p) {
  const glm::dvec3 q = clip(c.clip_from_world, p);
  return (glm::dvec2(q.x, q.y) * 0.5 + 0.5) * static_cast<double>(c.key.map_size);
}

std::vector<glm::dvec3> special_directions() {
  std::vector<glm::dvec3> all;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x || y || z) all.push_back(glm::normalize(glm::dvec3(x, y, z)));
      }
    }
  }
  all.push_back(kCelestialPole);
  all.push_back(-kCelestialPole);
  for (double hour = 0; hour < 24; hour += 1) all.push_back(celestial_at(hour * 3600, 0).to_sun);
  return all;
}

TEST(CascadeRadii, AreThePracticalSplitAndEndAtTheViewDistance) {
  const auto radii = cascade_radii(1.0, 1000.0, 4, 0.75);
  // Half way: 0.75 * sqrt(1 * 1000) + 0.25 * (1 + 999 / 2).
  EXPECT_NEAR(radii[1], 0.75 * std::sqrt(1000.0) + 0.25 * 500.5, 1e-9);
  EXPECT_EQ(radii[3], 1000.0);
  for (std::size_t i = 1; i < radii.size(); ++i) EXPECT_GT(radii[i], radii[i - 1]);
}

TEST(CascadeRadii, OfEveryCountEndAtTheViewDistance) {
  for (int count = 1; count <= kCascadeCount; ++count) {
    CascadeInput in;
    in.count = count;
    const std::vector<Cascade> cascades = make_cascades(in);
    ASSERT_EQ(cascades.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(cascades.back().radius, static_cast<float>(in.far_blocks));
  }
  EXPECT_LT(cascade_radii(1.0, 1000.0, 4, 0.75)[0], cascade_radii(1.0, 1000.0, 2, 0.75)[0]);
}

TEST(LightAxes, AreOrthonormalAndRightHandedForEveryDirection) {
  Random random;
  std::vector<glm::dvec3> directions = special_directions();
  for (int i = 0; i < 1000; ++i) directions.push_back(random.direction());
  for (const glm::dvec3& d : directions) {
    const auto [right, up, back] = light_axes(d * 3.7);
    EXPECT_NEAR(glm::length(right), 1.0, 1e-14);
    EXPECT_NEAR(glm::length(up), 1.0, 1e-14);
    EXPECT_NEAR(glm::dot(right, up), 0.0, 1e-14);
    EXPECT_LE(glm::length(back - d), 1e-14);
    EXPECT_LE(glm::length(glm::cross(right, up) - back), 1e-14);
  }
}

TEST(LightAxes, TurnNoFasterThanTheSunAllDay) {
  auto last = light_axes(celestial_at(0.0, 0.0).to_sun);
  const double step = 2 * M_PI / 8640.0;
  for (int i = 1; i <= 8640; ++i) {
    const auto axes = light_axes(celestial_at(i * 10.0, 0.0).to_sun);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(glm::length(axes[k] - last[k]), 1.01 * step) << i;
    last = axes;
  }
}

TEST(LightAxes, AreContinuousAcrossZenithHorizonAndAxes) {
  Random random;
  for (const glm::dvec3& d : special_directions()) {
    if (std::abs(glm::dot(d, kCelestialPole)) > 0.9999) continue;  // the singular place
    const auto axes = light_axes(d);
    for (int i = 0; i < 20; ++i) {
      const auto near = light_axes(d + 1e-7 * random.direction());
      for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(glm::length(axes[k] - near[k]), 1e-5);
    }
  }
}

CascadeInput random_input(Random& random, int position_bits) {
  CascadeInput in;
  in.to_light = random.direction();
  in.camera = random.place(position_bits);
  in.anchor = random.place(20);
  in.far_blocks = random.uniform(60, 4000);
  in.caster_reach_blocks = 2 * in.far_blocks + 512;
  in.map_size = static_cast<int>(random.whole(64, 4096));
  return in;
}

TEST(Cascades, CoverEveryPointWithinTheirRadiusWithRoomForTheFilter) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    const CascadeInput in = random_input(random, 56);
    for (const Cascade& c : make_cascades(in)) {
      for (int i = 0; i < 50; ++i) {
        const double r = c.radius * (i < 25 ? 1.0 : random.uniform(0, 1));
        const glm::dvec3 p = clip(c.clip_from_world, random.direction() * r);
        const double margin = 2.0 * (in.filter_blocks / c.texel_blocks + 7.9) / in.map_size;
        EXPECT_LT(std::abs(p.x), 1.0 - margin);
        EXPECT_LT(std::abs(p.y), 1.0 - margin);
        EXPECT_GT(p.z, 0.0);
        EXPECT_LT(p.z, 1.0 - 0.999 * in.caster_reach_blocks / c.depth_blocks);
      }
    }
  }
}

TEST(Cascades, OneAloneIsTheOneAmongAll) {
  Random random;
  for (int round = 0; round < 50; ++round) {
    const CascadeInput in = random_input(random, 56);
    const std::vector<Cascade> all = make_cascades(in);
    for (int i = 0; i < in.count; ++i) {
      const Cascade alone = make_cascade(in, i);
      EXPECT_EQ(alone.key, all[static_cast<std::size_t>(i)].key);
      EXPECT_EQ(alone.clip_from_world, all[static_cast<std::size_t>(i)].clip_from_world);
      EXPECT_EQ(alone.radius, all[static_cast<std::size_t>(i)].radius);
    }
  }
}

TEST(Cascades, DepthGrowsTowardsTheLightAndClipIsRightDown) {
  Random random;
  for (int round = 0; round < 100; ++round) {
    const CascadeInput in = random_input(random, 40);
    const auto [right, up, back] = light_axes(in.to_light);
    for (const Cascade& c : make_cascades(in)) {
      const glm::dvec3 origin = clip(c.clip_from_world, {0, 0, 0});
      EXPECT_NEAR((clip(c.clip_from_world, back) - origin).z, 1.0 / c.depth_blocks, 1e-6);
      const double width = 2.0 / in.map_size / c.texel_blocks;
      EXPECT_NEAR((clip(c.clip_from_world, right) - origin).x, width, 1e-6);
      EXPECT_NEAR((clip(c.clip_from_world, up) - origin).y, -width, 1e-6);
    }
  }
}

TEST(Cascades, MovingTheCameraMovesTheTexelGridByWholeTexels) {
  Random random;
  int kept = 0, moved = 0;
  for (int round = 0; round < 2000; ++round) {
    CascadeInput in = random_input(random, 56);
    const auto before = make_cascades(in);
    const double texel = before[0].texel_blocks;
    const glm::dvec3 by = random.direction() * texel * random.uniform(0, round % 2 ? 0.99 : 200.0);
    FixedPos delta;
    for (int i = 0; i < 3; ++i) delta[static_cast<std::size_t>(i)] = std::llround(by[i] * kUnits);
    for (std::size_t i = 0; i < 3; ++i) in.camera[i] += delta[i];
    const auto after = make_cascades(in);
    const glm::dvec3 exact =
        glm::dvec3(static_cast<double>(delta[0]), static_cast<double>(delta[1]),
                   static_cast<double>(delta[2])) /
        kUnits;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const glm::dvec3 p = random.direction() * static_cast<double>(before[k].radius) * 0.5;
      const glm::dvec2 shift = texel_of(after[k], p - exact) - texel_of(before[k], p);
      const glm::dvec2 whole = glm::round(shift);
      // Single-precision matrices over a map of up to 4096 texels.
      EXPECT_LT(glm::length(shift - whole), 2e-3);
      if (before[k].key == after[k].key) {
        EXPECT_EQ(whole, glm::dvec2(0.0));
        EXPECT_TRUE(same_bits(before[k].clip_from_centre, after[k].clip_from_centre));
        EXPECT_EQ(before[k].centre, after[k].centre);
        ++kept;
      } else {
        ++moved;
      }
    }
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(moved, 100);
}

// A place at a distance from the pivot moves across a grid that turns about it by the angle times
// the distance at most. About the anchor, 2^40 blocks away, it would be anywhere in a texel.
TEST(Cascades, ATurnOfTheLightMovesTexelsByTheDistanceToThePivot) {
  Random random;
  for (int round = 0; round < 500; ++round) {
    CascadeInput in = random_input(random, 56);
    const double angle = random.uniform(1e-6, 1e-4);
    const glm::dvec3 before = glm::normalize(in.to_light);
    const glm::dvec3 after =
        glm::normalize(before + angle * glm::normalize(glm::cross(before, random.direction())));
    for (std::size_t i = 0; i < 3; ++i) in.pivot[i] = in.camera[i] - in.anchor[i];
    const auto shown = make_cascades(in);
    const double roll =
        glm::length(light_axes(after)[0] - light_axes(before)[0]) + 2.0 * angle;  // of the axes
    in.to_light = after;
    const auto turned = make_cascades(in);
    for (std::size_t k = 0; k < shown.size(); ++k) {
      const double distance = 0.2 * static_cast<double>(shown[k].radius);
      const glm::dvec3 p = random.direction() * distance;
      const glm::dvec2 shift = texel_of(turned[k], p) - texel_of(shown[k], p);
      const double texels = roll * distance / static_cast<double>(shown[k].texel_blocks);
      EXPECT_LE(glm::length(shift - glm::round(shift)), 1.5 * texels + 2e-3);
    }
  }
}

TEST(Cascades, AreKeptForASixteenthOfTheMapsWidth) {
  CascadeInput in;
  in.to_light = celestial_at(9 * 3600.0, 0.0).to_sun;
  std::array<int, kCascadeCount> changes{};
  auto last = make_cascades(in);
  const int blocks = 500;
  for (int i = 0; i < blocks * 4; ++i) {
    in.camera[0] += 65536 / 4;
    const auto now = make_cascades(in);
    for (std::size_t k = 0; k < now.size(); ++k) changes[k] += !(now[k].key == last[k].key);
    last = now;
  }
  for (std::size_t k = 0; k < last.size(); ++k) {
    const double step = static_cast<double>(last[k].texel_blocks) * in.map_size / 16;
    // Three snapped axes, of which the walk crosses each at most at full speed.
    EXPECT_LE(changes[k], 3 * (blocks / step + 1)) << k;
    EXPECT_GE(changes[k], std::floor(blocks / step / 2)) << k;
  }
}

TEST(Cascades, BothMatricesShowTheSamePlace) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    const CascadeInput in = random_input(random, 56);
    for (const Cascade& c : make_cascades(in)) {
      glm::dvec3 camera_from_centre;
      for (std::size_t i = 0; i < 3; ++i) {
        camera_from_centre[static_cast<int>(i)] =
            static_cast<double>(in.camera[i] - c.centre[i]) / kUnits;
      }
      EXPECT_LT(glm::length(camera_from_centre), c.radius);
      const glm::dvec3 p = random.direction() * static_cast<double>(c.radius);
      const glm::dvec3 a = clip(c.clip_from_world, p),
                       b = clip(c.clip_from_centre, p + camera_from_centre);
      EXPECT_LT(glm::length(a - b), 1e-6);
    }
  }
}

TEST(Cascades, MovingWorldAndCameraTogetherChangesNoBit) {
  Random random;
  for (int round = 0; round < 500; ++round) {
    CascadeInput in = random_input(random, 30);
    const auto here = make_cascades(in);
    const std::int64_t far =
        (std::int64_t{1} << 56) - (round % 2 ? random.whole(0, 1 << 20) * 65536 : 0);
    const FixedPos offset{far, -far, round % 3 ? far : 0};
    for (std::size_t i = 0; i < 3; ++i) {
      in.camera[i] += offset[i];
      in.anchor[i] += offset[i];
    }
    const auto there = make_cascades(in);
    for (std::size_t k = 0; k < here.size(); ++k) {
      EXPECT_TRUE(same_bits(here[k].clip_from_world, there[k].clip_from_world));
      EXPECT_TRUE(same_bits(here[k].clip_from_centre, there[k].clip_from_centre));
      EXPECT_TRUE(same_bits(here[k].planes, there[k].planes));
      EXPECT_TRUE(here[k].key == there[k].key);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(there[k].centre[i] - here[k].centre[i], offset[i]);
    }
  }
}

TEST(Cascades, AreFiniteForEveryDirection) {
  for (const glm::dvec3& d : special_directions()) {
    CascadeInput in;
    in.to_light = d;
    in.camera = {std::int64_t{1} << 56, -(std::int64_t{1} << 56), 12345};
    for (const Cascade& c : make_cascades(in)) {
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) EXPECT_TRUE(std::isfinite(c.clip_from_world[i][j]));
      }
      EXPECT_GT(std::abs(glm::determinant(glm::dmat4(c.clip_from_world))), 0.0);
    }
  }
}

TEST(Cascades, PlanesKeepExactlyWhatTheMapCanShow) {
  Random random;
  int inside = 0, outside = 0;
  for (int round = 0; round < 200; ++round) {
    const CascadeInput in = random_input(random, 56);
    for (const Cascade& c : make_cascades(in)) {
      for (int i = 0; i < 40; ++i) {
        const glm::dvec3 p =
            random.direction() * (static_cast<double>(c.radius) * random.uniform(0.2, 4.0));
        const glm::dvec3 q = clip(c.clip_from_world, p);
        const double worst = std::max({std::abs(q.x) - 1.0, std::abs(q.y) - 1.0, q.z - 1.0, -q.z});
        double least = 1e300;
        for (const glm::vec4& plane : c.planes) {
          EXPECT_NEAR(glm::length(glm::dvec3(plane)), 1.0, 1e-6);
          least = std::min(least, glm::dot(glm::dvec3(plane), p) + static_cast<double>(plane.w));
        }
        if (worst < -1e-5) {
          EXPECT_GT(least, 0.0);
          ++inside;
        } else if (worst > 1e-5) {
          EXPECT_LT(least, 0.0);
          ++outside;
        }
      }
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

}  // namespace
}  // namespace skerry::render
