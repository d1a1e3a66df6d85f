#include "engine/render/sky/sky_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "engine/render/air/air.h"

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

/// As a picture holds it, of 255.
double encoded(double c) {
  c = std::clamp(c, 0.0, 1.0);
  return 255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055);
}

/// What a camera that sees these and nothing else is exposed to.
double exposure_of(const std::vector<glm::dvec3>& radiance) {
  measure::Picture picture{static_cast<std::uint32_t>(radiance.size()), 1, {}};
  picture.pixels.assign(radiance.begin(), radiance.end());
  return std::exp2(-reference::metered_ev(picture, {}).value_or(0.0));
}

/// The atmosphere asked for one direction, without a table or a lattice.
glm::dvec3 without_table(glm::dvec3 d, const Celestial& now, double height_km) {
  const double across =
      (d.x * now.to_sun.x + d.z * now.to_sun.z) /
      std::max(1e-12, std::hypot(d.x, d.z) * std::hypot(now.to_sun.x, now.to_sun.z));
  const shared::SkyScatter s =
      sky_scattering_at(world_atmosphere(), height_km, now.to_sun.y, d.y, across);
  const double cosine = glm::dot(d, now.to_sun);
  return sunlight_in_space() * (glm::dvec3(s.rayleigh) * rayleigh_phase(cosine) +
                                glm::dvec3(s.mie) * mie_phase(cosine) + glm::dvec3(s.multiple));
}

TEST(SkyModel, TowardsDirectionsOfOneHeightIsThatOfEach) {
  for (const double hour : {12.0, 6.1, 0.0}) {
    const SkyModel sky = sky_model(celestial_at(hour * kHour, 0.5), 0.3);
    for (const double y : {-0.9, -0.02, 0.0, 0.4, 1.0}) {
      std::vector<glm::dvec3> directions, found(50, glm::dvec3(-1.0));
      for (std::size_t i = 0; i < found.size(); ++i)
        directions.push_back(direction(2.0 * M_PI * static_cast<double>(i) / 50.0, std::asin(y)));
      for (glm::dvec3& d : directions) d.y = y;
      sky_radiance(directions, sky, found);
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_EQ(found[i], sky_radiance(directions[i], sky)) << hour << "h height " << y;
    }
  }
}

TEST(SkyModel, IsTheAtmosphereInEveryDirection) {
  for (const double blocks : {-200.0, 0.0, 1000.0, 10000.0, 100000.0}) {
    const double height = eye_height_km(blocks);
    for (const double hour : {5.6, 6.0, 7.0, 12.0, 18.2}) {
      const Celestial now = celestial_at(hour * kHour, 0.0);
      const SkyModel sky = sky_model(now, height);
      double squares = 0.0, whole = 0.0;
      for (const glm::dvec3& d : sphere(400)) {
        // Where the ground begins it ends between two rows.
        if (std::abs(d.y - horizon_sine(height)) < 0.01) continue;
        const double expected = luminance(without_table(d, now, height));
        squares += std::pow(luminance(sky_radiance(d, sky)) - expected, 2.0);
        whole += expected * expected;
      }
      EXPECT_LT(std::sqrt(squares / whole), 0.02) << blocks << " " << hour;
    }
  }
}

TEST(SkyModel, IsAsBrightAsAClearNoon) {
  // A clear sky's zenith has 2 to 7 kcd/m2 under a high sun, which is 35 kcd/m2 of a white
  // surface that faces it.
  const double zenith =
      luminance(sky_radiance({0, 1, 0}, sky_model(celestial_at(12 * kHour, 0.0))));
  EXPECT_GT(zenith, 0.06);
  EXPECT_LT(zenith, 0.2);
}

TEST(SkyModel, IsBlueOverheadAndRedAtTheHorizonOfASunThatHasSet) {
  const Celestial now = celestial_at(18.25 * kHour, 0.0);  // 3.2 degrees below
  const SkyModel sky = sky_model(now);
  const glm::dvec3 zenith = sky_radiance({0, 1, 0}, sky);
  const glm::dvec3 glow =
      sky_radiance(direction(std::atan2(now.to_sun.x, now.to_sun.z), 0.01), sky);
  EXPECT_GT(zenith.z, 1.3 * zenith.x);  // ozone's: without it this sky is grey
  EXPECT_GT(glow.x, 3.0 * glow.z);
  EXPECT_GT(luminance(glow), 3.0 * luminance(zenith));
}

TEST(SkyModel, GrowsDarkWithHeightAndHasAHorizonBelowTheEye) {
  const Celestial noon = celestial_at(12 * kHour, 0.0);
  double last = 1.0;
  for (const double blocks : {-250.0, 1000.0, 3000.0, 10000.0, 30000.0, 90000.0}) {
    const SkyModel sky = sky_model(noon, eye_height_km(blocks));
    const double zenith = luminance(sky_radiance({0, 1, 0}, sky));
    EXPECT_LT(zenith, last) << blocks;
    last = zenith;
    // acos(R / (R + h))
    EXPECT_NEAR(sky.constants.horizon, -std::acos(6360.0 / (6360.0 + eye_height_km(blocks))), 1e-6);
  }
  EXPECT_EQ(sky_radiance({0, 1, 0}, sky_model(noon, eye_height_km(5e5))), glm::dvec3(0.0));
}

TEST(SkyModel, EyesBeyondTheWorldSeeWhatIsNearest) {
  EXPECT_EQ(eye_height_km(-1e4), 1e-3);
  EXPECT_EQ(eye_height_km(-1e300), 1e-3);
  EXPECT_EQ(eye_height_km(1e300), 1000.0);
  EXPECT_EQ(eye_height_km(1e6), 1000.0);
  for (double blocks = -249.0; blocks < 1e6; blocks = blocks * 1.01 + 3.0) {
    const double exact = (blocks + 250.0) / 1000.0;
    EXPECT_NEAR(eye_height_km(blocks), std::min(exact, 1000.0), std::max(5.1e-4, exact / 256.0));
  }
}

TEST(SkyModel, ASunThatPassesTheHorizonByAMillionthChangesNextToNothing) {
  // A disc of 0.53 degrees rises by a smooth step, half as fast again as evenly; as much again for
  // what changes besides.
  constexpr double kMost = 2.0 * 1.5 * 1e-6 / 9.25e-3;
  const Celestial now = celestial_at(18 * kHour, 0.0);
  std::vector<SkyModel> skies;
  for (const double sine : {-1e-6, 0.0, 1e-6}) {
    Celestial at = now;
    at.to_sun = glm::normalize(glm::dvec3(-1.0, sine, 0.0));
    skies.push_back(sky_model(at));
  }
  for (const glm::dvec3& d : sphere(300)) {
    const glm::dvec3 middle = sky_radiance(d, skies[1]);
    for (const SkyModel& other : skies)
      EXPECT_LE(glm::length(sky_radiance(d, other) - middle), kMost * glm::length(middle));
  }
}

TEST(SkyModel, TablesAreKeptUntilTheirPlaceOfTheLatticeChanges) {
  const SkyModel first = sky_model(celestial_at(9 * kHour, 0.5));
  const SkyModel same = sky_model(celestial_at(9 * kHour, 0.5), kWorldAboveMistKm, &first);
  const SkyModel next = sky_model(celestial_at(9 * kHour + 0.1, 0.5), kWorldAboveMistKm, &first);
  const SkyModel later = sky_model(celestial_at(9 * kHour + 18.0, 0.5), kWorldAboveMistKm, &first);
  const SkyModel higher = sky_model(celestial_at(9 * kHour, 0.5), 2.0, &first);
  EXPECT_EQ(first.scattering[0], same.scattering[0]);
  EXPECT_NE(first.scattering[0], next.scattering[0]);
  EXPECT_EQ(first.nodes[0], next.nodes[0]);
  EXPECT_EQ(first.nodes[0][1], later.nodes[0][0]);  // one of two is made
  EXPECT_NE(first.nodes[0][1], later.nodes[0][1]);
  EXPECT_NE(first.nodes[0][0], higher.nodes[0][0]);
  EXPECT_FALSE(first.scattering[1]);  // no moon beside this sun
}

TEST(SkyModel, IsTheSameWhateverCameBefore) {
  const Celestial now = celestial_at(17.9 * kHour, 0.5);
  const SkyModel before = sky_model(celestial_at(17.9 * kHour - 3.0, 0.5));
  const SkyModel fresh = sky_model(now), later = sky_model(now, kWorldAboveMistKm, &before);
  for (const glm::dvec3& d : sphere(300)) EXPECT_EQ(sky_radiance(d, fresh), sky_radiance(d, later));
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
  for (double t = 0; t < kDaySeconds; t += 1200.0) {
    for (const double phase : {0.0, 0.2, 0.5}) {
      const Celestial now = celestial_at(t, phase);
      const SkyModel sky = sky_model(now);
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
    const SkyModel sky = sky_model(now);
    for (const glm::dvec3& view : sphere(200))
      EXPECT_TRUE(std::isfinite(luminance(sky_radiance(view, sky))));
    EXPECT_TRUE(std::isfinite(luminance(sky_radiance(d, sky))));
  }
}

TEST(SkyModel, IsExactlyBlackWithoutSunTwilightAndMoon) {
  const SkyModel sky = sky_model(celestial_at(0.0, 0.0));
  for (const glm::dvec3& d : sphere(500)) EXPECT_EQ(sky_radiance(d, sky), glm::dvec3(0.0));
  EXPECT_EQ(sky.constants.stars, 1.0f);
}

TEST(SkyModel, FullMoonLightsTheSunsSkyAsMuchAsItLightsTheGround) {
  const Celestial midnight = celestial_at(0.0, 0.5), noon = celestial_at(12 * kHour, 0.0);
  const SkyModel night = sky_model(midnight), day = sky_model(noon);
  for (const glm::dvec3& d : sphere(100)) {
    const glm::dvec3 moonlit = sky_radiance(d, night), sunlit = sky_radiance(d, day);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(moonlit[c] / sunlit[c], luminance(moonlight(0.5)), 0.01 * kMoonToSun);
  }
}

TEST(SkyModel, ChangesWithoutAJumpFromOneStepOfTheClockToTheNext) {
  const std::vector<glm::dvec3> directions = sphere(200);
  for (const double phase : {0.0, 0.5}) {
    std::vector<glm::dvec3> last;
    SkyModel sky;
    for (double t = 17.7 * kHour; t < 18.4 * kHour; t += 1.0) {
      const SkyModel before = sky;
      sky = sky_model(celestial_at(t, phase), kWorldAboveMistKm, &before);
      std::vector<glm::dvec3> seen;
      for (const glm::dvec3& d : directions) seen.push_back(sky_radiance(d, sky));
      const double exposure = exposure_of(seen);
      for (std::size_t i = 0; i < last.size(); ++i) {
        const double was = luminance(last[i]) * exposure, is = luminance(seen[i]) * exposure;
        EXPECT_LT(std::abs(encoded(is) - encoded(was)), 2.0) << t;
      }
      last = seen;
    }
  }
}

TEST(SkyModel, AFrameOfFastTimeChangesNoPixelByMoreThanTwoSteps) {
  // 24 times as fast as the world's clock, 60 frames a second.
  const std::vector<glm::dvec3> directions = sphere(150);
  for (const double begin : {17.83 * kHour, 18.0 * kHour, 18.3 * kHour}) {
    SkyModel sky;
    std::vector<glm::dvec3> last;
    for (double t = begin; t < begin + 60.0; t += 24.0 / 60.0) {
      const SkyModel before = sky;
      sky = sky_model(celestial_at(t, 0.0), kWorldAboveMistKm, &before);
      std::vector<glm::dvec3> seen;
      for (const glm::dvec3& d : directions) seen.push_back(sky_radiance(d, sky));
      const double exposure = exposure_of(seen);
      for (std::size_t i = 0; i < last.size(); ++i)
        for (int c = 0; c < 3; ++c)
          EXPECT_LT(std::abs(encoded(seen[i][c] * exposure) - encoded(last[i][c] * exposure)), 2.0)
              << t;
      last = seen;
    }
  }
}

TEST(SkyModel, IsContinuousStraightDownAndUp) {
  for (double t = 0; t < kDaySeconds; t += 1800.0) {
    const SkyModel sky = sky_model(celestial_at(t, 0.4));
    for (double azimuth = 0; azimuth < 6.28; azimuth += 0.1)
      for (const double end : {-1.0, 1.0}) {
        const glm::dvec3 near = sky_radiance(direction(azimuth, end * (M_PI_2 - 1e-3)), sky);
        EXPECT_LE(glm::length(near - sky_radiance({0, end, 0}, sky)), 3e-3 * glm::length(near));
      }
  }
}

TEST(SkyModel, IsNeverGreen) {
  const std::vector<glm::dvec3> directions = sphere(500);
  for (double t = 0; t < kDaySeconds; t += 600.0) {
    const SkyModel sky = sky_model(celestial_at(t, 0.5));
    for (const glm::dvec3& d : directions) {
      const glm::dvec3 c = sky_radiance(d, sky);
      EXPECT_LE(c.y, 1.08 * std::max(c.x, c.z)) << t;
    }
  }
}

TEST(SkyModel, LooksBrightBelowByDayAndDarkByNight) {
  const glm::dvec3 down{0.0, -0.8, 0.6};
  EXPECT_GT(luminance(sky_radiance(down, sky_model(celestial_at(12 * kHour, 0.0)))), 0.15);
  EXPECT_LT(luminance(sky_radiance(down, sky_model(celestial_at(0.0, 0.5)))), 0.001);
}

}  // namespace
}  // namespace skerry::render
