#include "engine/render/frame/celestial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/render/air/atmosphere.h"

namespace skerry::render {
namespace {

constexpr double kHour = 3600.0;
constexpr double kDegree = 0.017453292519943295;

double luminance(glm::vec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

void expect_near(glm::dvec3 a, glm::dvec3 b, double tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance);
}

TEST(Celestial, SunRisesInTheEastCulminatesInTheSouthAndSetsInTheWest) {
  const double sine = std::sin(kNoonAltitudeDeg * kDegree),
               cosine = std::cos(kNoonAltitudeDeg * kDegree);
  EXPECT_EQ(celestial_at(6 * kHour, 0.0).to_sun, glm::dvec3(1, 0, 0));
  expect_near(celestial_at(12 * kHour, 0.0).to_sun, {0, sine, cosine}, 1e-15);
  EXPECT_EQ(celestial_at(18 * kHour, 0.0).to_sun, glm::dvec3(-1, 0, 0));
  expect_near(celestial_at(0.0, 0.0).to_sun, {0, -sine, -cosine}, 1e-15);
  EXPECT_GT(celestial_at(9 * kHour, 0.0).to_sun.x, 0.0);
  EXPECT_GT(celestial_at(9 * kHour, 0.0).to_sun.y, 0.0);
}

TEST(Celestial, DirectionsAreUnitAndAtRightAnglesToThePoleAllDay) {
  for (double t = 0; t < kDaySeconds; t += 61.0) {
    const Celestial sky = celestial_at(t, t / kDaySeconds * 7.3);
    EXPECT_NEAR(glm::length(sky.to_sun), 1.0, 1e-15);
    EXPECT_NEAR(glm::length(sky.to_moon), 1.0, 1e-15);
    EXPECT_NEAR(glm::dot(sky.to_sun, kCelestialPole), 0.0, 1e-15);
    EXPECT_NEAR(glm::dot(sky.to_moon, kCelestialPole), 0.0, 1e-15);
  }
}

TEST(Celestial, MoonStandsAtTheElongationOfItsPhase) {
  for (double phase = 0.0; phase < 1.0; phase += 0.01) {
    const Celestial sky = celestial_at(9.5 * kHour, phase);
    EXPECT_NEAR(glm::dot(sky.to_sun, sky.to_moon), std::cos(2 * M_PI * phase), 1e-14);
    EXPECT_NEAR(sky.moon_lit_fraction, 0.5 - 0.5 * std::cos(2 * M_PI * phase), 1e-6);
  }
  const Celestial full = celestial_at(2.0 * kHour, 0.5);
  expect_near(full.to_moon, -full.to_sun, 1e-15);
  // The waxing quarter follows the sun: it culminates when the sun sets.
  EXPECT_GT(celestial_at(18 * kHour, 0.25).to_moon.y, 0.86);
}

TEST(Celestial, AnyFiniteTimeAndPhaseReduceExactly) {
  // 1e12 s = 11574074 days and 6400 s; both numbers are whole, so nothing may be lost.
  EXPECT_EQ(celestial_at(1e12, 0.25).to_sun, celestial_at(6400.0, 0.25).to_sun);
  EXPECT_EQ(celestial_at(-1e12, 0.25).to_sun, celestial_at(80000.0, 0.25).to_sun);
  EXPECT_EQ(celestial_at(100.0, 7.25).to_moon, celestial_at(100.0, 0.25).to_moon);
  EXPECT_EQ(celestial_at(100.0, -0.75).to_moon, celestial_at(100.0, 0.25).to_moon);
  for (const double t : {1e300, -1e300, -1e-300, 5e-324, 86400.0 * (1 - 1e-16)}) {
    const Celestial sky = celestial_at(t, t);
    EXPECT_NEAR(glm::length(sky.to_sun), 1.0, 1e-15) << t;
    EXPECT_TRUE(sky.moon_phase >= 0.0 && sky.moon_phase < 1.0) << t;
  }
}

TEST(Celestial, NoonSunIsNearPiAndWarmer) {
  const glm::vec3 noon = celestial_at(12 * kHour, 0.0).sun_irradiance;
  EXPECT_GT(luminance(noon), 0.9 * M_PI);
  EXPECT_LT(luminance(noon), M_PI);
  EXPECT_GT(noon.x, noon.y);
  EXPECT_GT(noon.y, noon.z);
  EXPECT_GT(noon.z, 0.9 * M_PI);
}

TEST(Celestial, SunlightFadesAndReddensTowardsTheHorizonWithoutAJump) {
  double last = 0.0, last_ratio = 0.0;
  for (double t = 5.8 * kHour; t < 12 * kHour; t += 1.0) {
    const Celestial sky = celestial_at(t, 0.0);
    const double light = luminance(sky.sun_irradiance);
    EXPECT_GE(light, last);
    EXPECT_LT(light - last, 0.002 * M_PI) << t;
    last = light;
    const double altitude = std::asin(sky.to_sun.y) / kDegree;
    EXPECT_EQ(sky.sun_casts, light > 0.0);
    if (altitude < -0.8) {
      EXPECT_EQ(light, 0.0) << altitude;
    }
    if (altitude > -0.7) {
      EXPECT_GT(light, 0.0) << altitude;
      const double blue_over_red = sky.sun_irradiance.z / sky.sun_irradiance.x;
      EXPECT_GE(blue_over_red, last_ratio - 1e-5);
      last_ratio = blue_over_red;
    }
  }
}

TEST(Celestial, NewMoonGivesNoLightAndFullMoonTheStatedShare) {
  for (double t = 0; t < kDaySeconds; t += 600.0) {
    EXPECT_FALSE(celestial_at(t, 0.0).moon_casts);
    EXPECT_FALSE(celestial_at(t, 0.01).moon_casts);
  }
  const double moon = luminance(celestial_at(0.0, 0.5).moon_irradiance);
  const double sun = luminance(celestial_at(12 * kHour, 0.5).sun_irradiance);
  EXPECT_NEAR(moon / sun, kMoonToSun, 0.02 * kMoonToSun);
  const glm::vec3 c = celestial_at(0.0, 0.5).moon_irradiance;
  EXPECT_GT(c.z, c.x);
  // A Lambertian sphere seen half lit sends 1 / pi of its full light.
  const double half = luminance(celestial_at(6 * kHour, 0.75).moon_irradiance);
  EXPECT_NEAR(half / moon, 1.0 / M_PI, 0.01);
}

TEST(Celestial, MoonCastsExactlyWhenItsLightIsNotZero) {
  int lit = 0;
  for (int i = 0; i < 5000; ++i) {
    const Celestial sky = celestial_at(i * 17.3, i * 0.0173);
    EXPECT_EQ(sky.moon_casts, luminance(sky.moon_irradiance) > 0.0);
    EXPECT_EQ(sky.sun_casts, luminance(sky.sun_irradiance) > 0.0);
    lit += sky.moon_casts;
    if (sky.to_moon.y < std::sin(-0.8 * kDegree)) {
      EXPECT_FALSE(sky.moon_casts);
    }
  }
  EXPECT_GT(lit, 1000);
}

TEST(Celestial, StarFrameIsARotationThatTurnsWithTheSunAboutThePole) {
  for (double t = 0; t < kDaySeconds; t += 997.0) {
    const Celestial sky = celestial_at(t, 0.5);
    EXPECT_NEAR(glm::determinant(sky.sky_from_world), 1.0f, 1e-5f);
    expect_near(sky.sky_from_world * glm::vec3(sky.to_sun), {1, 0, 0}, 1e-6);
    expect_near(sky.sky_from_world * glm::vec3(kCelestialPole), {0, 0, 1}, 1e-6);
  }
}

TEST(Celestial, SunlightIsThatOfSpaceThroughTheAirOfTheIslands) {
  for (const double hour : {5.96, 6.0, 6.5, 9.0, 12.0}) {
    const Celestial sky = celestial_at(hour * kHour, 0.0);
    const glm::dvec3 expected =
        sunlight_in_space() * world_atmosphere().direct_light(kWorldAboveMistKm, sky.to_sun.y);
    expect_near(sky.sun_irradiance, expected, 1e-6);
  }
  // A low sun is red: three times as much of it is left as of blue.
  const glm::vec3 low = celestial_at(6.02 * kHour, 0.0).sun_irradiance;
  EXPECT_GT(low.x, 3.0f * low.z);
}

}  // namespace
}  // namespace skerry::render
