#include "engine/render/sky/sky_irradiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <random>
#include <utility>

#include "engine/core/harmonics.h"
#include "engine/render/frame/celestial.h"
#include "engine/render/sky/island_shade.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/indirect.h"

namespace skerry::render {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::size_t first_of(const std::vector<glm::uvec4>& sky, std::size_t island) {
  return sky[island / 4][static_cast<int>(island % 4)];
}

/// Irradiance of all lobes of a face.
glm::dvec3 whole(const std::vector<glm::uvec4>& sky, std::size_t island, std::size_t face) {
  glm::dvec3 sum(0.0);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const glm::uvec4 words =
        sky[first_of(sky, island) + face * shared::kIndirectSkyTexels + channel];
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
  const std::size_t first = first_of(sky, island) + shared::kIndirectHarmonics;
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
        sky_irradiance(sky, bodies, islands, std::vector<bool>(islands.size(), true), {});
    ASSERT_EQ(lobes.size(),
              1u + 2u * shared::kIndirectIslandTexels);  // which one, the dark one, its own
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
      sky_irradiance(sky, bodies, islands, std::vector<bool>(islands.size(), true), {});
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
      sky_irradiance(sky, bodies, islands, std::vector<bool>(islands.size(), true), {});
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::dvec3 sum = whole(lobes, 0, face);
    EXPECT_TRUE(std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z));
  }
  for (const auto& of_channel : harmonics_in(lobes, 0))
    for (const double value : of_channel) EXPECT_TRUE(std::isfinite(value));
}

// Sun and moon are blurred: four fifths of what they have beside their mean.
TEST(SkyIrradiance, HarmonicsAreThoseOfSkyAndBodiesAboutTheIslandsAxes) {
  for (const double hour : {12.0, 8.0, 18.2, 0.0}) {
    Celestial bodies = celestial_at(hour * 3600.0, 0.5);
    const SkyModel sky = sky_model(bodies);
    std::vector<IslandPlacement> islands(1);
    islands[0].rotation =
        glm::dquat(std::cos(0.7), glm::dvec3(-0.5, 0.4, 0.2) / std::sqrt(0.45) * std::sin(0.7));
    const auto all = harmonics_in(sky_irradiance(sky, bodies, islands, {true}, {}), 0);
    const glm::dvec3 sun(bodies.sun_irradiance), moon(bodies.moon_irradiance);
    bodies.sun_irradiance = bodies.moon_irradiance = glm::vec3(0.0f);
    const auto of_sky = harmonics_in(sky_irradiance(sky, bodies, islands, {true}, {}), 0);
    const glm::dquat lattice = glm::conjugate(islands[0].rotation);
    const auto by_sun = basis_of(lattice * bodies.to_sun),
               by_moon = basis_of(lattice * bodies.to_moon);
    for (int c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < kHarmonics; ++i)
        EXPECT_NEAR(all[static_cast<std::size_t>(c)][i] - of_sky[static_cast<std::size_t>(c)][i],
                    (sun[c] * by_sun[i] + moon[c] * by_moon[i]) * (i == 0 ? 1.0 : 0.8), 4e-3)
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

glm::dvec3 keyed_in(const std::vector<glm::uvec4>& sky, std::size_t island, std::size_t slot) {
  return std::bit_cast<glm::vec3>(
      glm::uvec3(sky[first_of(sky, island) + shared::kIndirectKeys + slot]));
}

// From a key direction at the sun on, its light changes over from there to the harmonics.
TEST(SkyIrradiance, AKeyDirectionTakesTheSunFromTheHarmonics) {
  for (const double hour : {12.0, 8.0, 0.0}) {
    Celestial bodies = celestial_at(hour * 3600.0, 0.5);
    const bool day = hour > 0.0;
    const glm::dvec3 to_body = day ? bodies.to_sun : bodies.to_moon;
    const glm::dvec3 sent(day ? bodies.sun_irradiance : bodies.moon_irradiance);
    const SkyModel sky = sky_model(bodies);
    std::vector<IslandPlacement> islands(1);
    islands[0].rotation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(0.5, 1.0, 0.2)));
    const auto with_all = harmonics_in(sky_irradiance(sky, bodies, islands, {true}, {}), 0);
    Celestial without = bodies;
    (day ? without.sun_irradiance : without.moon_irradiance) = glm::vec3(0.0f);
    const auto without_body = harmonics_in(sky_irradiance(sky, without, islands, {true}, {}), 0);
    const glm::dvec3 across = glm::normalize(glm::cross(to_body, glm::dvec3(0.3, 0.2, 0.9)));
    double before = 2.0;
    for (const double off_deg : {0.0, 3.9, 5.5, 7.0, 8.5, 10.1, 90.0, 180.0}) {
      const glm::dvec3 key = glm::angleAxis(glm::radians(off_deg), across) * to_body;
      islands[0].keyed[1] = {glm::vec3(glm::conjugate(islands[0].rotation) * key), 0.75f};
      islands[0].keyed[0] = {glm::vec3(0.0f, 1.0f, 0.0f), 0.0f};
      const std::vector<glm::uvec4> now = sky_irradiance(sky, bodies, islands, {true}, {});
      const double share = keyed_in(now, 0, 1).y / sent.y;
      EXPECT_LT(share, before + 1e-6) << off_deg;
      before = share;
      if (off_deg < kNearKeyDeg || off_deg > kFarFromKeyDeg) {
        EXPECT_NEAR(share, off_deg < kNearKeyDeg ? 0.75 : 0.0, 1e-4) << off_deg;
      }
      EXPECT_EQ(keyed_in(now, 0, 0), glm::dvec3(0.0));
      const auto harmonics = harmonics_in(now, 0);
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < kHarmonics; ++i)
          EXPECT_NEAR(harmonics[c][i],
                      with_all[c][i] + share * (without_body[c][i] - with_all[c][i]),
                      2e-3 * with_all[c][0])
              << hour << "h, " << off_deg << " degrees, harmonic " << i;
    }
  }
}

TEST(SkyIrradiance, HarmonicsOfATurnedIslandAreTheSameFunctionAboutOtherAxes) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
  };
  Celestial bodies = celestial_at(8.0 * 3600.0, 0.5);
  const SkyModel sky = sky_model(bodies);
  bodies.sun_irradiance = bodies.moon_irradiance = glm::vec3(0.0f);
  std::vector<IslandPlacement> islands(20);
  for (std::size_t i = 1; i < islands.size(); ++i)
    islands[i].rotation = glm::angleAxis(3.0 * normal(random), direction());
  const std::vector<glm::uvec4> skies =
      sky_irradiance(sky, bodies, islands, std::vector<bool>(islands.size(), true), {});
  const auto in_world = harmonics_in(skies, 0);
  const auto towards = [](const std::array<double, kHarmonics>& of, const glm::dvec3& d) {
    double sum = 0.0;
    const auto basis = basis_of(d);
    for (std::size_t i = 0; i < kHarmonics; ++i) sum += of[i] * basis[i];
    return sum;
  };
  for (std::size_t i = 1; i < islands.size(); ++i) {
    const auto own = harmonics_in(skies, i);
    for (int k = 0; k < 30; ++k) {
      const glm::dvec3 d = direction();
      for (std::size_t c = 0; c < 3; ++c)  // of halves
        EXPECT_NEAR(towards(own[c], d), towards(in_world[c], islands[i].rotation * d),
                    1e-3 * in_world[c][0]);
    }
  }
}

// By directions drawn evenly: light of the sky past the other island, and a quarter of what a
// surface receives there that faces this one.
TEST(SkyIrradiance, IsWhatOtherIslandsLetPastAndReflect) {
  const Celestial bodies = celestial_at(9.0 * 3600.0, 0.5);
  const SkyModel sky = sky_model(bodies);
  std::vector<IslandPlacement> islands(2);
  islands[0].rotation = glm::angleAxis(0.5, glm::normalize(glm::dvec3(0.2, 1.0, -0.1)));
  islands[1].origin = {70 * 65536, 50 * 65536, -20 * 65536};
  for (IslandPlacement& island : islands) island.land = {glm::vec3(0.0f), {50.0f, 20.0f, 40.0f}};
  const std::vector<glm::uvec4> lobes = sky_irradiance(sky, bodies, islands, {true, true}, {});
  const IslandShade shade(islands, islands_that_hide(islands), 0, 1.0f);

  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  constexpr int kSamples = 4000;
  std::vector<std::pair<glm::dvec3, glm::dvec3>> seen;  // directions and radiance
  for (int i = 0; i < kSamples; ++i) {
    const double y = 1.0 - 2.0 * even(random), turn = 2.0 * kPi * even(random);
    const double r = std::sqrt(1.0 - y * y);
    const glm::dvec3 d{r * std::cos(turn), y, r * std::sin(turn)};
    seen.emplace_back(d, sky_radiance(d, sky));
  }
  const auto facing = [&](const glm::dvec3& d) {
    glm::dvec3 sum = glm::dvec3(bodies.sun_irradiance) * std::max(0.0, glm::dot(d, bodies.to_sun));
    for (const auto& [from, radiance] : seen)
      sum += radiance * (std::max(0.0, glm::dot(d, from)) * 4.0 * kPi / kSamples);
    return sum / kPi;
  };
  double hidden = 0.0;
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::dvec3 normal = islands[0].rotation * face_normal(face);
    glm::dvec3 right(0.0), open(0.0);
    for (const auto& [d, radiance] : seen) {
      const double cosine = glm::dot(d, normal) * 4.0 * kPi / kSamples;
      if (cosine <= 0.0) continue;
      const double past =
          static_cast<double>(shade.towards(glm::vec3(d)).value_or(IslandShade::Open{}).face[face]);
      open += radiance * cosine;
      right += radiance * (cosine * past);
      if (past < 1.0) right += facing(-d) * (0.25 * cosine * (1.0 - past));
    }
    const glm::dvec3 found = whole(lobes, 0, face);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], right[c], 0.05 * right[c] + 1e-6) << face;
    hidden = std::max(hidden, 1.0 - right.z / open.z);
  }
  EXPECT_GT(hidden, 0.1);
}

/// All numbers of an island's sky.
std::vector<double> numbers_of(const std::vector<glm::uvec4>& sky, std::size_t island) {
  std::vector<double> out;
  const std::size_t first = first_of(sky, island);
  for (std::size_t texel = 0; texel < shared::kIndirectHarmonics; ++texel)
    for (int word = 0; word < 4; ++word) {
      const glm::vec2 pair = glm::unpackHalf2x16(sky[first + texel][word]);
      out.insert(out.end(), {static_cast<double>(pair.x), static_cast<double>(pair.y)});
    }
  for (const auto& of_channel : harmonics_in(sky, island))
    out.insert(out.end(), of_channel.begin(), of_channel.end());
  return out;
}

// A turned island sees what one that is not turned sees of a sky that is turned the other way.
TEST(SkyIrradiance, OfAnyHeadingIsThatOfTheTurnedSky) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> turn(-kPi, kPi);
  for (const double hour : {12.0, 8.0, 18.2, 0.0})
    for (int i = 0; i < 8; ++i) {
      const Celestial bodies = celestial_at(hour * 3600.0, 0.5);
      std::vector<IslandPlacement> islands(1);
      islands[0].rotation = glm::angleAxis(turn(random), glm::dvec3(0.0, 1.0, 0.0));
      const std::vector<double> found =
          numbers_of(sky_irradiance(sky_model(bodies), bodies, islands, {true}, {}), 0);
      Celestial turned = bodies;
      const glm::dquat back = glm::conjugate(islands[0].rotation);
      turned.to_sun = back * bodies.to_sun, turned.to_moon = back * bodies.to_moon;
      islands[0].rotation = glm::dquat(1.0, 0.0, 0.0, 0.0);
      const std::vector<double> right =
          numbers_of(sky_irradiance(sky_model(turned), turned, islands, {true}, {}), 0);
      double most = 0.0;
      for (const double value : right) most = std::max(most, std::abs(value));
      for (std::size_t k = 0; k < right.size(); ++k)
        EXPECT_NEAR(found[k], right[k], 0.004 * most) << hour << "h number " << k;
    }
}

TEST(SkyIrradiance, FarIslandsShareTheSkiesOfSixtyFourHeadings) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> turn(-kPi, kPi);
  std::vector<IslandPlacement> islands(500);
  for (IslandPlacement& island : islands) {
    island.rotation = glm::angleAxis(turn(random), glm::dvec3(0.0, 1.0, 0.0));
    island.far = true;
  }
  std::vector<bool> shown(islands.size(), true);
  shown[3] = false;
  const Celestial bodies = celestial_at(8.0 * 3600.0, 0.5);
  const SkyModel sky = sky_model(bodies);
  const std::vector<glm::uvec4> far = sky_irradiance(sky, bodies, islands, shown, {});
  EXPECT_LE(far.size(), 125u + 65u * shared::kIndirectIslandTexels);
  for (const double value : numbers_of(far, 3)) EXPECT_EQ(value, 0.0);
  for (IslandPlacement& island : islands) island.far = false;
  const std::vector<glm::uvec4> near = sky_irradiance(sky, bodies, islands, shown, {});
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const std::vector<double> found = numbers_of(far, i), right = numbers_of(near, i);
    double most = 0.0;
    for (const double value : right) most = std::max(most, std::abs(value));
    // Half a step of 0.098, by which harmonics of degree 2 turn twice.
    for (std::size_t k = 0; k < right.size(); ++k) EXPECT_NEAR(found[k], right[k], 0.1 * most) << i;
  }
}

}  // namespace
}  // namespace skerry::render
