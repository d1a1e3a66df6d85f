// Air before water and glass, and between them, against Beer's law.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/exponential.hpp>

#include "tests/reference/made_scenes.h"
#include "tests/render/extinction.h"
#include "tools/reference/textures.h"

namespace skerry::reference {
namespace {

constexpr double kHaze = 0.0005, kToPane = 10.0, kToWater = 2'000.0;
constexpr glm::dvec3 kSky{0.7, 0.9, 1.0};
constexpr double kInTexel = 16.5 / 32.0;

/// Small enough that it lights nothing, and deep enough that nothing is seen through it.
Island far_water() {
  return {
      world::Volume::from_voxels({0, 0, 0}, {3, 3, 2000},
                                 [](world::IVec3) { return world::BlockId{world::block::kWater}; }),
      glm::dmat3(1.0),
      {-1.5, -1.5, kToWater}};
}
Island red_pane() {
  return {world::Volume::from_voxels(
              {0, 0, 0}, {1, 1, 1},
              [](world::IVec3) { return world::BlockId{world::block::kRedGlass}; }),
          glm::dmat3(1.0),
          {-kInTexel, -kInTexel, kToPane}};
}

/// One pixel in the middle, under an even sky that lights air and surfaces.
glm::dvec3 seen(std::vector<Island> islands, double haze) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, std::move(islands), 1, 1e-4);
  scene.environment = kSky;
  scene.bodies = {{{0.0, 1.0, 0.0}, glm::dvec3(0.0), 0.0}};
  scene.shadows = false;  // so that it is in all of the air
  scene.haze_per_block = haze;
  return render(scene, samples(1024)).radiance.pixels[0];
}

TEST(ReferenceHazyMedia, AirBetweenAPaneAndWaterIsColouredByThePane) {
  const glm::dvec4 texel =
      BlockTexels::shared().texel(world::block::kRedGlass, 5, {kInTexel, kInTexel, 0.0});
  constexpr double kReflected = (0.333 / 2.333) * (0.333 / 2.333);
  const glm::dvec3 through = std::pow((1.0 - kReflected) * (1.0 - texel.w), 2.0) *
                             glm::exp(-render::extinction_of(world::block::kRedGlass));
  EXPECT_GT(through.x, 5.0 * through.y);
  const glm::dvec3 pane = seen({red_pane()}, 0.0) - through * kSky;
  const glm::dvec3 water = seen({red_pane(), far_water()}, 0.0) - pane;
  const double near = std::exp(-kHaze * kToPane), far = std::exp(-kHaze * kToWater);
  const glm::dvec3 expected = near * pane + far * water + through * (1.0 - far) * kSky +
                              (1.0 - through) * (1.0 - near) * kSky;
  const glm::dvec3 hazy = seen({red_pane(), far_water()}, kHaze);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(hazy[c], expected[c], 1e-3) << c;
  EXPECT_GT(hazy.x, 0.2);
}

}  // namespace
}  // namespace skerry::reference
