// What a person types of clouds, and what is made of it.
#include "game/scene_file/cloud_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "game/scene_file/options.h"

namespace skerry::game {
namespace {

TEST(CloudFiles, APlaceAndAScaleFollowTheLastAt) {
  const auto plain = parse_cloud("a/b.vdb");
  ASSERT_TRUE(plain);
  EXPECT_EQ(*plain, (CloudFile{"a/b.vdb", {}, 1.0}));
  const auto placed = parse_cloud("me@home.vdb@1.5,-20,1099511627776");
  ASSERT_TRUE(placed);
  EXPECT_EQ(
      *placed,
      (CloudFile{"me@home.vdb", {98304, -20 * 65536, std::int64_t{1099511627776} * 65536}, 1.0}));
  const auto scaled = parse_cloud("b.vdb@0,0,0,2.5");
  ASSERT_TRUE(scaled);
  EXPECT_EQ(scaled->scale, 2.5);
  const auto named = parse_cloud("me@home.vdb");
  ASSERT_TRUE(named);
  EXPECT_EQ(named->path, "me@home.vdb");
}

TEST(CloudFiles, WhatCannotBeAPlaceIsRefused) {
  for (const char* text : {"", "@1,2,3", "a.vdb@1,2", "a.vdb@1,2,3,4,5", "a.vdb@1,2,3,0",
                           "a.vdb@1,2,3,1e9", "a.vdb@1,,3", "a.vdb@1099511627777,0,0"})
    EXPECT_FALSE(parse_cloud(text)) << text;
}

TEST(CloudFiles, WhatIsPrintedIsReadBack) {
  const CloudFile cloud{"x y@z.vdb", {-1, 65537, 1 << 20}, 0.125};
  const auto back = parse_cloud(format_cloud(cloud));
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, cloud);
}

TEST(CloudFiles, AScenesCloudsComeBeforeTheCommandLines) {
  const auto scene = parse_scene(
      R"({"clouds": [{"file": "a.vdb", "position": [1, "2", 3.5], "scale": 2}, {"file": "/b.vdb"}]})");
  ASSERT_TRUE(scene) << scene.error().message;
  SceneText under = *scene, over;
  find_beside("/scenes/one.json", under.clouds);
  over.clouds = {*parse_cloud("c.vdb@4,5,6")};
  const auto made = make_scene(under, over);
  ASSERT_TRUE(made);
  ASSERT_EQ(made->clouds.size(), 3u);
  EXPECT_EQ(made->clouds[0].path, "/scenes/a.vdb");
  EXPECT_EQ(made->clouds[0].position, (world::WorldPos{65536, 131072, 229376}));
  EXPECT_EQ(made->clouds[1].path, "/b.vdb");
  EXPECT_NE(shot_command(*made).find("--cloud c.vdb@4,5,6,1"), std::string::npos);
}

TEST(CloudFiles, ErrorsOfASceneNameTheCloud) {
  for (const char* text :
       {R"({"clouds": {}})", R"({"clouds": [{}]})", R"({"clouds": [{"file": ""}]})",
        R"({"clouds": [{"file": "a.vdb", "place": [1, 2, 3]}]})",
        R"({"clouds": [{"file": "a.vdb", "position": [1, 2]}]})",
        R"({"clouds": [{"file": "a.vdb", "position": [1, 2, true]}]})",
        R"({"clouds": [{"file": "a.vdb", "scale": "2"}]})",
        R"({"clouds": [{"file": "a.vdb", "scale": -1}]})"}) {
    const auto scene = parse_scene(text);
    ASSERT_FALSE(scene) << text;
    EXPECT_NE(scene.error().message.find("cloud"), std::string::npos);
  }
}

TEST(CloudFiles, HeatGlowsAndAllElseIsDensity) {
  for (const char* hot : {"temperature", "Heat", "flame[1]"})
    EXPECT_EQ(cloud_role(hot), render::CloudRole::kEmission) << hot;
  for (const char* dense : {"density", "voxel_fog_density", "smoke"})
    EXPECT_EQ(cloud_role(dense), render::CloudRole::kDensity) << dense;
}

TEST(CloudFiles, WhereDensityIsNamedOnlyThatAndHeatAreDrawn) {
  using Places = std::vector<std::size_t>;
  const std::vector<std::string> told{"fuel", "density", "Temperature", "pressure",
                                      "smoke_Density"};
  EXPECT_EQ(drawn_grids(told), (Places{1, 2, 4}));
  const std::vector<std::string> untold{"smoke", "flame", "steam"};
  EXPECT_EQ(drawn_grids(untold), (Places{0, 1, 2})) << "any of them may be density";
  EXPECT_EQ(drawn_grids({}), Places{});
}

TEST(CloudFiles, AFileThatIsNotThereIsOneLine) {
  const CloudFile file{"/nowhere/cloud.vdb", {}, 1.0};
  const auto loaded = load_clouds(std::span(&file, 1));
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace skerry::game
