#include "engine/render/air/atmosphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/render/air/sky_scattering.h"
#include "tools/reference/air_paths.h"

namespace skerry::render {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

glm::dvec3 view(double elevation_deg, double azimuth_deg) {
  const double e = elevation_deg * kDegree, a = azimuth_deg * kDegree;
  return {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
}

/// What the tables say of a direction under a sun of irradiance 1 at azimuth 0.
glm::dvec3 by_tables(const Atmosphere& air, double height, glm::dvec3 sun, glm::dvec3 d) {
  const shared::SkyScatter s =
      sky_scattering_at(air, height, sun.y, d.y, d.x / std::hypot(d.x, d.z));
  const double cosine = glm::dot(sun, d);
  return glm::dvec3(s.rayleigh) * rayleigh_phase(cosine) + glm::dvec3(s.mie) * mie_phase(cosine) +
         glm::dvec3(s.multiple);
}

/// All but pure air, in which no light counts as going straight on.
const Atmosphere& pure_air() {
  static const Atmosphere air({1.0, glm::dvec3(0.0)});
  return air;
}

TEST(Atmosphere, StraightUpItIsTheClosedForm) {
  // Depths of exponential layers of 8 and 1.2 km, 100 km deep, and of a triangle of ozone 30 km
  // wide.
  const glm::dvec3 molecules{5.802e-3, 13.558e-3, 33.1e-3}, ozone{0.650e-3, 1.881e-3, 0.085e-3};
  for (const double turbidity : {1.0, 1.5, 10.0}) {
    const Atmosphere air({turbidity, kMistAlbedo});
    const double beta = std::max(0.0, 0.04608 * turbidity - 0.04586);
    const glm::dvec3 aerosol =
        beta * glm::dvec3(std::pow(0.68, -1.3), std::pow(0.55, -1.3), std::pow(0.44, -1.3));
    for (int c = 0; c < 3; ++c) {
      const double depth =
          molecules[c] * 8.0 * (1.0 - std::exp(-100.0 / 8.0)) + aerosol[c] + ozone[c] * 15.0;
      EXPECT_NEAR(air.transmittance(0.0, 1.0)[c], std::exp(-depth), 0.01 * std::exp(-depth))
          << turbidity;
      EXPECT_NEAR(air.transmittance(100.0, 1.0)[c], 1.0, 1e-9);
    }
  }
}

TEST(Atmosphere, TransmittanceIsTheIntegralAlongTheRay) {
  const Atmosphere& air = world_atmosphere();
  for (const double height : {0.0, 0.25, 2.0, 10.0, 40.0})
    for (const double elevation : {0.3, 1.0, 3.0, 10.0, 30.0, 80.0})
      for (int c = 0; c < 3; ++c) {
        const double expected =
            reference::towards_sun(reference::gas(c, kTurbidity, kMistAlbedo),
                                   {0.0, 6360.0 + height, 0.0}, view(elevation, 0.0));
        EXPECT_NEAR(air.transmittance(height, std::sin(elevation * kDegree))[c], expected,
                    0.005 + 0.01 * expected)
            << height << " " << elevation;
      }
}

TEST(Atmosphere, PhaseFunctionsSendOnAllLight) {
  double rayleigh = 0.0, mie = 0.0;
  constexpr int kParts = 20000;
  for (int i = 0; i < kParts; ++i) {
    const double c = 2.0 * (i + 0.5) / kParts - 1.0;
    rayleigh += rayleigh_phase(c) * 4.0 * std::numbers::pi / kParts;
    mie += mie_phase(c) * 4.0 * std::numbers::pi / kParts;
    EXPECT_EQ(rayleigh_phase(c), rayleigh_phase(-c));
  }
  EXPECT_NEAR(rayleigh, 1.0, 1e-6);
  EXPECT_NEAR(mie, 1.0, 1e-6);
}

TEST(Atmosphere, LightScatteredOnceIsTheFineIntegral) {
  for (const double height : {0.25, 10.0})
    for (const double sun_deg : {50.0, 10.0, 1.0, -4.0}) {
      const glm::dvec3 sun = view(sun_deg, 0.0);
      double squares = 0.0, whole = 0.0;
      for (const double elevation : {2.0, 6.0, 20.0, 60.0})
        for (const double azimuth : {5.0, 90.0, 180.0})
          for (int c = 0; c < 3; ++c) {
            const glm::dvec3 d = view(elevation, azimuth);
            const shared::SkyScatter s =
                sky_scattering_at(pure_air(), height, sun.y, d.y, d.x / std::hypot(d.x, d.z));
            const double cosine = glm::dot(sun, d);
            const double got = static_cast<double>(s.rayleigh[c]) * rayleigh_phase(cosine) +
                               static_cast<double>(s.mie[c]) * mie_phase(cosine);
            const double expected = reference::scattered_once(
                reference::gas(c, 1.0, glm::dvec3(0.0)), {0.0, 6360.0 + height, 0.0}, d, sun, 300);
            squares += (got - expected) * (got - expected);
            whole += expected * expected;
          }
      EXPECT_LT(std::sqrt(squares / whole), 0.015) << height << " " << sun_deg;
    }
}

/// Root of the mean square of what the tables are off from paths at random, over that of the light;
/// the paths' own noise, which is known, is taken off.
double error_of_all_light(double height, double sun_deg, int paths) {
  const glm::dvec3 sun = view(sun_deg, 0.0), eye{0.0, 6360.0 + height, 0.0};
  double squares = 0.0, whole = 0.0;
  for (const double elevation : {-20.0, 2.0, 10.0, 40.0})
    for (const double azimuth : {40.0, 110.0, 180.0}) {
      const glm::dvec3 d = view(elevation, azimuth),
                       got = by_tables(world_atmosphere(), height, sun, d);
      for (int c = 0; c < 3; ++c) {
        const reference::Gas gas = reference::gas(c, kTurbidity, kMistAlbedo);
        const auto seed = static_cast<unsigned>(1000.0 * elevation + 10.0 * azimuth + c);
        const reference::Estimate more =
            reference::AirPaths(gas, sun, seed).more_than_once(eye, d, paths);
        const double expected = reference::scattered_once(gas, eye, d, sun, 400) + more.mean;
        squares += (got[c] - expected) * (got[c] - expected) - more.error * more.error;
        whole += expected * expected;
      }
    }
  return std::sqrt(std::max(0.0, squares) / whole);
}

TEST(Atmosphere, AllLightIsThatOfPathsAtRandomByDay) {
  EXPECT_LT(error_of_all_light(0.25, 50.0, 4000), 0.025);
  EXPECT_LT(error_of_all_light(0.25, 20.0, 4000), 0.025);
  EXPECT_LT(error_of_all_light(10.0, 40.0, 4000), 0.03);
}

TEST(Atmosphere, AllLightIsThatOfPathsAtRandomAtDusk) {
  EXPECT_LT(error_of_all_light(0.25, 3.0, 4000), 0.03);
  EXPECT_LT(error_of_all_light(0.25, -3.0, 10000), 0.04);
  EXPECT_LT(error_of_all_light(0.25, -6.0, 20000), 0.05);
}

TEST(Atmosphere, NoLightIsMade) {
  // What comes in through a horizontal area above the air, and what goes out of it: a white ground
  // and air that absorbs a little of it.
  const Atmosphere white({1.0, glm::dvec3(1.0)});
  for (const double sun_deg : {20.0, 60.0, 90.0}) {
    const glm::dvec3 sun = view(sun_deg, 0.0);
    glm::dvec3 out(0.0);
    constexpr int kParts = 40;
    const double horizon = -horizon_sine(99.9);
    for (int i = 0; i < kParts; ++i)
      for (int j = 0; j < kParts; ++j) {
        // Down to the ground below, which is flat to a part in a hundred.
        const double sine = -horizon - (1.0 - horizon) * (i + 0.5) / kParts;
        const double turn = std::numbers::pi * (j + 0.5) / kParts,
                     flat = std::sqrt(1 - sine * sine);
        const glm::dvec3 d{flat * std::cos(turn), sine, flat * std::sin(turn)};
        out += by_tables(white, 99.9, sun, d) *
               (-sine * 2.0 * std::numbers::pi * (1.0 - horizon) / (kParts * kParts));
      }
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT(out[c], sun.y) << sun_deg;
      EXPECT_GT(out[c], 0.75 * sun.y) << sun_deg;
    }
  }
}

TEST(Atmosphere, AnyTurbidityAndPlaceGivesLightThatIsFiniteAndNotNegative) {
  for (const double turbidity : {1.0, 3.0, 10.0}) {
    const Atmosphere air({turbidity, kMistAlbedo});
    for (const double height : {0.0, 1e-3, 0.25, 10.0, 100.0, 1000.0})
      for (const double sun_deg : {-90.0, -12.0, -1e-4, 0.0, 1e-4, 45.0, 90.0})
        for (const shared::SkyScatter& s : sky_scattering(air, height, std::sin(sun_deg * kDegree)))
          for (int c = 0; c < 3; ++c)
            ASSERT_TRUE(s.rayleigh[c] >= 0.0f && s.mie[c] >= 0.0f && s.multiple[c] >= 0.0f &&
                        s.rayleigh[c] < 1e3f && s.mie[c] < 1e3f && s.multiple[c] < 1e3f)
                << turbidity << " " << height << " " << sun_deg;
  }
}

}  // namespace
}  // namespace skerry::render
