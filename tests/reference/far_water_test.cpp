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
constexpr int kPlaces = 5'000;

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
double mirrored(const Meeting& at, const Gloss& gloss, glm::dvec3 to_eye) {
  const glm::dvec3 to_sun = direction_at(kToSun, std::numbers::pi), normal = ripples_of(at, 0.0);
  const double drawn = mirror_lobe(normal, to_sun, to_eye, std::sqrt(gloss.alpha), kIndex);
  const double faded = wave_lobe(normal, to_sun, to_eye, gloss.alpha, kIndex);
  return ((1.0 - gloss.waves) * drawn + gloss.waves * faded) *
         std::max(0.0, glm::dot(normal, to_sun));
}

/// Of many eyes, in and about the direction that still water mirrors the sun to.
struct Glitter {
  double sum = 0.0, most = 0.0;     // what they see, and its largest
  double all = 0.0, largest = 0.0;  // the same of waves that do not fade
  double squares = 0.0, off = 0.0;  // of what they see of these, and of the difference
  double error() const { return std::sqrt(off / squares); }
};

/// @param gloss of water with faded waves.
Glitter glitter_at(double distance, const Gloss& gloss) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> blocks(-1e4, 1e4);
  std::vector<Meeting> places;
  for (int i = 0; i < kPlaces; ++i)
    places.push_back(water(distance, blocks(random), blocks(random)));
  const Gloss still = gloss_of(water(0.0));
  Glitter found;
  for (int up = -7; up <= 7; ++up)
    for (int aside = -7; aside <= 7; ++aside) {
      const glm::dvec3 to_eye = direction_at(kToSun + 0.02 * up, 0.025 * aside);
      double seen = 0.0, truth = 0.0;
      for (Meeting at : places) {
        seen += mirrored(at, gloss, to_eye) / kPlaces;
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
    const Glitter found = glitter_at(distance, gloss_of(water(distance)));
    EXPECT_NEAR(found.sum, found.all, 0.12 * found.all);
    EXPECT_NEAR(found.most, found.largest, 0.4 * found.largest);
    EXPECT_LT(found.error(), 0.4);
  }
}

TEST(FarWater, MirrorsNothingThatItsSteepestWavesDoNot) {
  const Gloss gloss = gloss_of(water(400.0));
  const auto seen = [&](double off) {
    return mirrored(water(400.0), gloss, direction_at(kToSun + off, 0.0));
  };
  EXPECT_LT(seen(0.35), 1e-4 * seen(0.0));
}

TEST(FarWater, WouldMirrorAPointIfItsWavesWereLost) {
  EXPECT_GT(glitter_at(400.0, gloss_of(water(0.0))).error(), 10.0);
}

TEST(FarWater, ThatIsNearHasTheLobeOfItsSmallestWaves) {
  EXPECT_DOUBLE_EQ(gloss_of(water(0.0)).alpha, 0.06 * 0.06);
  EXPECT_EQ(gloss_of(water(0.0)).waves, 0.0);
}

}  // namespace
}  // namespace skerry::reference
