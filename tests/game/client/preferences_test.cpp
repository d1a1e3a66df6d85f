#include "game/client/preferences.h"

#include <gtest/gtest.h>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"

namespace skerry::game {
namespace {

TEST(Preferences, ComeBackFromAFile) {
  const Folder folder;
  SceneOptions scene;
  scene.quality = Quality::kHigh;
  scene.settings = settings_of(Quality::kHigh);
  scene.settings.view_distance = 444;
  scene.settings.render.display.black = 0.05f;
  scene.settings.world_offset[0] = 7;  // of a scene, not of a player
  scene.settings.ui.scale = 1.25f;
  scene.settings.play = {true, true, false};
  scene.fov_deg = 85.0;
  ASSERT_TRUE(save_preferences(folder / "settings.json", scene));
  const ReadPreferences read = load_preferences(folder / "settings.json");
  EXPECT_TRUE(read.problems.empty());
  const Result<SceneOptions> made = make_scene(read.scene, {});
  ASSERT_TRUE(made);
  EXPECT_EQ(made->quality, Quality::kHigh);
  EXPECT_EQ(made->fov_deg, 85.0);
  scene.settings.world_offset[0] = 0;
  EXPECT_EQ(made->settings, scene.settings);
}

TEST(Preferences, AChosenQualityKeepsWhatIsPinnedAndNotWhatWasChosen) {
  SceneOptions scene;
  scene.quality = Quality::kHigh;
  scene.settings = settings_of(Quality::kHigh);
  scene.settings.render.render_scale = 0.5f;
  scene.settings.view_distance = 444;
  scene.settings.frames.cap = 50;
  scene.quality_auto = true;
  scene.pinned = {"view.distance=444"};
  const ReadPreferences read = read_preferences(print_preferences(scene));
  EXPECT_TRUE(read.problems.empty());
  EXPECT_EQ(read.scene.quality, "auto");
  EXPECT_EQ(read.scene.settings, (std::vector<std::string>{"frames.cap=50", "view.distance=444"}));
}

TEST(Preferences, NonsenseIsToldInOneLineAndTheRestHolds) {
  for (const char* text : {"", "[", "3", R"({"quality": []})", R"({"colour": "red"})",
                           R"({"settings": 1})", R"({"fov": true})"}) {
    const ReadPreferences read = read_preferences(text);
    ASSERT_EQ(read.problems.size(), 1u) << text;
    EXPECT_EQ(read.problems[0].find('\n'), std::string::npos);
    EXPECT_TRUE(make_scene(read.scene, {}));
  }
  const ReadPreferences half = read_preferences(
      R"({"quality": "best", "fov": 90, "settings": {"view.distance": "far", "aa.samples": 4}})");
  EXPECT_EQ(half.problems.size(), 2u);
  EXPECT_FALSE(half.scene.quality);
  EXPECT_EQ(half.scene.fov, "90");
  EXPECT_EQ(half.scene.settings, std::vector<std::string>{"aa.samples=4"});
}

TEST(Preferences, WhatBelongsToNoPlayerIsNotTaken) {
  const ReadPreferences read = read_preferences(R"({"settings": {"world.offset": "9,9,9"}})");
  EXPECT_TRUE(read.scene.settings.empty());
}

TEST(Preferences, SavingOverAFileThatWasNotUnderstoodKeepsIt) {
  const Folder folder;
  ASSERT_TRUE(write_text(folder / "settings.json", "{mine"));
  ASSERT_TRUE(save_preferences(folder / "settings.json", {}));
  EXPECT_EQ(*platform::read_text(folder / "settings.json.old", 100), "{mine");
}

}  // namespace
}  // namespace skerry::game
