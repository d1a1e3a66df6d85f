#include "game/view/light_chunk.h"

#include <gtest/gtest.h>

namespace skerry::game {
namespace {

// What is kept with the faces at full detail is at coarse levels, too, as one of so many voxels.
TEST(LightChunk, ABlockIsAWeakLampAtAllLevelsOrAtNone) {
  const LightField field;
  const std::vector<world::Emitter> plants{{glm::vec3(8.5f), world::block::kGlowShroom, 1, false},
                                           {glm::vec3(40.5f), world::block::kGlowFern, 1, false}};
  const std::vector<world::Emitter> torch{{glm::vec3(8.5f), world::block::kTorch, 1, false}};
  std::vector<LatticeLight> fine = field.lights_of({1, {0, 0, 0}, 0}, plants);
  const std::vector<world::WeakLamp> near = take_weak(fine, 0);
  ASSERT_EQ(near.size(), plants.size());
  for (int level = 0; level < world::kLevelCount; ++level) {
    std::vector<LatticeLight> lights = field.lights_of({1, {0, 0, 0}, level}, plants);
    const std::vector<world::WeakLamp> weak = take_weak(lights, level);
    EXPECT_TRUE(lights.empty()) << level;
    ASSERT_EQ(weak.size(), near.size()) << level;
    for (std::size_t i = 0; i < weak.size(); ++i) {
      EXPECT_NEAR(glm::length(weak[i].place - near[i].place), 0.0f, 1e-4f);
      EXPECT_NEAR(glm::length(weak[i].intensity - near[i].intensity), 0.0f, 1e-5f);
      EXPECT_NEAR(weak[i].range, near[i].range, 1e-3f);
    }
    lights = field.lights_of({1, {0, 0, 0}, level}, torch);
    EXPECT_TRUE(take_weak(lights, level).empty()) << level;
    EXPECT_EQ(lights.size(), 1u) << level;
  }
}

}  // namespace
}  // namespace skerry::game
