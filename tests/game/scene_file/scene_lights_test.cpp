#include "game/scene_file/scene_contents.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "game/scene_file/emission.h"
#include "game/scene_file/options.h"

namespace skerry::game {
namespace {

Result<std::vector<WorldLight>> read(const std::string& text) {
  return read_lights(nlohmann::json::parse(text));
}

TEST(SceneLights, EveryKindIsReadWithItsFields) {
  const auto lights = read(R"([
    {"kind": "point", "position": [1.5, -2, "1099511627775.25"], "intensity": 3},
    {"kind": "spot", "position": [0, 1, 2], "color": [1, 0.5, 0], "power": 12.566370614,
     "axis": [0, -2, 0], "cone": [10, 60], "dual": true, "range": 7},
    {"kind": "tube", "position": [0, 0, 0], "intensity": [1, 2, 3], "axis": [3, 0, 4], "size": 2},
    {"kind": "sphere", "position": [0, 0, 0], "intensity": 0.25, "size": 0.5},
    {"kind": "directional", "axis": [0, -1, 0], "intensity": 1, "range": 50}])");
  ASSERT_TRUE(lights) << lights.error().message;
  ASSERT_EQ(lights->size(), 5u);
  const WorldLight& point = (*lights)[0];
  EXPECT_EQ(point.light.kind, shared::kLightPoint);
  EXPECT_EQ(point.position, (world::WorldPos{98304, -131072, 72057594037927936 - 65536 + 16384}));
  EXPECT_EQ(point.light.intensity, glm::vec3(3.0f));
  EXPECT_FLOAT_EQ(point.light.range, light_range(glm::vec3(3.0f)));
  const shared::Light& spot = (*lights)[1].light;
  EXPECT_EQ(spot.kind, shared::kLightSpot | shared::kLightDualBit);
  EXPECT_NEAR(spot.intensity.x, 1.0f, 1e-6f);
  EXPECT_NEAR(spot.intensity.y, 0.5f, 1e-6f);
  EXPECT_EQ(spot.axis, glm::vec3(0.0f, -1.0f, 0.0f));
  EXPECT_NEAR(spot.cos_inner, std::cos(std::numbers::pi / 18.0), 1e-6);
  EXPECT_NEAR(spot.cos_outer, 0.5, 1e-6);
  EXPECT_EQ(spot.range, 7.0f);
  EXPECT_FLOAT_EQ((*lights)[2].light.axis.x, 0.6f);
  EXPECT_EQ((*lights)[2].light.size, 2.0f);
  EXPECT_EQ((*lights)[3].light.size, 0.5f);
  EXPECT_EQ((*lights)[4].light.range, 50.0f);
}

TEST(SceneLights, ABadLightIsRefusedInOneLineThatNamesIt) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({})", "list"},
      {R"([3])", "kind"},
      {R"([{"kind": "pont", "position": [0,0,0], "intensity": 1}])", "point"},
      {R"([{"kind": "point", "intensity": 1}])", "needs 'position'"},
      {R"([{"kind": "point", "position": [0,0], "intensity": 1}])", "position"},
      {R"([{"kind": "point", "position": [0,0,1e300], "intensity": 1}])", "position"},
      {R"([{"kind": "point", "position": [0,0,0]}])", "strength"},
      {R"([{"kind": "point", "position": [0,0,0], "intensity": 1, "power": 1}])", "strength"},
      {R"([{"kind": "point", "position": [0,0,0], "power": 1}])", "color"},
      {R"([{"kind": "point", "position": [0,0,0], "color": [1,1,2], "power": 1}])", "color"},
      {R"([{"kind": "point", "position": [0,0,0], "color": [1,1,1], "power": -1}])", "intensity"},
      {R"([{"kind": "point", "position": [0,0,0], "intensity": -1}])", "intensity"},
      {R"([{"kind": "point", "position": [0,0,0], "intensity": 1e300}])", "intensity"},
      {R"([{"kind": "point", "position": [0,0,0], "intensity": [1,2]}])", "intensity"},
      {R"([{"kind": "point", "position": [0,0,0], "intensity": 1, "range": 0}])", "range"},
      {R"([{"kind": "point", "position": [0,0,0], "intensity": 1, "range": "far"}])", "range"},
      {R"([{"kind": "point", "position": [0,0,0], "intensity": 1, "size": 1}])", "no 'size'"},
      {R"([{"kind": "point", "position": [0,0,0], "intensity": 1, "sise": 1}])", "'size'"},
      {R"([{"kind": "sphere", "position": [0,0,0], "intensity": 1, "size": -1}])", "size"},
      {R"([{"kind": "sphere", "position": [0,0,0], "intensity": 1}])", "needs 'size'"},
      {R"([{"kind": "tube", "position": [0,0,0], "intensity": 1, "size": 1, "axis": [0,0,0]}])",
       "axis"},
      {R"([{"kind": "spot", "position": [0,0,0], "intensity": 1, "axis": [0,1,0],
            "cone": [40, 20]}])",
       "cone"},
      {R"([{"kind": "spot", "position": [0,0,0], "intensity": 1, "axis": [0,1,0],
            "cone": [10, 190]}])",
       "cone"},
      {R"([{"kind": "spot", "position": [0,0,0], "intensity": 1, "axis": [0,1,0],
            "cone": [10, 20], "dual": 1}])",
       "dual"},
      {R"([{"kind": "directional", "position": [0,0,0], "axis": [0,1,0], "intensity": 1}])",
       "no 'position'"},
      {R"([{"kind": "directional", "axis": [0,1,0], "color": [1,1,1], "power": 1}])", "intensity"},
  };
  for (const auto& [text, named] : cases) {
    const auto lights = read(text);
    ASSERT_FALSE(lights) << text;
    const std::string& message = lights.error().message;
    EXPECT_NE(message.find(named), std::string::npos) << text << "\n" << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    if (std::string_view(text).starts_with("[")) {
      EXPECT_NE(message.find("light 1"), std::string::npos) << message;
    }
  }
}

TEST(SceneLights, ASceneKeepsThemAndItsCommandNamesTheFile) {
  const auto text = parse_scene(
      R"({"seed": 3, "lights": [{"kind": "point", "position": [0, 0, 0], "intensity": 2}]})");
  ASSERT_TRUE(text) << text.error().message;
  auto scene = make_scene(*text, {});
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->lights.size(), 1u);
  scene->scene_file = "my scene.json";
  EXPECT_TRUE(shot_command(*scene).starts_with("skerry shot --scene 'my scene.json' --seed 3 "));
  scene->lights.clear();
  EXPECT_TRUE(shot_command(*scene).starts_with("skerry shot --seed 3 "));
  EXPECT_FALSE(parse_scene(R"({"lights": [{"kind": "point"}]})"));
}

}  // namespace
}  // namespace skerry::game
