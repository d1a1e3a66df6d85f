#include "engine/render/sky/sky_irradiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <random>

#include "engine/render/frame/celestial.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/indirect.h"

namespace skerry::render {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Irradiance of all lobes of a face.
glm::dvec3 whole(const std::vector<glm::uvec4>& sky, std::size_t island, std::size_t face) {
  glm::dvec3 sum(0.0);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const glm::uvec4 words = sky[(island * 6 + face) * shared::kIndirectSkyTexels + channel];
    for (int i = 0; i < 4; ++i) {
      const glm::vec2 pair = glm::unpackHalf2x16(words[i]);
      sum[static_cast<int>(channel)] += static_cast<double>(pair.x) + static_cast<double>(pair.y);
    }
  }
  return sum;
}

glm::dvec3 face_normal(std::size_t face) {
  glm::dvec3 n(0.0);
  n[static_cast<int>(face / 2)] = face % 2 == 0 ? 1.0 : -1.0;
  return n;
}

/// By directions drawn evenly over the sphere.
glm::dvec3 by_samples(const shared::SkyConstants& sky, glm::dvec3 normal) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  glm::dvec3 sum(0.0);
  constexpr int kSamples = 200000;
  for (int i = 0; i < kSamples; ++i) {
    const double y = 1.0 - 2.0 * even(random), turn = 2.0 * kPi * even(random);
    const double r = std::sqrt(1.0 - y * y);
    const glm::dvec3 d{r * std::cos(turn), y, r * std::sin(turn)};
    sum += sky_radiance(d, sky) * std::max(0.0, glm::dot(d, normal));
  }
  return sum * (4.0 * kPi / kSamples);
}

TEST(SkyIrradiance, IsTheCosineWeightedSkyOfEachFace) {
  for (const double hour : {12.0, 8.0, 18.2, 0.0}) {
    const shared::SkyConstants sky = sky_constants(celestial_at(hour * 3600.0, 0.5));
    const std::vector<IslandPlacement> islands(1);
    const std::vector<glm::uvec4> lobes =
        sky_irradiance(sky, islands, std::vector<bool>(islands.size(), true));
    ASSERT_EQ(lobes.size(), 18u);
    for (std::size_t face = 0; face < 6; ++face) {
      const glm::dvec3 found = whole(lobes, 0, face), right = by_samples(sky, face_normal(face));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], right[c], 0.04 * right[c] + 1e-6) << hour << "h face " << face;
    }
  }
}

TEST(SkyIrradiance, TurnsWithTheIsland) {
  const shared::SkyConstants sky = sky_constants(celestial_at(8.0 * 3600.0, 0.5));
  std::vector<IslandPlacement> islands(2);
  islands[1].rotation =
      glm::dquat(std::cos(0.4), glm::dvec3(0.3, 0.9, -0.2) / std::sqrt(0.94) * std::sin(0.4));
  const std::vector<glm::uvec4> lobes =
      sky_irradiance(sky, islands, std::vector<bool>(islands.size(), true));
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::dvec3 found = whole(lobes, 1, face),
                     right = by_samples(sky, islands[1].rotation * face_normal(face));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], right[c], 0.04 * right[c] + 1e-6) << face;
  }
}

TEST(SkyIrradiance, HoldsWhatASkyOfAMillionSends) {
  shared::SkyConstants sky = sky_constants(celestial_at(12.0 * 3600.0, 0.5));
  sky.sun.haze *= 1e6f;
  const std::vector<IslandPlacement> islands(1);
  const std::vector<glm::uvec4> lobes =
      sky_irradiance(sky, islands, std::vector<bool>(islands.size(), true));
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::dvec3 sum = whole(lobes, 0, face);
    EXPECT_TRUE(std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z));
  }
}

}  // namespace
}  // namespace skerry::render
