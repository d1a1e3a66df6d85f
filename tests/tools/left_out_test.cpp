// What a scene lacks costs as little as what the renderer does not have.
#include "tools/skerry/scene/left_out.h"

#include <gtest/gtest.h>

#include "tests/gpu/test_device.h"

namespace skerry::tools {
namespace {

class LeftOutOnGpu : public gpu::GpuTest {
 protected:
  LeftOutOnGpu() : GpuTest(gpu::Checks::kAllInLongRuns) {}
};

TEST_F(LeftOutOnGpu, AFeatureThatASceneLacksIsAskedNothingFor) {
  const Result<std::vector<LackingScene>> scenes = lacking_scenes();
  ASSERT_TRUE(scenes) << scenes.error().message;
  std::size_t features = 0;
  const auto light = std::make_shared<world::LightCache>(game::SceneCache::kLightBytes);
  for (const LackingScene& lacking : *scenes) {
    const Result<LeftOutRow> row = measure_left_out(device(), lacking, 0, light);
    ASSERT_TRUE(row) << lacking.feature << ": " << row.error().message;
    EXPECT_FALSE(row->why.empty()) << "the scene has " << lacking.feature;
    EXPECT_NE(row->why, "named in leave.out");
    EXPECT_TRUE(row->same_picture) << lacking.feature;
    const auto [a, b] = std::pair(row->as_is, row->without);
    EXPECT_EQ(a.counts, b.counts) << lacking.feature;
    EXPECT_EQ(a.pipelines_created, b.pipelines_created) << lacking.feature;
    EXPECT_EQ(a.memory_bytes, b.memory_bytes) << lacking.feature;
    EXPECT_TRUE(row->same_counts());
    EXPECT_GT(a.counts.dispatches, 0u);
    features += lacking.setting.starts_with("leave.out") ? 1 : 0;
  }
  EXPECT_EQ(features, render::kFeatureNames.size()) << "every feature has a scene without it";
}

// The check itself can fail: leaving out what a scene has changes picture and counts.
TEST_F(LeftOutOnGpu, WhatASceneHasIsMissedWhenLeftOut) {
  const Result<std::vector<LackingScene>> scenes = lacking_scenes();
  ASSERT_TRUE(scenes);
  LackingScene noon = scenes->at(1);
  ASSERT_EQ(noon.feature, "moon");
  noon.feature = "sun";
  noon.setting = "leave.out=sun";
  const auto light = std::make_shared<world::LightCache>(game::SceneCache::kLightBytes);
  const Result<LeftOutRow> row = measure_left_out(device(), noon, 1, light);
  ASSERT_TRUE(row) << row.error().message;
  EXPECT_TRUE(row->why.empty());
  EXPECT_FALSE(row->same_picture);
  EXPECT_GT(row->as_is.counts.draws, row->without.counts.draws);
  EXPECT_GT(row->as_is.memory_bytes, row->without.memory_bytes) << "shadow maps";
  EXPECT_FALSE(row->same_counts());
  EXPECT_GT(row->as_is.ms, 0.0);
}

}  // namespace
}  // namespace skerry::tools
