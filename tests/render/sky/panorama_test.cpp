#include "engine/render/sky/panorama.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/packing.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "engine/render/frame/celestial.h"
#include "engine/render/sky/panorama_sky.h"
#include "engine/render/sky/sky_irradiance.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/indirect.h"
#include "tools/reference/open_sky.h"

namespace skerry::render {
namespace {

constexpr double kPi = 3.14159265358979323846;

Panorama made(std::uint32_t columns,
              const std::function<glm::vec3(std::uint32_t, std::uint32_t)>& at,
              std::uint32_t most = kKeptPanoramaColumns) {
  PanoramaMaker maker(columns, columns / 2, most);
  for (std::uint32_t row = 0; row < columns / 2; ++row) {
    std::vector<glm::vec3> texels;
    for (std::uint32_t column = 0; column < columns; ++column) texels.push_back(at(column, row));
    maker.add_row(texels);
  }
  return maker.take();
}

Panorama random_panorama(std::uint32_t columns, std::uint32_t most = kKeptPanoramaColumns) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> even(0.0f, 2.0f);
  return made(
      columns,
      [&](std::uint32_t, std::uint32_t) {
        return glm::vec3(even(random), even(random), even(random));
      },
      most);
}

/// Of all texels: radiance times solid angle.
glm::dvec3 light_of(const Panorama& panorama) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t row = 0; row < panorama.rows; ++row)
    for (std::uint32_t column = 0; column < panorama.columns; ++column)
      sum += glm::dvec3(panorama.at(column, row)) *
             (2.0 * kPi / panorama.columns *
              (std::cos(kPi * row / panorama.rows) - std::cos(kPi * (row + 1.0) / panorama.rows)));
  return sum;
}

glm::dvec3 direction(double yaw_deg, double pitch_deg) {
  const double yaw = yaw_deg * kPi / 180.0, pitch = pitch_deg * kPi / 180.0;
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

SkyModel model_of(Panorama panorama, const PanoramaPlacement& placement = {}) {
  return sky_model(celestial_at(43200.0, 0.5), kWorldAboveMistKm, nullptr,
                   std::make_shared<const PanoramaSky>(std::move(panorama), placement));
}

/// Irradiance of a face, of all lobes.
glm::dvec3 on_face(const SkyModel& sky, const glm::dquat& rotation, std::size_t face) {
  std::vector<IslandPlacement> islands(1);
  islands[0].rotation = rotation;
  const std::vector<glm::uvec4> texels =
      sky_irradiance(sky, celestial_at(43200.0, 0.5), islands, {true}, {});
  glm::dvec3 sum(0.0);
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (int word = 0; word < 4; ++word) {
      const glm::vec2 pair = glm::unpackHalf2x16(
          texels[texels[0][0] + face * shared::kIndirectSkyTexels + channel][word]);
      sum[static_cast<int>(channel)] += static_cast<double>(pair.x) + static_cast<double>(pair.y);
    }
  return sum;
}

constexpr glm::dquat kNotTurned{1.0, 0.0, 0.0, 0.0};

TEST(Panorama, KeepsItsTexelsIfItIsSmall) {
  const auto texel = [](std::uint32_t column, std::uint32_t row) {
    return glm::vec3(static_cast<float>(column), static_cast<float>(row), 0.1f);
  };
  const Panorama small = made(64, texel);
  ASSERT_EQ(small.columns, 64u);
  ASSERT_EQ(small.rows, 32u);
  for (std::uint32_t row = 0; row < 32; ++row)
    for (std::uint32_t column = 0; column < 64; ++column)
      EXPECT_EQ(small.at(column, row), texel(column, row));
}

TEST(Panorama, LosesNoLightWhenItIsMadeSmaller) {
  const glm::dvec3 before = light_of(random_panorama(128));
  for (const std::uint32_t most : {64u, 50u, 2u}) {
    const glm::dvec3 after = light_of(random_panorama(128, most));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c] / before[c], 1.0, 1e-6) << most;
  }
}

TEST(Panorama, WhatCannotBeRadianceCountsAsBlackOrAsTheMost) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  const std::array<float, 4> values{nan, -1.0f, infinite, 3e38f};
  const Panorama mended = made(2, [&](std::uint32_t column, std::uint32_t) {
    return column == 0 ? glm::vec3(values[0], values[1], values[2]) : glm::vec3(values[3]);
  });
  EXPECT_EQ(mended.at(0, 0), glm::vec3(0.0f, 0.0f, kMostPanoramaRadiance));
  EXPECT_EQ(mended.at(1, 0), glm::vec3(kMostPanoramaRadiance));
  EXPECT_EQ(mended.mended, 2u);
}

/// North is -z, east +x (docs/conventions.md): a camera of yaw 0 looks south and has west on its
/// right.
TEST(Panorama, ItsMiddleIsAheadItsRightOnTheRightAndItsTopAbove) {
  const Panorama marked = made(64, [](std::uint32_t column, std::uint32_t row) {
    if (row < 2) return glm::vec3(0.0f, 0.0f, 5.0f);
    const bool ahead = column == 31 || column == 32, right = column == 47 || column == 48;
    const bool level = row == 15 || row == 16;
    return glm::vec3(ahead && level ? 1.0f : 0.0f, right && level ? 1.0f : 0.0f, 0.0f);
  });
  for (const double yaw : {0.0, 90.0, -40.0}) {
    const SkyModel sky = model_of(marked, {.yaw_deg = yaw});
    const reference::Sky judge{sky, glm::dmat3(1.0)};
    const auto expect = [&](glm::dvec3 d, glm::dvec3 radiance) {
      EXPECT_LT(glm::distance(sky_radiance(d, sky), radiance), 1e-6) << yaw;
      EXPECT_LT(glm::distance(reference::sky_behind(d, judge), radiance), 1e-6) << yaw;
    };
    expect(direction(yaw, 0.0), {1.0, 0.0, 0.0});
    expect(direction(yaw - 90.0, 0.0), {0.0, 1.0, 0.0});
    expect(direction(yaw + 90.0, 0.0), {0.0, 0.0, 0.0});
    expect({0.0, 1.0, 0.0}, {0.0, 0.0, 5.0});
    expect({0.0, -1.0, 0.0}, {0.0, 0.0, 0.0});
  }
}

TEST(Panorama, TheReferenceFindsTheSameRadianceByItsOwnFormulas) {
  const SkyModel sky = model_of(random_panorama(64), {.yaw_deg = 33.0, .scale = 2.0f});
  const reference::Sky judge{sky, glm::dmat3(1.0)};
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double y = 1.0 - 2.0 * even(random), turn = 2.0 * kPi * even(random);
    const double flat = std::sqrt(1.0 - y * y);
    const glm::dvec3 d{flat * std::sin(turn), y, flat * std::cos(turn)};
    EXPECT_LT(glm::distance(sky_radiance(d, sky), reference::sky_behind(d, judge)), 1e-5);
  }
}

TEST(Panorama, AnEvenOneLightsEveryOpenFaceWithPiTimesItsRadiance) {
  const glm::vec3 radiance(0.25f, 1.0f, 3.0f);
  const SkyModel sky = model_of(made(32, [&](std::uint32_t, std::uint32_t) { return radiance; }));
  const glm::dquat turned = glm::normalize(glm::dquat(0.8, 0.3, -0.4, 0.2));
  for (const glm::dquat& rotation : {kNotTurned, turned})
    for (std::size_t face = 0; face < 6; ++face) {
      const glm::dvec3 found = on_face(sky, rotation, face);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c] / (kPi * static_cast<double>(radiance[c])), 1.0, 2e-3) << face;
    }
  EXPECT_LT(glm::distance(sky.panorama->mean(), glm::dvec3(radiance)), 1e-4);
}

/// Against the sum over the texels of a picture with a sun of one texel, 3 degrees wide, that
/// sends two thirds of the light: the worst case for few samples.
TEST(Panorama, LightOnFacesIsThatOfItsTexels) {
  double squares = 0.0;
  int count = 0;
  for (const glm::uvec2& sun :
       {glm::uvec2(20, 12), glm::uvec2(64, 20), glm::uvec2(100, 5), glm::uvec2(127, 28)}) {
    const Panorama image = made(128, [&](std::uint32_t column, std::uint32_t row) {
      return column == sun.x && row == sun.y ? glm::vec3(900.0f)
                                             : glm::vec3(row < 32 ? 0.5f : 0.1f);
    });
    const SkyModel sky = model_of(image);
    for (const glm::dquat& rotation : {kNotTurned, glm::normalize(glm::dquat(0.9, 0.1, 0.4, -0.1)),
                                       glm::normalize(glm::dquat(0.3, 0.5, -0.7, 0.2))})
      for (std::size_t face = 0; face < 6; ++face) {
        glm::dvec3 normal(0.0);
        normal[static_cast<int>(face / 2)] = face % 2 == 0 ? 1.0 : -1.0;
        normal = rotation * normal;
        double right = 0.0;
        for (std::uint32_t row = 0; row < image.rows; ++row)
          for (std::uint32_t column = 0; column < image.columns; ++column) {
            const glm::dvec3 d = direction(180.0 - (column + 0.5) / 128.0 * 360.0,
                                           90.0 - (row + 0.5) / 64.0 * 180.0);
            right += static_cast<double>(image.at(column, row).x) *
                     panorama_solid_angle(128, 64, row) * std::max(0.0, glm::dot(d, normal));
          }
        const double found = on_face(sky, rotation, face).x;
        EXPECT_NEAR(found, right, 0.08 * right + 0.08) << sun.x << " face " << face;
        squares += (found / right - 1.0) * (found / right - 1.0);
        ++count;
      }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.05);
}

TEST(Panorama, ItsPeakIsClippedBeforeItIsScaled) {
  const SkyModel sky =
      model_of(made(2, [](std::uint32_t, std::uint32_t) { return glm::vec3(10.0f, 1.0f, 0.0f); }),
               {.scale = 3.0f, .peak = 4.0f});
  EXPECT_EQ(sky_radiance({0.0, 0.0, 1.0}, sky), glm::dvec3(12.0, 3.0, 0.0));
}

TEST(Panorama, TheBrightestSendsWhatIsFinite) {
  const SkyModel sky = model_of(
      made(8, [](std::uint32_t, std::uint32_t) { return glm::vec3(1e30f); }), {.scale = 1e6f});
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::dvec3 found = on_face(sky, kNotTurned, face);
    EXPECT_TRUE(std::isfinite(found.x) && found.x > 0.0);
  }
}

TEST(Panorama, ABlackOneIsABlackSky) {
  const SkyModel sky =
      model_of(made(2, [](std::uint32_t, std::uint32_t) { return glm::vec3(0.0f); }));
  EXPECT_EQ(sky_radiance({0.0, 1.0, 0.0}, sky), glm::dvec3(0.0));
  EXPECT_EQ(on_face(sky, kNotTurned, 2), glm::dvec3(0.0));
  EXPECT_EQ(sky.constants.stars, 0.0f);
}

}  // namespace
}  // namespace skerry::render
