#include "game/worlds/gallery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/folder.h"
#include "tests/world/made_islands.h"

namespace skerry::game {
namespace {

TEST(Gallery, ShellWordsAreReadBack) {
  for (const std::string& word : {std::string("plain"), std::string(), std::string("two words"),
                                  std::string("it's"), std::string("'"), std::string("back\\slash"),
                                  std::string("$HOME `x` \"q\""), std::string("\xe5\xb3\xb6")}) {
    const auto words = shell_words("a " + shell_word(word) + " b");
    ASSERT_TRUE(words) << word;
    EXPECT_EQ(*words, (std::vector<std::string>{"a", word, "b"}));
  }
  EXPECT_TRUE(shell_words("").operator*().empty());
  EXPECT_FALSE(shell_words("skerry 'shot"));
  EXPECT_FALSE(shell_words("skerry \\"));
}

/// Where F2 is pressed is where the picture leads back to, however it was drawn.
TEST(Gallery, APictureLeadsBackToItsPlace) {
  SceneOptions taken;
  taken.seed_text = "it's an island";
  taken.camera = CameraPlace{{1234567, -99, 1LL << 50}, -123.5, 33.25};
  taken.time_of_day_s = 6 * 3600 + 90;
  taken.fov_deg = 33.0;
  taken.quality = Quality::kUltra;
  taken.settings = settings_of(Quality::kUltra);
  taken.settings.world_offset = {5, -6, 7};
  taken.settings.world_islands = 12;
  taken.settings.world_time_s = 345.5;
  taken.settings.moon_phase = 0.25;
  taken.settings.render.clouds.coverage = 0.5f;
  taken.settings.render.ao_strength = 0.1f;
  taken.settings.exposure_ev = 3.0;
  taken.settings.ui.scale = 2.0f;  // of play alone, as play.* is: no command has them
  taken.settings.play = {true, true, false};
  for (const char* group : {" ui.", " play."})
    EXPECT_EQ(shot_command(taken).find(group), std::string::npos) << group;
  const platform::PngText text[] = {{"Software", "Skerry"}, {"Command", shot_command(taken)}};
  const auto place = place_of_picture(text);
  ASSERT_TRUE(place) << place.error().message;
  SceneOptions played;
  played.world = "another.skerry";
  played.settings.view_distance = 222;
  played.settings.render.clouds.steps = 99;
  played.fov_deg = 80.0;
  const SceneOptions there = at_place(played, *place);
  EXPECT_FALSE(there.world);
  EXPECT_EQ(there.seed_text, taken.seed_text);
  EXPECT_EQ(there.camera, taken.camera);
  EXPECT_EQ(there.time_of_day_s, taken.time_of_day_s);
  EXPECT_EQ(there.settings.world_offset, taken.settings.world_offset);
  EXPECT_EQ(there.settings.world_islands, taken.settings.world_islands);
  EXPECT_EQ(there.settings.world_time_s, taken.settings.world_time_s);
  EXPECT_EQ(there.settings.moon_phase, taken.settings.moon_phase);
  EXPECT_EQ(there.settings.render.clouds.coverage, 0.5f);
  // What the player has set stays.
  EXPECT_EQ(there.settings.view_distance, 222u);
  EXPECT_EQ(there.settings.render.clouds.steps, 99);
  EXPECT_EQ(there.settings.render.ao_strength, Settings().render.ao_strength);
  EXPECT_FALSE(there.settings.exposure_ev);
  EXPECT_EQ(there.fov_deg, 80.0);
}

TEST(Gallery, AWorldsPictureNamesTheWorld) {
  SceneOptions taken;
  taken.world = "/home/a b/w.skerry";
  taken.camera = CameraPlace{};
  const platform::PngText text[] = {{"Command", shot_command(taken)}};
  const auto place = place_of_picture(text);
  ASSERT_TRUE(place) << place.error().message;
  EXPECT_EQ(place->world, taken.world);
}

/// What the camera saw from its island it sees again, wherever that has gone and turned to.
TEST(Gallery, APictureOfASavedWorldFollowsItsIsland) {
  const auto turned = [](double degrees) {
    return glm::angleAxis(glm::radians(degrees), glm::dvec3{0.0, 1.0, 0.0});
  };
  const world::Pose then{world::blocks(1000.0, -20.0, 1 << 20), turned(30.0)};
  const CameraPlace eye{world::moved(then.origin, {3.0, 5.0, -7.0}), -100.0, 12.5};
  const platform::PngText text[] = {{"Software", "Skerry"}, text_of(seen_from(77, then, eye))};
  const std::optional<IslandView> view = island_view_of(text);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->island, 77u);
  const auto expect_near = [](const CameraPlace& a, const CameraPlace& b) {
    EXPECT_LT(glm::length(world::difference_blocks(a.position, b.position)), 1e-6);
    EXPECT_NEAR(std::remainder(a.yaw_deg - b.yaw_deg, 360.0), 0.0, 1e-9);
    EXPECT_EQ(a.pitch_deg, b.pitch_deg);
  };
  expect_near(seen_in_world(*view, then), eye);
  // A quarter to the left, from 30 to 120 degrees: +z goes to +x, +x to -z; and so far away.
  const world::Pose now{world::moved(then.origin, {-40.0, 1.0, 8.0}), turned(120.0)};
  expect_near(seen_in_world(*view, now),
              {world::moved(now.origin, {-7.0, 5.0, -3.0}), -10.0, 12.5});
  for (const char* damaged : {"", "77", "x 1,2,3,4,5", "77 1,2,3", "77 1,2,3,4,nan", "-1 1,2,3,4,5",
                              "99999999999999999999 1,2,3,4,5"}) {
    const platform::PngText other[] = {{text[1].key, damaged}};
    EXPECT_FALSE(island_view_of(other)) << damaged;
  }
  EXPECT_FALSE(island_view_of({}));
}

TEST(Gallery, WhatLeadsNowhereSaysWhyInOneLine) {
  for (const char* command : {"", "skerry", "skerry play --seed 1", "rm -rf x",
                              "skerry shot --seed", "skerry shot seed 1", "skerry shot --exec ls",
                              "skerry shot --seed 'x", "skerry shot --camera 1,2",
                              "skerry shot --set world.time=never", "skerry shot --time noon"}) {
    const platform::PngText text[] = {{"Command", command}};
    const auto place = place_of_picture(text);
    ASSERT_FALSE(place) << command;
    EXPECT_FALSE(place.error().message.empty());
    EXPECT_EQ(place.error().message.find('\n'), std::string::npos);
  }
  EXPECT_FALSE(place_of_picture({}));
}

TEST(Gallery, PicturesAreListedNewestFirst) {
  const Folder folder;
  for (const char* name : {"skerry-20260101-000000.png", "skerry-20260201-000000.png", "notes.txt"})
    std::ofstream(folder / name) << "x";
  std::filesystem::create_directories(folder / "folder.png");
  const auto found = list_pictures(folder.path());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].filename(), "skerry-20260201-000000.png");
  EXPECT_TRUE(list_pictures(folder / "none").empty());
}

}  // namespace
}  // namespace skerry::game
