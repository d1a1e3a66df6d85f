#include "game/scene_file/scene_contents.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "game/scene_file/options.h"
#include "game/worlds/open_world.h"

namespace skerry::game {
namespace {

Result<std::vector<BlockBox>> read(const char* text) {
  return read_blocks(nlohmann::json::parse(text));
}

TEST(SceneBlocks, CornersAreInAnyOrderAndOneIsEnough) {
  const auto boxes = read(R"([{"block": "glass", "from": [3, -1, 7], "to": [1, 4, 7]},
                              {"block": "air", "from": [0, 0, -1099511627776]}])");
  ASSERT_TRUE(boxes) << boxes.error().message;
  ASSERT_EQ(boxes->size(), 2u);
  EXPECT_EQ(boxes->at(0).block, world::block::kGlass);
  EXPECT_EQ(boxes->at(0).from, (std::array<std::int64_t, 3>{1, -1, 7}));
  EXPECT_EQ(boxes->at(0).to, (std::array<std::int64_t, 3>{3, 4, 7}));
  EXPECT_EQ(boxes->at(1).to[2], -world::kMaxBlock);
}

TEST(SceneBlocks, WhatIsWrongIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({})", "give a list"},
      {R"([3])", "blocks[0]: it lacks a block"},
      {R"([{"block": "glass"}])", "lacks"},
      {R"([{"block": "glas", "from": [0, 0, 0]}])", "did you mean 'glass'"},
      {R"([{"block": 7, "from": [0, 0, 0]}])", "a block's name"},
      {R"([{"block": "glass", "from": [0, 0.5, 0]}])", "'from' is wrong"},
      {R"([{"block": "glass", "from": [0, 0]}])", "'from' is wrong"},
      {R"([{"block": "glass", "from": [0, 0, 1099511627777]}])", "'from' is wrong"},
      {R"([{"block": "glass", "from": [0, 0, 18446744073709551615]}])", "'from' is wrong"},
      {R"([{"block": "glass", "from": [0, 0, 0], "too": [1, 1, 1]}])", "did you mean 'to'"},
      {R"([{"block": "glass", "from": [0, 0, 0], "to": [1023, 1023, 1]}])", "1048576 blocks"},
      {R"([{"block": "glass", "from": [-1099511627776, -1099511627776, 0],
            "to": [1099511627776, 1099511627776, 9]}])",
       "1048576 blocks"},
  };
  for (const auto& [text, said] : cases) {
    const auto boxes = read(text);
    ASSERT_FALSE(boxes) << text;
    EXPECT_NE(boxes.error().message.find(said), std::string::npos) << boxes.error().message;
  }
}

TEST(SceneBlocks, TheWorldHoldsThemAndTheLastWins) {
  const auto text = parse_scene(
      R"({"seed": 1, "blocks": [{"block": "bricks", "from": [-2, 200, 5], "to": [2, 201, 5]},
                                {"block": "glass", "from": [0, 200, 5]}]})");
  ASSERT_TRUE(text) << text.error().message;
  const auto scene = make_scene(*text, {});
  ASSERT_TRUE(scene) << scene.error().message;
  const auto world = open_world(*scene);
  ASSERT_TRUE(world) << world.error().message;
  const world::IslandSpec island =
      (*world)->islands_near({0, 200 * 65536, 5 * 65536}, 512.0, 0.0).front();
  const world::Pose pose = *(*world)->pose(island.id, 0.0);
  int bricks = 0, glass = 0;
  for (int y = 200; y <= 201; ++y)
    for (int x = -2; x <= 2; ++x) {
      const glm::dvec3 p =
          glm::inverse(pose.rotation) *
          world::difference_blocks({x * 65536 + 32768, y * 65536 + 32768, 5 * 65536 + 32768},
                                   pose.origin);
      const world::IVec3 voxel{static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                               static_cast<int>(std::floor(p.z))};
      (*world)->ensure_chunk(island.id, {world::chunk_of(voxel)});
      const auto block = (*world)->block_at(island.id, voxel);
      bricks += block == world::block::kBricks;
      glass += block == world::block::kGlass;
      EXPECT_LT(voxel.y, island.box_max.y) << "the box that is looked for has grown";
    }
  EXPECT_EQ(bricks, 9);
  EXPECT_EQ(glass, 1);
}

TEST(SceneBlocks, FarFromAllIslandsIsRefused) {
  const auto scene = make_scene(*parse_scene(R"({"seed": 1, "settings": {"world.islands": 1},
                       "blocks": [{"block": "glass", "from": [0, 90000, 0]}]})"),
                                {});
  ASSERT_TRUE(scene) << scene.error().message;
  const auto world = open_world(*scene);
  ASSERT_FALSE(world);
  EXPECT_NE(world.error().message.find("no island is within 512 blocks"), std::string::npos);
}

}  // namespace
}  // namespace skerry::game
