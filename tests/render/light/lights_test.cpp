#include "engine/render/light/lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

namespace skerry::render {
namespace {

shared::Light spot() {
  shared::Light light{};
  light.position = {1.0f, 2.0f, 3.0f};
  light.range = 10.0f;
  light.intensity = {3.0f, 2.0f, 1.0f};
  light.kind = shared::kLightSpot;
  light.axis = {0.0f, -4.0f, 3.0f};
  light.cos_inner = 0.9f;
  light.cos_outer = 0.7f;
  light.first_island = 5;
  light.island_count = 2;
  return light;
}

TEST(Lights, AGoodLightIsTakenAsItIsWithItsAxisMadeUnit) {
  const Result<shared::Light> taken = checked_light(spot());
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->position, spot().position);
  EXPECT_EQ(taken->range, 10.0f);
  EXPECT_EQ(taken->intensity, spot().intensity);
  EXPECT_EQ(taken->axis, glm::vec3(0.0f, -0.8f, 0.6f));
  EXPECT_EQ(taken->cos_inner, 0.9f);
  EXPECT_EQ(taken->cos_outer, 0.7f);
  EXPECT_EQ(taken->first_island, 5u);
  EXPECT_EQ(taken->island_count, 2u);
}

TEST(Lights, EveryBadValueIsRefusedInOneLineThatNamesIt) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  using Break = std::function<void(shared::Light&, float)>;
  const std::pair<const char*, Break> fields[] = {
      {"position x", [](shared::Light& l, float v) { l.position.x = v; }},
      {"position y", [](shared::Light& l, float v) { l.position.y = v; }},
      {"position z", [](shared::Light& l, float v) { l.position.z = v; }},
      {"range", [](shared::Light& l, float v) { l.range = v; }},
      {"red", [](shared::Light& l, float v) { l.intensity.x = v; }},
      {"green", [](shared::Light& l, float v) { l.intensity.y = v; }},
      {"blue", [](shared::Light& l, float v) { l.intensity.z = v; }},
      {"axis", [](shared::Light& l, float v) { l.axis.x = v; }},
      {"cos_inner", [](shared::Light& l, float v) { l.cos_inner = v; }},
      {"cos_outer", [](shared::Light& l, float v) { l.cos_outer = v; }},
  };
  for (const auto& [name, break_it] : fields) {
    for (const float value : {nan, inf, -inf}) {
      shared::Light light = spot();
      break_it(light, value);
      const Result<shared::Light> taken = checked_light(light);
      ASSERT_FALSE(taken) << name << " " << value;
      EXPECT_NE(taken.error().message.find(name), std::string::npos) << taken.error().message;
      EXPECT_EQ(taken.error().message.find('\n'), std::string::npos);
    }
  }
}

TEST(Lights, WhatCannotBeIsRefused) {
  const auto refused = [](auto&& change) {
    shared::Light light = spot();
    change(light);
    return !checked_light(light);
  };
  EXPECT_FALSE(refused([](shared::Light&) {}));
  EXPECT_TRUE(refused([](shared::Light& l) { l.range = 0.0f; }));
  EXPECT_TRUE(refused([](shared::Light& l) { l.range = -1.0f; }));
  EXPECT_TRUE(refused([](shared::Light& l) { l.range = 2.0f * kMaxLightRange; }));
  EXPECT_TRUE(refused([](shared::Light& l) { l.intensity.y = -0.001f; }));
  EXPECT_TRUE(refused([](shared::Light& l) { l.intensity.y = 2.0f * kMaxLightIntensity; }));
  EXPECT_TRUE(refused([](shared::Light& l) { l.axis = glm::vec3(0.0f); }));
  EXPECT_TRUE(refused([](shared::Light& l) { std::swap(l.cos_inner, l.cos_outer); }));
  EXPECT_TRUE(refused([](shared::Light& l) { l.kind = shared::kLightKindCount; }));
  EXPECT_TRUE(refused([](shared::Light& l) { l.kind = 1u << 20; }));
  EXPECT_TRUE(
      refused([](shared::Light& l) { l.kind = shared::kLightPoint | shared::kLightDualBit; }));
  EXPECT_TRUE(refused([](shared::Light& l) {
    l.kind = shared::kLightTube;
    l.size = -1.0f;
  }));
}

TEST(Lights, FieldsThatAKindDoesNotUseMayHoldAnything) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  shared::Light light = spot();
  light.kind = shared::kLightPoint;
  light.axis = glm::vec3(nan);
  light.size = nan;
  light.cos_inner = light.cos_outer = nan;
  const Result<shared::Light> taken = checked_light(light);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->axis, glm::vec3(0.0f));
  EXPECT_EQ(taken->size, 0.0f);
  light = spot();
  light.kind = shared::kLightDirectional;
  light.position = glm::vec3(nan);
  EXPECT_TRUE(checked_light(light));
}

TEST(Lights, AConeWithoutASoftEdgeGetsOne) {
  for (const float cosine : {-1.0f, 0.0f, 0.5f, 1.0f}) {
    shared::Light light = spot();
    light.cos_inner = light.cos_outer = cosine;
    const Result<shared::Light> taken = checked_light(light);
    ASSERT_TRUE(taken);
    EXPECT_GT(taken->cos_inner, taken->cos_outer);
    EXPECT_NEAR(taken->cos_inner, cosine, 2e-4);
    EXPECT_LE(taken->cos_inner, 1.0f);
  }
}

TEST(Lights, TheSmallestAndTheLargestAxisBecomeUnit) {
  for (const float length : {1e-30f, 1e-10f, 1.0f, 1e30f}) {
    shared::Light light = spot();
    light.axis = glm::vec3(length);
    const Result<shared::Light> taken = checked_light(light);
    ASSERT_TRUE(taken) << length;
    EXPECT_NEAR(glm::length(taken->axis), 1.0f, 1e-6f);
  }
}

}  // namespace
}  // namespace skerry::render
