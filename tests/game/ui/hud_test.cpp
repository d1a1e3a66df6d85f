#include "game/ui/hud.h"

#include <gtest/gtest.h>

#include "game/ui/gui.h"

namespace skerry::game::ui {
namespace {

TEST(Hud, BearingsFollowTheConventions) {
  EXPECT_EQ(bearing_deg(0.0), 180.0);  // yaw 0 looks along +z, south
  EXPECT_EQ(bearing_deg(90.0), 90.0);  // 90 along +x, east
  EXPECT_EQ(bearing_deg(180.0), 0.0);
  EXPECT_EQ(bearing_deg(-90.0), 270.0);
}

TEST(Hud, DrawsWithinThePicture) {
  const Pictures pictures;
  const std::vector<world::BlockId> blocks(9, world::block::kTorch);
  HudFacts facts;
  facts.hotbar = blocks;
  facts.place = "1099511627776  -1099511627776  1099511627776";
  facts.steering = HudFacts::Steering{"Skarholm", 3.5};
  Messages messages;
  messages.say("The disk is full: nothing more of this world is saved until there is room again");
  for (const auto& [width, height] : {std::pair(640u, 360u), {1280u, 720u}, {2560u, 1440u}}) {
    Gui gui;
    gui.begin({width, height, 0.02, nullptr});
    show_hud(facts, pictures);
    show_messages(messages);
    const OverlayTriangles triangles = gui.end();
    ASSERT_GT(triangles.vertices.size(), 100u);
    bool pictured = false;
    for (const shared::OverlayVertex& vertex : triangles.vertices) {
      ASSERT_LT(vertex.clip & ~shared::kOverlayPicture, triangles.clips.size());
      pictured |= (vertex.clip & shared::kOverlayPicture) != 0;
      ASSERT_TRUE(vertex.position.x >= -2.0f &&
                  vertex.position.x <= static_cast<float>(width) + 2.0f);
      ASSERT_TRUE(vertex.position.y >= -2.0f &&
                  vertex.position.y <= static_cast<float>(height) + 2.0f);
    }
    EXPECT_TRUE(pictured);
  }
}

TEST(Messages, FadeAndRepeatInOneLine) {
  Messages messages;
  messages.say("saved");
  messages.pass(5.0);
  messages.say("saved");
  ASSERT_EQ(messages.lines().size(), 1u);
  messages.pass(6.5);
  EXPECT_NEAR(messages.lines()[0].strength(), 0.5, 1e-9);
  messages.pass(1.0);
  EXPECT_TRUE(messages.lines().empty());
  for (int i = 0; i < 100; ++i) messages.say(std::to_string(i));
  EXPECT_EQ(messages.lines().size(), Messages::kMost);
  EXPECT_EQ(messages.lines().back().text, "99");
}

}  // namespace
}  // namespace skerry::game::ui
