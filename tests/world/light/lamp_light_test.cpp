// Light that is kept by numbers of voxels, beside a map.
#include "world/light/lamp_light.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

namespace skerry::world {
namespace {

LampLight even(float value) {
  LampLight out;
  out.faces.fill(glm::vec3(value));
  for (auto& corners : out.corners) corners.fill(2.0f * value);
  return out;
}

TEST(LampLightMap, HoldsWhatAMapDoesAfterAnyChanges) {
  std::mt19937 random(5);
  const auto below = [&](std::size_t n) { return random() % n; };
  LampLightMap lights;
  std::map<std::size_t, LampLight> model;
  constexpr std::size_t kNumbers = 200;
  for (int i = 0; i < 20'000; ++i) {
    const std::size_t number = below(kNumbers), other = below(kNumbers);
    const LampLight light = even(static_cast<float>(below(4)));
    switch (below(3)) {
      case 0: {
        const LampLight before = model.contains(number) ? model[number] : LampLight{};
        EXPECT_EQ(lights.set(number, light), before != light);
        if (is_dark(light))
          model.erase(number);
        else
          model[number] = light;
        break;
      }
      case 1:
        lights.add(number, light);
        if (!is_dark(light) || model.contains(number)) model[number] += light;
        break;
      default:
        if (model.contains(other)) break;
        lights.move(number, other);
        if (auto node = model.extract(number)) {
          node.key() = other;
          model.insert(std::move(node));
        }
    }
    const LampLight* found = lights.find(number);
    ASSERT_EQ(found != nullptr, model.contains(number)) << "step " << i;
    if (found != nullptr) {
      ASSERT_EQ(*found, model[number]) << "step " << i;
    }
  }
  std::map<std::size_t, LampLight> all;
  lights.for_each([&](std::size_t number, const LampLight& light) { all[number] = light; });
  EXPECT_EQ(all, model);
  EXPECT_FALSE(all.empty());
  // Places that are free are taken again: no more lights than there were at once, and numbers.
  EXPECT_LE(lights.bytes(), kNumbers * (sizeof(LampLight) + 2 * sizeof(std::uint32_t)));
  EXPECT_EQ(lights.find(1'000'000), nullptr);
}

}  // namespace
}  // namespace skerry::world
