#include "game/view/held_torch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "world/voxel/blocks.h"

namespace skerry::game {
namespace {

TEST(HeldTorch, FlickersSmoothlyWithinItsBoundsAboutItsMean) {
  double sum = 0.0, least = 2.0, most = 0.0, last = torch_flicker(0.0);
  constexpr int kSteps = 200'000;
  for (int i = 1; i <= kSteps; ++i) {
    const double now = torch_flicker(i * 1e-3);
    EXPECT_LE(std::abs(now - 1.0), kTorchFlicker);
    // The steepest smoothstep: 1.5 times the step between -1 and 1, at the rates of the noise.
    EXPECT_LE(std::abs(now - last), 1e-3 * 3.0 * kTorchFlicker * (5.0 * 2.0 + 11.0) / 3.0 + 1e-12);
    sum += now;
    least = std::min(least, now);
    most = std::max(most, now);
    last = now;
  }
  EXPECT_NEAR(sum / kSteps, 1.0, 0.005);
  EXPECT_LT(least, 1.0 - 0.7 * kTorchFlicker);
  EXPECT_GT(most, 1.0 + 0.7 * kTorchFlicker);
}

TEST(HeldTorch, FlickersAsAFunctionOfTheTimeAlone) {
  const double before = torch_flicker(12.34);
  for (const double time : {0.0, -1e9, 1e9, 7.5}) EXPECT_TRUE(std::isfinite(torch_flicker(time)));
  EXPECT_EQ(torch_flicker(12.34), before);
  EXPECT_NE(torch_flicker(12.44), before);
}

TEST(HeldTorch, StaysInTheHandAndCloserToTheEyeThanWallsCome) {
  const BlockEmission torch = emission_table()[world::block::kTorch];
  for (double yaw = -180.0; yaw <= 180.0; yaw += 15.0) {
    const shared::Light light = held_torch(torch, yaw, 3.0);
    EXPECT_LT(std::hypot(light.position.x, light.position.z), 0.3f);  // half of a player's width
    EXPECT_LT(light.position.y, 0.0f);
    // On the right: left of the way forward is where growing yaw turns to.
    const float radians = static_cast<float>(yaw * 3.14159265358979 / 180.0);
    const glm::vec3 right{-std::cos(radians), 0.0f, std::sin(radians)};
    EXPECT_GT(glm::dot(light.position, right), 0.1f);
    const double strength = light.intensity.x / torch.face_intensity.x;
    EXPECT_NEAR(strength, torch_flicker(3.0), 1e-6);
    EXPECT_EQ(light.range, light_range(torch.face_intensity));
  }
}

}  // namespace
}  // namespace skerry::game
