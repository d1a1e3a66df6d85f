#include "tools/skerry/report/topics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "game/scene_file/options.h"
#include "tools/skerry/report/report_session.h"

namespace skerry::tools {
namespace {

TEST(Topics, NamesAreWordsAndOnce) {
  std::set<std::string_view> names;
  for (const Topic& topic : topics()) {
    EXPECT_TRUE(names.insert(topic.name).second) << topic.name;
    EXPECT_EQ(find_topic(topic.name), &topic);
    EXPECT_EQ(topic.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789"),
              std::string_view::npos)
        << topic.name;
  }
  EXPECT_EQ(find_topic("shadow"), nullptr);
}

TEST(Topics, ScenesCanBeMade) {
  for (const ReportScene& scene : report_scenes()) {
    const auto text = game::parse_scene(scene.json);
    ASSERT_TRUE(text) << scene.name << ": " << text.error().message;
    EXPECT_TRUE(game::make_scene(*text, {})) << scene.name;
    EXPECT_EQ(find_report_scene(scene.name), &scene);
  }
  for (const Topic& topic : topics()) {
    EXPECT_FALSE(topic.scenes.empty()) << topic.name;
    for (const std::string_view scene : topic.scenes)
      EXPECT_NE(find_report_scene(scene), nullptr) << topic.name << ": " << scene;
  }
}

TEST(Topics, PointsSetWhatTheySay) {
  for (const Topic& topic : topics()) {
    EXPECT_GE(topic.points.size(), 2u) << topic.name;
    std::set<std::string_view> labels;
    for (const TopicPoint& point : topic.points) {
      game::Settings settings;
      const auto applied = apply_point(point.settings, settings);
      EXPECT_TRUE(applied) << topic.name << ": " << applied.error().message;
      EXPECT_TRUE(labels.insert(point.label).second) << topic.name << ": " << point.label;
    }
    if (topic.reference_settings.empty()) continue;
    game::Settings settings;
    EXPECT_TRUE(apply_point(topic.reference_settings, settings)) << topic.name;
  }
}

TEST(Topics, EveryQualityLevelsDefaultIsOnePointOfEverySweep) {
  for (const Topic& topic : topics()) {
    std::multiset<std::string> levels;
    for (const TopicPoint& point : topic.points)
      for (const std::string& level : levels_with_default(point)) levels.insert(level);
    EXPECT_EQ(levels, (std::multiset<std::string>{"high", "low", "medium", "ultra"})) << topic.name;
  }
}

}  // namespace
}  // namespace skerry::tools
