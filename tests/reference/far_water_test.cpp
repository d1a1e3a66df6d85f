// What far water mirrors of a light, whose waves are smaller than a pixel, against the mean over
// waves that do not fade.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tools/reference/brdf.h"
#include "tools/reference/media.h"

namespace skerry::reference {
namespace {

constexpr double kIndex = 4.0 / 3.0;
constexpr double kToSun = 20.0 * std::numbers::pi / 180.0;  // above the horizon
constexpr int kPlaces = 20'000;

/// Level water seen from a distance, anywhere on it.
Meeting water(double distance, double x = 0.0, double z = 0.0) {
  Meeting at;
  at.block = world::block::kWater;
  at.face = 2;
  at.lattice = {x, 1.0, z};
  at.t = distance;
  return at;
}

glm::dvec3 direction_at(double height, double heading) {
  return {std::cos(height) * std::sin(heading), std::sin(height),
          std::cos(height) * std::cos(heading)};
}

/// Share of the sun's irradiance that water sends to the eye [1/sr].
double mirrored(const Meeting& at, double alpha, glm::dvec3 to_eye) {
  const glm::dvec3 to_sun = direction_at(kToSun, std::numbers::pi), normal = ripples_of(at, 0.0);
  return mirror_lobe(normal, to_sun, to_eye, std::sqrt(alpha), kIndex) *
         std::max(0.0, glm::dot(normal, to_sun));
}

/// Of many eyes, in and about the direction that still water mirrors the sun to.
struct Glitter {
  double sum = 0.0, most = 0.0;     // what they see, and its largest
  double all = 0.0, largest = 0.0;  // the same of waves that do not fade
  double squares = 0.0, off = 0.0;  // of what they see of these, and of the difference
  double error() const { return std::sqrt(off / squares); }
};

/// @param alpha of the lobe in which faded waves mirror.
Glitter glitter_at(double distance, double alpha) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> blocks(-1e4, 1e4);
  std::vector<Meeting> places;
  for (int i = 0; i < kPlaces; ++i)
    places.push_back(water(distance, blocks(random), blocks(random)));
  const double still = alpha_of(water(0.0));
  Glitter found;
  for (int up = -3; up <= 3; ++up)
    for (int aside = -3; aside <= 3; ++aside) {
      const glm::dvec3 to_eye = direction_at(kToSun + 0.04 * up, 0.05 * aside);
      double seen = 0.0, truth = 0.0;
      for (Meeting at : places) {
        seen += mirrored(at, alpha, to_eye) / kPlaces;
        at.t = 0.0;
        truth += mirrored(at, still, to_eye) / kPlaces;
      }
      found.sum += seen;
      found.all += truth;
      found.most = std::max(found.most, seen);
      found.largest = std::max(found.largest, truth);
      found.squares += truth * truth;
      found.off += (seen - truth) * (seen - truth);
    }
  return found;
}

TEST(FarWater, MirrorsTheSunAsWidelyAsItsWavesDo) {
  for (const double distance : {10.0, 35.0, 400.0}) {
    SCOPED_TRACE(distance);
    const Glitter found = glitter_at(distance, alpha_of(water(distance)));
    EXPECT_NEAR(found.sum, found.all, 0.1 * found.all);
    EXPECT_NEAR(found.most, found.largest, 0.2 * found.largest);
    EXPECT_LT(found.error(), 0.4);
  }
}

TEST(FarWater, WouldMirrorAPointIfItsWavesWereLost) {
  EXPECT_GT(glitter_at(400.0, alpha_of(water(0.0))).error(), 10.0);
}

TEST(FarWater, ThatIsNearHasTheLobeOfItsSmallestWaves) {
  EXPECT_DOUBLE_EQ(alpha_of(water(0.0)), 0.06 * 0.06);
}

}  // namespace
}  // namespace skerry::reference
