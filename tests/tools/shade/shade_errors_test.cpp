// The light that stays on surfaces against the reference, in views that are quick to judge.
#include "tools/skerry/shade/shade_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "game/scene_file/parse.h"

namespace skerry::tools {
namespace {

ShadeErrors errors_in(std::string_view name) {
  const auto listed = std::ranges::find(shade_scenes(), name, &ShadeScene::name);
  const Result<game::SceneText> text = game::parse_scene(listed->json);
  Result<game::SceneOptions> scene = game::make_scene(*text, {});
  scene->size = {64, 36};
  return *measure_shade(*scene);
}

// What the reference's own noise adds to a mean of so many places is far below the bounds: its
// standard error is at most 40% a place.
TEST(ShadeErrors, StayWithinWhatTheyAreKnownToBe) {
  struct Bounds {
    std::string_view scene;
    double rmse, bias;
  };
  for (const Bounds& most :
       {Bounds{"day", 0.18, 0.04}, Bounds{"pit", 0.16, 0.09}, Bounds{"cave_mouth", 0.33, 0.08},
        Bounds{"turned", 0.27, 0.05}, Bounds{"stained_hall", 0.4, 0.2}}) {
    const ShadeErrors found = errors_in(most.scene);
    EXPECT_GT(found.places, 200u) << most.scene;
    EXPECT_LT(found.without, found.places / 3) << most.scene;
    EXPECT_LT(found.rmse, most.rmse) << most.scene;
    EXPECT_LT(std::abs(found.bias), most.bias) << most.scene;
  }
}

}  // namespace
}  // namespace skerry::tools
