#include "game/scene_file/options.h"

#include <gtest/gtest.h>

#include <random>

namespace skerry::game {
namespace {

std::string scene_error(std::string_view json) {
  const auto text = parse_scene(json);
  if (!text) return text.error().message;
  const auto scene = make_scene(*text, {});
  EXPECT_FALSE(scene) << json;
  return scene ? "" : scene.error().message;
}

TEST(Scene, EveryFieldOfAFileArrives) {
  const auto text = parse_scene(
      R"({"seed": "fjord", "camera": [1.5, "1099511627775.9999847412109375", -3, 90, -10.5],
    "fov": 60, "time": "06:30", "size": "320x180", "quality": "low", "settings": {"view.distance": 123, "exposure": "auto"}})");
  ASSERT_TRUE(text) << text.error().message;
  const auto scene = make_scene(*text, {});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->seed_text, "fjord");
  const std::int64_t edge = world::kMaxBlock * world::kUnitsPerBlock;
  EXPECT_EQ(scene->camera->position, (world::WorldPos{98304, edge - 1, -3 * 65536}));
  EXPECT_EQ(scene->camera->yaw_deg, 90.0);
  EXPECT_EQ(scene->camera->pitch_deg, -10.5);
  EXPECT_EQ(scene->fov_deg, 60.0);
  EXPECT_EQ(scene->time_of_day_s, 6 * 3600 + 1800);
  EXPECT_EQ(scene->size, (PictureSize{320, 180}));
  EXPECT_EQ(scene->quality, Quality::kLow);
  EXPECT_EQ(scene->settings.view_distance, 123u);
  EXPECT_EQ(scene->settings.render.shadow_size, 1024);
}

TEST(Scene, ImportOptionsOfAFileAndOfTheCommandLineArriveAndAreSaidAgain) {
  const auto file = parse_scene(
      R"({"world": "a.vdb", "import": {"grid": "my density", "scale": 2.5, "up": "z"}})");
  ASSERT_TRUE(file) << file.error().message;
  SceneText typed;
  typed.import = {"scale=0.5", "threshold=-0.25"};
  const auto scene = make_scene(*file, typed);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->import.grid, "my density");
  EXPECT_EQ(scene->import.scale, 0.5);
  EXPECT_EQ(scene->import.threshold, -0.25);
  EXPECT_EQ(scene->import.up, world::UpAxis::kZ);
  EXPECT_NE(shot_command(*scene).find("--world a.vdb --import 'grid=my density' --import scale=0.5 "
                                      "--import threshold=-0.25 --import up=z"),
            std::string::npos)
      << shot_command(*scene);
  // They belong to the file's world.
  typed = {};
  typed.world = "b.vdb";
  EXPECT_FALSE(make_scene(*file, typed)->import.grid);
}

TEST(Scene, MistakesInImportOptionsAreNamed) {
  const auto refusal = [](const std::string& world, std::vector<std::string> import) {
    SceneText typed;
    typed.world = world;
    typed.import = std::move(import);
    const auto scene = make_scene({}, typed);
    return scene ? "" : scene.error().message;
  };
  EXPECT_EQ(refusal("a.vdb", {"size=100"}), "");
  EXPECT_NE(refusal("a.skerry", {"size=100"}).find("FILE.vdb"), std::string::npos);
  EXPECT_NE(refusal("a.vdb", {"sise=100"}).find("'size'"), std::string::npos);
  EXPECT_NE(refusal("a.vdb", {"size"}).find("KEY=VALUE"), std::string::npos);
  EXPECT_NE(refusal("a.vdb", {"size=1", "scale=1"}).find("exclude"), std::string::npos);
  EXPECT_NE(refusal("a.vdb", {"up=x"}).find("y or z"), std::string::npos);
  EXPECT_NE(refusal("a.vdb", {"scale=-1"}).find("scale"), std::string::npos);
}

TEST(Scene, NumbersServeAsSeedAndKeepAllTheirDigits) {
  EXPECT_EQ(*parse_scene(R"({"seed": 18446744073709551615})")->seed, "18446744073709551615");
}

TEST(Scene, TheCommandLineWinsOverTheFile) {
  SceneText file, typed;
  file.seed = "a";
  file.quality = "low";
  file.settings = {"view.distance=100", "exposure=1"};
  typed.quality = "high";
  typed.settings = {"view.distance=200"};
  const auto scene = make_scene(file, typed);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->seed_text, "a");
  EXPECT_EQ(scene->quality, Quality::kHigh);
  EXPECT_EQ(scene->settings.view_distance, 200u);
  EXPECT_EQ(scene->settings.exposure_ev, 1.0);
}

TEST(Scene, MistakesInAFileAreNamed) {
  EXPECT_NE(scene_error(R"({"sed": 1})").find("did you mean 'seed'"), std::string::npos);
  EXPECT_NE(scene_error(R"({"settings": {"view.distnce": 1}})").find("'view.distance'"),
            std::string::npos);
  EXPECT_NE(scene_error(R"({"camera": [1, 2, 3]})").find("camera"), std::string::npos);
  for (const char* json : {"", "{", "[]", "1", "null", R"({"seed": null})", R"({"seed": {}})",
                           R"({"camera": "1,2,3,4,5"})", R"({"camera": [1,2,3,4,null]})",
                           R"({"camera": [true,2,3,4,5]})", R"({"camera": [1e300,2,3,4,5]})",
                           R"({"fov": "wide"})", R"({"fov": 0})", R"({"fov": 175.1})",
                           R"({"settings": []})", R"({"settings": {"view.distance": [1]}})",
                           R"({"size": [1, 2]})", R"({"time": 12})", "{\"seed\": \"\xff\"}"}) {
    const std::string error = scene_error(json);
    EXPECT_FALSE(error.empty()) << json;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST(Scene, HostileTextIsAnErrorNotACrash) {
  EXPECT_FALSE(parse_scene(std::string(kMaxSceneBytes, '[')));
  EXPECT_FALSE(parse_scene(std::string(100000, '{')));
  std::string nested = R"({"settings": )";
  for (int i = 0; i < 50000; ++i) nested += R"({"a": )";
  nested += "1" + std::string(50001, '}');
  EXPECT_FALSE(parse_scene(nested));
  std::mt19937 random(5);
  const std::string good = R"({"seed": "x", "camera": [1,2,3,4,5], "settings": {"exposure": 1}})";
  for (int round = 0; round < 5000; ++round) {
    std::string bad = good;
    for (int edits = 0; edits < 3; ++edits)
      bad[random() % bad.size()] = static_cast<char>(random());
    const auto text = parse_scene(bad);
    if (text) (void)make_scene(*text, {});
  }
}

TEST(Scene, TheCommandOfASceneRebuildsIt) {
  SceneOptions scene;
  scene.seed_text = "it's a \"seed\" $HOME";
  scene.camera =
      CameraPlace{{1, -65535, world::kMaxBlock * world::kUnitsPerBlock - 3}, 12.3456789, -45.0};
  scene.fov_deg = 33.3;
  scene.time_of_day_s = 12345;
  scene.quality = Quality::kHigh;
  scene.settings = settings_of(Quality::kHigh);
  scene.settings.view_distance = 555;
  const std::string command = shot_command(scene);
  // Let a real shell take the command apart again.
  const std::string printer =
      "set -- " + command.substr(std::string("skerry shot ").size()) + "; printf '%s\\n' \"$@\"";
  ::setenv("PRINTER", printer.c_str(), 1);
  FILE* pipe = ::popen("eval \"$PRINTER\"", "r");
  ASSERT_NE(pipe, nullptr);
  std::vector<std::string> words;
  char line[512];
  while (std::fgets(line, sizeof line, pipe))
    words.emplace_back(line, std::string_view(line).size() - 1);
  ::pclose(pipe);
  SceneText typed;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    const std::string& value = words[i + 1];
    if (words[i] == "--seed") typed.seed = value;
    if (words[i] == "--camera") typed.camera = value;
    if (words[i] == "--fov") typed.fov = value;
    if (words[i] == "--time") typed.time = value;
    if (words[i] == "--size") typed.size = value;
    if (words[i] == "--quality") typed.quality = value;
    if (words[i] == "--set") typed.settings.push_back(value);
  }
  const auto back = make_scene({}, typed);
  ASSERT_TRUE(back) << back.error().message << command;
  EXPECT_EQ(back->seed_text, scene.seed_text);
  EXPECT_EQ(*back->camera, *scene.camera);
  EXPECT_EQ(back->fov_deg, scene.fov_deg);
  EXPECT_EQ(back->time_of_day_s, scene.time_of_day_s);
  EXPECT_EQ(back->size, scene.size);
  EXPECT_EQ(back->quality, scene.quality);
  EXPECT_EQ(back->settings, scene.settings);
}

TEST(Options, AWorldStandsInPlaceOfASeed) {
  SceneText file, typed;
  file.seed = "fjord";
  typed.world = "my worlds/a.skerry";
  const Result<SceneOptions> scene = make_scene(file, typed);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->world, "my worlds/a.skerry");
  const std::string command = shot_command(*scene);
  EXPECT_TRUE(command.starts_with("skerry shot --world 'my worlds/a.skerry' --fov")) << command;
  EXPECT_FALSE(make_scene(typed, file)->world);  // and the other way round
  typed.seed = "4";
  EXPECT_FALSE(make_scene({}, typed));
  typed.seed.reset();
  typed.world = "";
  EXPECT_FALSE(make_scene({}, typed));
  EXPECT_EQ(parse_scene(R"({"world": "a"})")->world, "a");
  EXPECT_FALSE(parse_scene(R"({"world": true})"));
}

}  // namespace
}  // namespace skerry::game
