// Light that reaches places under water and behind glass, against Snell's, Fresnel's and Beer's
// laws.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/reference/made_scenes.h"
#include "tests/water_laws.h"
#include "tools/reference/media.h"
#include "tools/reference/shade.h"

namespace skerry::reference {
namespace {

using water_laws::bent_cosine;
using water_laws::fresnel_at;
using water_laws::kIndex;
using water_laws::over_hemisphere;

constexpr double kPi = std::numbers::pi;
constexpr int kDeep = 4;
constexpr glm::dvec3 kBed{0.5, -kDeep + 1e-6, 0.5};

/// Level water, four blocks deep and wide enough that no light comes in at its sides.
Island lake() {
  return {world::Volume::from_voxels({-60, -6, -60}, {61, 0, 61}, [](world::IVec3 v) {
    return world::BlockId{v.y < -kDeep ? world::block::kStone : world::block::kWater};
  })};
}

glm::dvec3 extinction_of(world::BlockId block) {
  const world::BlockType& type = world::block_types()[block];
  const auto& a = type.absorption;
  return glm::dvec3(a[0], a[1], a[2]) + static_cast<double>(type.scattering);
}

glm::dvec3 irradiance_at(const Scene& scene, glm::dvec3 point, glm::dvec3 normal,
                         std::uint32_t count) {
  const Tracer tracer(scene.islands);
  const Shader shader(scene, tracer);
  glm::dvec3 sum(0.0);
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(7, 3, i);
    sum += shader.irradiance({point, normal}, sampler);
  }
  return sum / double(count);
}

TEST(ReferenceUnderWater, ABedHasWhatFresnelAndBeerLeaveOfTheSun) {
  Scene scene;
  scene.islands = {lake()};
  for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * kPi / 180.0, cosine = std::cos(angle);
    scene.bodies = {{{std::sin(angle), cosine, 0.0}, glm::dvec3(2.0), 0.0}};
    const glm::dvec3 extinction = extinction_of(world::block::kWater);
    const double way = kDeep / bent_cosine(cosine);
    const glm::dvec3 level = irradiance_at(scene, kBed, {0.0, 1.0, 0.0}, 1);
    // A wall that faces the sun: by the angle at which the bent light meets it.
    const glm::dvec3 upright = irradiance_at(scene, kBed, {1.0, 0.0, 0.0}, 1);
    for (int c = 0; c < 3; ++c) {
      const double expected =
          2.0 * (1.0 - fresnel_at(cosine)) * cosine * std::exp(-way * extinction[c]);
      EXPECT_NEAR(level[c], expected, 1e-5);
      const double tangent = std::sqrt(1.0 / std::pow(bent_cosine(cosine), 2.0) - 1.0);
      EXPECT_NEAR(upright[c], expected * tangent, 1e-5);
    }
  }
}

TEST(ReferenceUnderWater, ABedHasWhatIsLeftOfAnEvenSky) {
  Scene scene;
  scene.islands = {lake()};
  scene.environment = glm::dvec3(1.0);
  const glm::dvec3 seen = irradiance_at(scene, kBed, {0.0, 1.0, 0.0}, 1u << 16);
  for (int c = 0; c < 3; ++c) {
    double expected = 0.0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps;
      expected += 2.0 * kPi / kSteps * cosine * (1.0 - fresnel_at(cosine)) *
                  std::exp(-kDeep / bent_cosine(cosine) * extinction_of(world::block::kWater)[c]);
    }
    EXPECT_NEAR(seen[c], expected, 0.01 * expected);
  }
}

TEST(ReferenceUnderWater, NothingIsLostOfLightThatIsMirroredBack) {
  // Clear water would be a furnace. This one absorbs, but a place just under its surface sees, up
  // to a hundredth, all of a sky that is everywhere.
  Scene scene;
  scene.islands = {lake()};
  scene.environment = glm::dvec3(1.0);
  scene.bounces = 1;
  const glm::dvec3 seen = irradiance_at(scene, {0.5, -1e-3, 0.5}, {0.0, 1.0, 0.0}, 1u << 14);
  double expected = 0.0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    expected += 2.0 * kPi / kSteps * cosine * (1.0 - fresnel_at(cosine));
  }
  EXPECT_GE(seen.z, 0.99 * expected);
  EXPECT_LE(seen.z, kPi);
}

/// Radiance that a wide bed under so much optical depth sends up, within the water, if radiance 1
/// comes from all of the sky. The surface mirrors a part back to it, again and again.
double sent_by_bed(double albedo, double depth) {
  return albedo * water_laws::comes_down(depth) / (1.0 - albedo * water_laws::mirrored_back(depth));
}

/// Level water one block deep over a bed that swallows nothing, seen from eight blocks above it.
Scene white_pool() {
  const Island pool{world::Volume::from_voxels({-60, -3, -60}, {61, 0, 61}, [](world::IVec3 v) {
    return world::BlockId{v.y < -1 ? world::block::kStone : world::block::kWater};
  })};
  Scene scene = seen_from({0.5, 8.0, 0.5}, {0.0, -1.0, 0.0}, {pool}, 16, 0.2);
  scene.environment = glm::dvec3(1.0);
  scene.bounces = 64;
  return scene;
}

TEST(ReferenceUnderWater, WhatHangsOverAWhitePoolHasWhatThePoolSendsBack) {
  const glm::dvec3 seen =
      irradiance_at(white_pool(), {0.0, -6.0, 0.0}, {0.0, -1.0, 0.0}, 1u << 16) / kPi;
  for (int c = 0; c < 3; ++c) {
    const double depth = extinction_of(world::block::kWater)[c];
    const double sent = sent_by_bed(1.0, depth) / (kIndex * kIndex);
    const double expected = over_hemisphere([&](double cosine) {
      const double mirrored = fresnel_at(cosine);
      return mirrored + (1.0 - mirrored) * std::exp(-depth / bent_cosine(cosine)) * sent;
    });
    EXPECT_LT(expected, 1.0);
    EXPECT_NEAR(seen[c], expected, 0.01 * expected) << c;
  }
}

TEST(ReferenceUnderWater, AnEyeAboveAWhitePoolSeesNoMoreThanFallsOnIt) {
  const ReferencePicture picture = render(white_pool(), samples(256));
  glm::dvec3 seen(0.0);
  for (const auto& pixel : picture.radiance.pixels)
    seen += glm::dvec3(pixel.x, pixel.y, pixel.z) / double(picture.radiance.pixels.size());
  for (int c = 0; c < 3; ++c) {
    const double depth = extinction_of(world::block::kWater)[c], mirrored = fresnel_at(1.0);
    const double left = std::exp(-depth);
    const double scattered =
        static_cast<double>(world::block_types()[world::block::kWater].scattering) / depth *
        (1.0 - left) / 4.0;
    const double expected = mirrored + (1.0 - mirrored) / (kIndex * kIndex) *
                                           (left * sent_by_bed(1.0, depth) + scattered);
    EXPECT_NEAR(seen[c], expected, 0.015 * expected) << c;
  }
}

TEST(ReferenceUnderWater, WaterBetweenPanesLeavesRadianceAsItWas) {
  // Along x, through the middle of blocks: a pane, water and a pane again.
  const Island tank{world::Volume::from_voxels({0, 0, 0}, {3, 3, 3}, [](world::IVec3 v) {
    return world::BlockId{v.x == 1 ? world::block::kWater : world::block::kGlass};
  })};
  Scene scene = seen_from({-4.0, 1.5, 1.5}, {1.0, 0.0, 0.0}, {tank}, 4, 0.005);
  scene.environment = glm::dvec3(1.0);
  const ReferencePicture picture = render(scene, samples(16));
  // What each surface mirrors of what is as bright as what lies behind it changes nothing.
  for (const auto& pixel : picture.radiance.pixels)
    for (int c = 0; c < 3; ++c) {
      const double left = std::exp(-2.0 * extinction_of(world::block::kGlass)[c] -
                                   extinction_of(world::block::kWater)[c]);
      EXPECT_GT(static_cast<double>(pixel[c]), 0.9 * left) << c;
      EXPECT_LT(static_cast<double>(pixel[c]), 1.1 * left) << c;
    }
}

TEST(ReferenceUnderWater, GlassColoursTheSun) {
  // A pane three blocks thick over ground.
  Scene scene;
  scene.islands = {{world::Volume::from_voxels({-9, -1, -9}, {10, 8, 10}, [](world::IVec3 v) {
    if (v.y < 0) return world::BlockId{world::block::kStone};
    return world::BlockId{v.y >= 4 && v.y < 7 ? world::block::kGlass : world::block::kAirBlock};
  })}};
  for (const double degrees : {0.0, 40.0}) {
    const double angle = degrees * kPi / 180.0, cosine = std::cos(angle);
    scene.bodies = {{{std::sin(angle), cosine, 0.0}, glm::dvec3(1.0), 0.0}};
    const glm::dvec3 seen = irradiance_at(scene, {0.5, 1e-6, 0.5}, {0.0, 1.0, 0.0}, 1);
    for (int c = 0; c < 3; ++c) {
      const double thick = 3.0 / cosine * extinction_of(world::block::kGlass)[c];
      EXPECT_NEAR(seen[c], cosine * std::exp(-thick), 1e-6);
    }
  }
}

TEST(ReferenceUnderWater, AShadowFallsWhereTheBentLightIsMissing) {
  // A roof ten blocks above the water ends at x = 0; the sun stands at 60 degrees to the zenith, at
  // negative x. Under the roof's edge light goes through the surface at x = 10 tan 60.
  Scene scene;
  scene.islands = {{world::Volume::from_voxels({-60, -6, -20}, {61, 12, 21}, [](world::IVec3 v) {
    if (v.y < -kDeep) return world::BlockId{world::block::kStone};
    if (v.y < 0) return world::BlockId{world::block::kWater};
    return world::BlockId{v.y == 10 && v.x < 0 ? world::block::kStone : world::block::kAirBlock};
  })}};
  const double angle = kPi / 3.0;
  scene.bodies = {{{-std::sin(angle), std::cos(angle), 0.0}, glm::dvec3(1.0), 0.0}};
  const double edge =
      11.0 * std::tan(angle) + kDeep * std::tan(std::asin(std::sin(angle) / kIndex));
  for (const double off : {-0.5, -0.05, 0.05, 0.5}) {
    const glm::dvec3 seen = irradiance_at(scene, {edge + off, kBed.y, 0.5}, {0.0, 1.0, 0.0}, 1);
    EXPECT_EQ(seen.z > 0.0, off > 0.0) << off;
  }
}

/// What an eye in water sees of a ceiling of lamps, by Snell's law at the rippled surface.
TEST(ReferenceUnderWater, AnEyeSeesTheWorldAboveWithinSnellsWindow) {
  constexpr double kDepth = 2.5, kHeight = 12.0, kEnd = -9.3;  // of the ceiling: above water, and x
  constexpr glm::dvec3 kEye{0.2, -kDepth, 0.3};
  const Island ceiling{
      world::Volume::from_voxels({0, 0, 0}, {200, 1, 400},
                                 [](world::IVec3) { return world::BlockId{world::block::kLamp}; }),
      glm::dmat3(1.0),
      {kEnd - 200.0, kHeight, -200.0}};
  Scene scene = seen_from(kEye, {-1.0, 1.0, 0.0}, {lake(), ceiling}, 48, 0.8);
  scene.albedo.reset();
  scene.view.medium = world::block::kWater;
  ReferenceSettings settings = samples(4);
  settings.filter = game::ReferenceFilter::kCentre;
  const ReferencePicture picture = render(scene, settings);
  int lamps = 0, dark = 0;
  for (std::uint32_t y = 0; y < 48; ++y) {
    for (std::uint32_t x = 0; x < 48; ++x) {
      const glm::dvec3 ray =
          glm::normalize(scene.view.forward + scene.view.right * (((x + 0.5) / 24.0 - 1.0) * 0.8) +
                         scene.view.up * ((1.0 - (y + 0.5) / 24.0) * 0.8));
      if (ray.y <= 0.0) continue;
      const double way = kDepth / ray.y;
      const glm::dvec3 place = kEye + way * ray;
      const Meeting surface{.t = way, .face = 2, .voxel = {}, .lattice = place};
      const glm::dvec3 bent = glm::refract(ray, -ripples_of(surface, 0.0), kIndex);
      if (bent != glm::dvec3(0.0) && bent.y < 0.1) continue;
      // Where it is at the lamps' upper side: those at the end are seen from the side, too.
      const double meets = place.x + bent.x / std::max(bent.y, 0.1) * (kHeight + 1.0);
      if (std::abs(meets - kEnd) < 1e-3) continue;
      const bool lit = bent != glm::dvec3(0.0) && meets < kEnd;
      EXPECT_EQ(picture.radiance.pixels[y * 48 + x].z > 0.0f, lit) << x << ", " << y;
      ++(lit ? lamps : dark);
    }
  }
  EXPECT_GT(lamps, 200);
  EXPECT_GT(dark, 400);
}

}  // namespace
}  // namespace skerry::reference
