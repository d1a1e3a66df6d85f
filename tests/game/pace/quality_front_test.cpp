#include "game/pace/quality_front.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "game/scene_file/options.h"
#include "game/scene_file/setting_keys.h"
#include "tools/skerry/report/report_session.h"
#include "tools/skerry/report/topics.h"

namespace skerry::game {
namespace {

TEST(QualityFront, ErrorsFallAndTimesRiseFromEachPointToTheNext) {
  const auto front = quality_front();
  std::set<std::string> labels;
  for (std::size_t i = 0; i < front.size(); ++i) {
    EXPECT_TRUE(labels.insert(label_of(front[i])).second) << label_of(front[i]);
    if (i == 0) continue;
    EXPECT_LT(front[i].error, front[i - 1].error) << label_of(front[i]);
    EXPECT_GT(front[i].prior_ms, front[i - 1].prior_ms) << label_of(front[i]);
  }
}

TEST(QualityFront, EveryErrorIsOfAPointOfTheReport) {
  for (const MeasuredError& error : measured_errors()) {
    const tools::Topic* topic = tools::find_topic(error.topic);
    ASSERT_NE(topic, nullptr) << error.topic;
    const auto same = [&](const tools::TopicPoint& point) { return point.label == error.point; };
    EXPECT_TRUE(std::any_of(topic->points.begin(), topic->points.end(), same))
        << error.topic << " " << error.point;
  }
}

TEST(QualityFront, APointSetsItsKeysAndNoOthers) {
  for (const FrontPoint& point : quality_front()) {
    Settings settings;
    settings.render.ao_strength = 0.25f;
    settings.render.shading_rate = 2;
    settings.render.render_scale = 0.9f;
    const Settings before = settings;
    apply_front_point(point, {}, settings);
    EXPECT_EQ(settings.render.render_scale, point.render_scale);
    EXPECT_EQ(settings.render.shading_rate, point.shading_rate);
    EXPECT_EQ(settings.view_distance, quality_level(point.level).view_distance);
    for (const SettingKey& key : setting_keys()) {
      if (!is_chosen_by_front(key.key)) {
        EXPECT_EQ(key.print(settings), key.print(before)) << key.key;
      }
    }
  }
}

TEST(QualityFront, WhatIsPinnedStays) {
  const std::vector<std::string> pinned{"view.distance=123", "render.scale=0.6"};
  for (const FrontPoint& point : quality_front()) {
    Settings settings;
    apply_front_point(point, pinned, settings);
    EXPECT_EQ(settings.view_distance, 123u);
    EXPECT_EQ(settings.render.render_scale, 0.6f);
    EXPECT_EQ(settings.render.shading_rate, point.shading_rate);
  }
}

TEST(QualityFront, OtherCommandsHaveNoLevelAuto) {
  SceneText text;
  text.quality = "auto";
  const auto made = make_scene(text, {});
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("low"), std::string::npos) << made.error().message;
}

}  // namespace
}  // namespace skerry::game
