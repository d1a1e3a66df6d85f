#include "engine/render/sky/sky_irradiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <random>

#include "engine/core/harmonics.h"
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
    const glm::uvec4 words =
        sky[island * shared::kIndirectIslandTexels + face * shared::kIndirectSkyTexels + channel];
    for (int i = 0; i < 4; ++i) {
      const glm::vec2 pair = glm::unpackHalf2x16(words[i]);
      sum[static_cast<int>(channel)] += static_cast<double>(pair.x) + static_cast<double>(pair.y);
    }
  }
  return sum;
}

/// By channel.
std::array<std::array<double, kHarmonics>, 3> harmonics_in(const std::vector<glm::uvec4>& sky,
                                                           std::size_t island) {
  const std::size_t first = island * shared::kIndirectIslandTexels + shared::kIndirectHarmonics;
  std::array<std::array<double, kHarmonics>, 3> out{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    out[channel][0] =
        static_cast<double>(std::bit_cast<float>(sky[first + 3][static_cast<int>(channel)]));
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::vec2 pair = glm::unpackHalf2x16(sky[first + channel][static_cast<int>(i)]);
      out[channel][2 * i + 1] = static_cast<double>(pair.x);
      out[channel][2 * i + 2] = static_cast<double>(pair.y);
    }
  }
  return out;
}

std::array<double, kHarmonics> basis_of(glm::dvec3 d) {
  return harmonics_of(d.x, d.y, d.z);
}

glm::dvec3 face_normal(std::size_t face) {
  glm::dvec3 n(0.0);
  n[static_cast<int>(face / 2)] = face % 2 == 0 ? 1.0 : -1.0;
  return n;
}

/// By directions drawn evenly over the sphere.
glm::dvec3 by_samples(const SkyModel& sky, glm::dvec3 normal) {
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
    const Celestial bodies = celestial_at(hour * 3600.0, 0.5);
    const SkyModel sky = sky_model(bodies);
    const std::vector<IslandPlacement> islands(1);
    const std::vector<glm::uvec4> lobes =
        sky_irradiance(sky, bodies, islands, std::vector<bool>(islands.size(), true));
    ASSERT_EQ(lobes.size(), 22u);
    for (std::size_t face = 0; face < 6; ++face) {
      const glm::dvec3 found = whole(lobes, 0, face), right = by_samples(sky, face_normal(face));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], right[c], 0.04 * right[c] + 1e-6) << hour << "h face " << face;
    }
  }
}

TEST(SkyIrradiance, TurnsWithTheIsland) {
  const Celestial bodies = celestial_at(8.0 * 3600.0, 0.5);
  const SkyModel sky = sky_model(bodies);
  std::vector<IslandPlacement> islands(2);
  islands[1].rotation =
      glm::dquat(std::cos(0.4), glm::dvec3(0.3, 0.9, -0.2) / std::sqrt(0.94) * std::sin(0.4));
  const std::vector<glm::uvec4> lobes =
      sky_irradiance(sky, bodies, islands, std::vector<bool>(islands.size(), true));
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::dvec3 found = whole(lobes, 1, face),
                     right = by_samples(sky, islands[1].rotation * face_normal(face));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], right[c], 0.04 * right[c] + 1e-6) << face;
  }
}

TEST(SkyIrradiance, HoldsWhatASkyOfAMillionSends) {
  Celestial bodies = celestial_at(12.0 * 3600.0, 0.5);
  SkyModel sky = sky_model(bodies);
  bodies.sun_irradiance *= 1e6f;
  sky.constants.sun.light *= 1e6f;
  const std::vector<IslandPlacement> islands(1);
  const std::vector<glm::uvec4> lobes =
      sky_irradiance(sky, bodies, islands, std::vector<bool>(islands.size(), true));
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::dvec3 sum = whole(lobes, 0, face);
    EXPECT_TRUE(std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z));
  }
  for (const auto& of_channel : harmonics_in(lobes, 0))
    for (const double value : of_channel) EXPECT_TRUE(std::isfinite(value));
}

TEST(SkyIrradiance, HarmonicsAreThoseOfSkyAndBodiesAboutTheIslandsAxes) {
  for (const double hour : {12.0, 8.0, 18.2, 0.0}) {
    Celestial bodies = celestial_at(hour * 3600.0, 0.5);
    const SkyModel sky = sky_model(bodies);
    std::vector<IslandPlacement> islands(1);
    islands[0].rotation =
        glm::dquat(std::cos(0.7), glm::dvec3(-0.5, 0.4, 0.2) / std::sqrt(0.45) * std::sin(0.7));
    const auto all = harmonics_in(sky_irradiance(sky, bodies, islands, {true}), 0);
    const glm::dvec3 sun(bodies.sun_irradiance), moon(bodies.moon_irradiance);
    bodies.sun_irradiance = bodies.moon_irradiance = glm::vec3(0.0f);
    const auto of_sky = harmonics_in(sky_irradiance(sky, bodies, islands, {true}), 0);
    const glm::dquat lattice = glm::conjugate(islands[0].rotation);
    const auto by_sun = basis_of(lattice * bodies.to_sun),
               by_moon = basis_of(lattice * bodies.to_moon);
    for (int c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < kHarmonics; ++i)
        EXPECT_NEAR(all[static_cast<std::size_t>(c)][i] - of_sky[static_cast<std::size_t>(c)][i],
                    sun[c] * by_sun[i] + moon[c] * by_moon[i], 4e-3)
            << hour << "h harmonic " << i;
    // Irradiance by harmonics up to degree 2 (R. Ramamoorthi, P. Hanrahan, 2001).
    for (std::size_t face = 0; face < 6; ++face) {
      const auto basis = basis_of(face_normal(face));
      const glm::dvec3 right = by_samples(sky, islands[0].rotation * face_normal(face));
      for (int c = 0; c < 3; ++c) {
        double found = 0.0;
        for (std::size_t i = 0; i < kHarmonics; ++i)
          found += (i == 0  ? kPi
                    : i < 4 ? 2.0 / 3.0 * kPi
                            : kPi / 4.0) *
                   of_sky[static_cast<std::size_t>(c)][i] * basis[i];
        EXPECT_NEAR(found, right[c], 0.06 * right[c] + 1e-6) << hour << "h face " << face;
      }
    }
  }
}

}  // namespace
}  // namespace skerry::render
