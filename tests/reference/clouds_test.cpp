// The reference's clouds against closed forms and finer sums.
#include "tools/reference/clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/reference/made_scenes.h"

namespace skerry::reference {
namespace {

constexpr int kEdge = 16;

/// A box of samples of 1.
CloudGrid even_box(glm::dvec3 corner, glm::dvec3 extent, double extinction) {
  CloudGrid grid;
  const glm::dvec3 voxel = extent / static_cast<double>(kEdge);
  grid.index_from_world = glm::inverse(glm::scale(glm::translate(glm::dmat4(1.0), corner), voxel));
  grid.size = glm::ivec3(kEdge);
  grid.samples.assign(static_cast<std::size_t>(kEdge * kEdge * kEdge), 1.0f);
  grid.extinction = extinction;
  grid.step = 0.5 * std::min({voxel.x, voxel.y, voxel.z});
  return grid;
}

TEST(ReferenceClouds, CellsOfTheLayerThatAreEmptyHoldNothing) {
  std::mt19937 random(5);
  const auto in = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  int empty = 0, full = 0;
  for (int i = 0; i < 4000; ++i) {
    const CloudLayer layer{{in(0, 10240), in(-500, 500), in(0, 10240)}, in(20, 400), 0.1, in(0, 1)};
    const glm::dvec3 p(in(-8000, 8000), in(0, layer.thickness) - layer.eye.y, in(-8000, 8000));
    const glm::dvec3 direction = random_direction(random);
    const CloudLayer::Cell cell = layer.cell_at(p, direction);
    ASSERT_GE(cell.way, 0.0);
    ASSERT_LE(cell.way, 64.0 * std::sqrt(3.0));
    full += layer.extinction_at(p) > 0.0;
    if (!cell.empty) continue;
    ++empty;
    for (double share = 0.0; share < 1.0; share += 0.05)
      ASSERT_EQ(layer.extinction_at(p + direction * (share * cell.way)), 0.0) << i;
  }
  EXPECT_GT(empty, 400);
  EXPECT_GT(full, 200);
}

TEST(ReferenceClouds, ALampBesideTheViewLightsThinFogAsItsIntegralHasIt) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {}, 12, 0.2);
  constexpr double kDensity = 1e-4;
  scene.clouds.grids = {even_box({-30.0, -30.0, 5.0}, {60.0, 60.0, 60.0}, kDensity)};
  Light lamp;
  lamp.position = {1.5, 0.5, 35.0};
  lamp.intensity = glm::dvec3(1.0);
  scene.lights = {lamp};
  const ReferencePicture picture = render(scene, samples(256));
  const View& view = scene.view;
  for (std::uint32_t i = 0; i < view.width * view.height; ++i) {
    double sum = 0.0;
    constexpr int kParts = 4;  // of a pixel, each way
    for (int part = 0; part < kParts * kParts; ++part) {
      const double x = (i % view.width + (part % kParts + 0.5) / kParts) / view.width * 2.0 - 1.0;
      const double y = (i / view.width + (part / kParts + 0.5) / kParts) / view.height * 2.0 - 1.0;
      const glm::dvec3 dir =
          glm::normalize(view.forward + (view.right * x - view.up * y) * view.tan_half_y);
      for (double t = 0.005; t < 80.0; t += 0.01) {
        const glm::dvec3 way = lamp.position - dir * t;
        const double distance = glm::length(way);
        sum += 0.01 * scene.clouds.grids[0].value_at(dir * t) * kDensity *
               scattered_share(glm::dot(dir, way) / distance, 0.0) /
               std::pow(std::max(distance, 0.3), 2.0);
      }
    }
    const double expected = sum / (kParts * kParts);
    EXPECT_NEAR(picture.radiance.pixels[i].x, expected, 0.12 * expected) << i;
  }
}

TEST(ReferenceClouds, WaterMirrorsWhatCloudsLeaveOfTheLightBehindThem) {
  const Island pond{world::Volume::from_voxels({-40, -3, -40}, {40, 0, 40}, [](world::IVec3) {
    return world::BlockId{world::block::kWater};
  })};
  Scene scene = seen_from({0.0, 5.0, 0.0}, {0.0, -1.0, 1.0}, {pond}, 6, 0.1);
  scene.environment = glm::dvec3(1.0);
  const auto mean = [&](double extinction) {
    scene.clouds.grids.clear();
    // Over the pond, and behind it as the eye sees it: only mirrored rays meet it.
    if (extinction > 0.0)
      scene.clouds.grids = {even_box({-50.0, 20.0, -20.0}, {100.0, 10.0, 100.0}, extinction)};
    double sum = 0.0;
    for (const glm::vec3& pixel : render(scene, samples(64)).radiance.pixels)
      sum += static_cast<double>(pixel.x);
    return sum;
  };
  const double clear = mean(0.0), hidden = mean(100.0), thin = mean(0.05);
  ASSERT_LT(hidden, clear);
  // Ten blocks at about 45 degrees.
  const double left = std::exp(-0.05 * 10.0 * std::sqrt(2.0));
  EXPECT_NEAR((thin - hidden) / (clear - hidden), left, 0.03);
}

}  // namespace
}  // namespace skerry::reference
