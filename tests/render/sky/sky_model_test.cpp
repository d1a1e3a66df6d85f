#include "engine/render/sky/sky_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "tools/reference/reference.h"

namespace skerry::render {
namespace {

constexpr double kHour = 3600.0;

double luminance(glm::dvec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

glm::dvec3 direction(double azimuth, double elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

/// Directions about evenly spread over the sphere.
std::vector<glm::dvec3> sphere(int count) {
  std::vector<glm::dvec3> all;
  for (int i = 0; i < count; ++i) {
    const double y = 1.0 - 2.0 * (i + 0.5) / count;
    all.push_back(direction(2.399963229728653 * i, std::asin(y)));
  }
  return all;
}

/// What a camera that sees these and nothing else is exposed to.
double exposure_of(const std::vector<glm::dvec3>& radiance) {
  measure::Picture picture{static_cast<std::uint32_t>(radiance.size()), 1, {}};
  picture.pixels.assign(radiance.begin(), radiance.end());
  return std::exp2(-reference::metered_ev(picture, {}).value_or(0.0));
}

TEST(SkyModel, NoonZenithIsThePapersLuminance) {
  const Celestial noon = celestial_at(12 * kHour, 0.5);
  // Preetham 1999 at turbidity 2.5 and 30 degrees from the zenith: chi = (4/9 - 2.5/120) * 2 pi/3,
  // Y = 5.14225 tan(chi) + 1.88045 [kcd/m2].
  const double kcd = 5.14225 * std::tan((4.0 / 9.0 - 2.5 / 120.0) * 2.0 * M_PI / 3.0) + 1.88045;
  const double y = luminance(sky_radiance({0, 1, 0}, sky_constants(noon)));
  // The blue is made deeper than the paper's, at the price of a little luminance.
  EXPECT_NEAR(y, kcd / 35.0, 0.015 * kcd / 35.0);
  EXPECT_GT(y, 0.1);
  EXPECT_LT(y, 0.3);
}

TEST(SkyModel, HighSkyByDayFollowsThePapersDistribution) {
  // The Perez function of luminance at turbidity 2.5, written out.
  const auto perez = [](double cos_view, double gamma) {
    return (1 - 1.01625 * std::exp(-0.461 / cos_view)) *
           (1 + 5.26835 * std::exp(-2.2756 * gamma) + 0.2028 * std::pow(std::cos(gamma), 2));
  };
  const Celestial day = celestial_at(10.5 * kHour, 0.0);
  const shared::SkyConstants sky = sky_constants(day);
  const double zenith = luminance(sky_radiance({0, 1, 0}, sky));
  for (const glm::dvec3& d : sphere(500)) {
    if (d.y < 0.75) continue;
    const double expected =
        perez(d.y, std::acos(glm::dot(d, day.to_sun))) / perez(1.0, std::acos(day.to_sun.y));
    EXPECT_NEAR(luminance(sky_radiance(d, sky)) / zenith, expected, 0.02 * expected);
  }
}

TEST(SkyModel, IsFiniteAndNeverNegativeAtAnyTimeInAnyDirection) {
  std::vector<glm::dvec3> directions = sphere(300);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double s : {-1.0, 1.0}) {
      glm::dvec3 d(0.0);
      d[axis] = s;
      directions.push_back(d);
    }
  }
  for (double t = 0; t < kDaySeconds; t += 300.0) {
    for (const double phase : {0.0, 0.2, 0.5}) {
      const Celestial now = celestial_at(t, phase);
      const shared::SkyConstants sky = sky_constants(now);
      directions.push_back(now.to_sun);
      for (const glm::dvec3& d : directions) {
        const glm::dvec3 c = sky_radiance(d, sky);
        for (int i = 0; i < 3; ++i)
          EXPECT_TRUE(std::isfinite(c[i]) && c[i] >= 0.0 && c[i] < 10.0) << t;
      }
      directions.pop_back();
    }
  }
}

TEST(SkyModel, ASunInAnyPlaceGivesAFiniteSky) {
  for (const glm::dvec3& d :
       {glm::dvec3{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}, kCelestialPole, -kCelestialPole}) {
    Celestial now = celestial_at(12 * kHour, 0.5);
    now.to_sun = d;
    now.to_moon = -d;
    const shared::SkyConstants sky = sky_constants(now);
    for (const glm::dvec3& view : sphere(200))
      EXPECT_TRUE(std::isfinite(luminance(sky_radiance(view, sky))));
    EXPECT_TRUE(std::isfinite(luminance(sky_radiance(d, sky))));
  }
}

TEST(SkyModel, IsExactlyBlackWithoutSunTwilightAndMoon) {
  const shared::SkyConstants sky = sky_constants(celestial_at(0.0, 0.0));
  for (const glm::dvec3& d : sphere(500)) EXPECT_EQ(sky_radiance(d, sky), glm::dvec3(0.0));
  EXPECT_EQ(sky.stars, 1.0f);
}

TEST(SkyModel, FullMoonLightsASmallBlueSky) {
  const shared::SkyConstants night = sky_constants(celestial_at(0.0, 0.5)),
                             day = sky_constants(celestial_at(12 * kHour, 0.5));
  const glm::dvec3 moonlit = sky_radiance({0, 1, 0}, night);
  EXPECT_NEAR(luminance(moonlit) / luminance(sky_radiance({0, 1, 0}, day)), 0.5 * kMoonToSun,
              0.1 * kMoonToSun);
  EXPECT_GT(moonlit.z, 2.0 * moonlit.x);
}

TEST(SkyModel, ChangesWithoutAJumpFromOneStepOfTimeToTheNext) {
  const std::vector<glm::dvec3> directions = sphere(200);
  for (const double phase : {0.0, 0.3, 0.5}) {
    std::vector<glm::dvec3> last;
    for (double t = 0; t < kDaySeconds; t += 12.0) {
      const Celestial now = celestial_at(t, phase);
      const shared::SkyConstants sky = sky_constants(now);
      std::vector<glm::dvec3> seen;
      for (const glm::dvec3& d : directions) seen.push_back(sky_radiance(d, sky));
      const double exposure = exposure_of(seen);
      for (std::size_t i = 0; i < last.size(); ++i) {
        const double before = luminance(last[i]) * exposure, after = luminance(seen[i]) * exposure;
        EXPECT_LT(std::abs(after - before), 0.002 + 0.025 * before) << t;
      }
      last = seen;
    }
  }
}

TEST(SkyModel, IsContinuousAcrossTheHorizonAndStraightDown) {
  for (double t = 0; t < kDaySeconds; t += 600.0) {
    const shared::SkyConstants sky = sky_constants(celestial_at(t, 0.4));
    for (double azimuth = 0; azimuth < 6.28; azimuth += 0.1) {
      const glm::dvec3 above = sky_radiance(direction(azimuth, 1e-5), sky);
      const glm::dvec3 below = sky_radiance(direction(azimuth, -1e-5), sky);
      EXPECT_LE(glm::length(above - below), 2e-4 * glm::length(above));
      const glm::dvec3 down = sky_radiance(direction(azimuth, -M_PI / 2 + 0.01), sky);
      EXPECT_LE(glm::length(down - sky_radiance({0, -1, 0}, sky)), 1e-3 * glm::length(down));
    }
  }
}

TEST(SkyModel, IsNeverGreen) {
  const std::vector<glm::dvec3> directions = sphere(500);
  for (double t = 0; t < kDaySeconds; t += 120.0) {
    const shared::SkyConstants sky = sky_constants(celestial_at(t, 0.5));
    for (const glm::dvec3& d : directions) {
      const glm::dvec3 c = sky_radiance(d, sky);
      EXPECT_LE(c.y, 1.03 * std::max(c.x, c.z)) << t;
    }
  }
}

TEST(SkyModel, LooksBrightBelowByDayAndDarkByNight) {
  const glm::dvec3 down{0.0, -0.8, 0.6};
  EXPECT_GT(luminance(sky_radiance(down, sky_constants(celestial_at(12 * kHour, 0.0)))), 0.15);
  EXPECT_LT(luminance(sky_radiance(down, sky_constants(celestial_at(0.0, 0.5)))), 0.001);
}

}  // namespace
}  // namespace skerry::render
