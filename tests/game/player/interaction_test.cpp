#include "game/player/interaction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "game/player/edit_rules.h"
#include "tests/game/player/test_world.h"
#include "world/islands/dig.h"

namespace skerry::game {
namespace {

using world::BlockId;
using world::IVec3;
namespace block = world::block;

constexpr double kFrame = 1.0 / 60.0;

/// Stone below y = 0, and a player who stands on it and looks where a test wants.
class InteractionTest : public testing::Test {
 protected:
  InteractionTest() {
    world_.islands.push_back({[](double) { return still({}); }, plain});
    player_.advance(0.5, {}, world_);
  }
  void look(double yaw_deg, double pitch_deg) {
    const CameraPlace eye = player_.eye(world_);
    player_.turn(yaw_deg - eye.yaw_deg, pitch_deg - eye.pitch_deg);
  }
  void frame(const HandIntent& intent, double seconds = kFrame) {
    hands_.advance(seconds, intent, player_, player_.eye(world_), world_, world_);
  }
  /// Frames with the button held until the picked block is gone; -1: it stays.
  int dig() {
    frame({});
    const Pick at = hands_.pick().value();
    for (int frames = 1; frames < 600; ++frames) {
      frame({.dig = true});
      if (*world_.block(at.island, at.voxel) == world::kAir) return frames;
    }
    return -1;
  }
  BlockId at(int x, int y, int z) const { return *world_.block(0, {x, y, z}); }

  TestWorld world_;
  Player player_{at_blocks(0.5, 0.01, 0.5), 0.0, 0.0, 0.0};
  Interaction hands_;
};

TEST_F(InteractionTest, DiggingTakesTheBlocksTimeWhateverTheFrameLength) {
  look(0.0, -45.0);
  const int frames = dig();
  EXPECT_NEAR(frames * kFrame, world::dig_seconds(block::kStone), 1.5 * kFrame);
  // As a few long frames.
  frame({});
  double seconds = 0.0;
  const IVec3 voxel = hands_.pick()->voxel;
  while (world_.block(0, voxel) == block::kStone) {
    frame({.dig = true}, 0.2);
    seconds += 0.2;
    ASSERT_LT(seconds, 5.0);
  }
  EXPECT_NEAR(seconds, world::dig_seconds(block::kStone), 0.2);
}

TEST_F(InteractionTest, WithoutRepeatingOneBlockIsDugAndOnePlacedAPress) {
  look(0.0, -45.0);
  const auto hold = [&](const HandIntent& intent) {
    const std::size_t before = world_.islands[0].edits.size();
    for (int i = 0; i < 120; ++i) frame(intent);
    return world_.islands[0].edits.size() - before;
  };
  EXPECT_EQ(hold({.dig = true, .repeats = false}), 1u);
  EXPECT_EQ(hold({}), 0u);
  EXPECT_EQ(hold({.dig = true, .repeats = false}), 1u);
  EXPECT_GT(hold({.dig = true}), 1u);
  hands_.hotbar().take(block::kGlass);
  look(90.0, -30.0);
  const auto glass = [&] {
    return std::count_if(world_.islands[0].edits.begin(), world_.islands[0].edits.end(),
                         [](const auto& edit) { return edit.second == block::kGlass; });
  };
  hold({.place = true, .repeats = false});
  EXPECT_EQ(glass(), 1);
  hold({.place = true, .repeats = false});
  EXPECT_EQ(glass(), 1);  // still held
  hold({});
  hold({.place = true, .repeats = false});
  EXPECT_EQ(glass(), 2);
}

TEST_F(InteractionTest, LettingGoOrLookingElsewhereBeginsAnew) {
  look(0.0, -45.0);
  frame({});
  for (int i = 0; i < 5; ++i) frame({.dig = true});
  const double progress = hands_.dig_progress();
  EXPECT_GT(progress, 0.1);
  frame({});
  EXPECT_EQ(hands_.dig_progress(), 0.0);
  for (int i = 0; i < 5; ++i) frame({.dig = true});
  look(90.0, -45.0);
  frame({.dig = true});
  EXPECT_LT(hands_.dig_progress(), progress);
}

TEST_F(InteractionTest, PlantsAndTorchesThatLoseTheirHoldComeDownInTheSameAct) {
  world_.set_block(0, {0, 0, 3}, block::kTallGrass);
  world_.set_block(0, {1, -1, 3}, world::kAir);
  world_.set_block(0, {1, -2, 3}, world::kAir);    // nothing below the torch
  world_.set_block(0, {1, -1, 3}, block::kTorch);  // held by the block to be dug, and others
  world_.set_block(0, {2, -1, 3}, world::kAir);
  world_.set_block(0, {1, -1, 4}, world::kAir);
  world_.set_block(0, {1, -1, 2}, world::kAir);
  const EditAct act = dig_act(world_, 0, {0, -1, 3});
  ASSERT_EQ(act.size(), 3u);
  EXPECT_EQ(act[0].voxel, (IVec3{0, -1, 3}));
  EXPECT_EQ(act[1].before, block::kTallGrass);
  EXPECT_EQ(act[2].before, block::kTorch);
  // With another hold the torch stays.
  world_.set_block(0, {1, -2, 3}, block::kStone);
  EXPECT_EQ(dig_act(world_, 0, {0, -1, 3}).size(), 2u);
}

TEST_F(InteractionTest, WaterAndAirAreNotDug) {
  world_.set_block(0, {0, 0, 3}, block::kWater);
  EXPECT_TRUE(dig_act(world_, 0, {0, 0, 3}).empty());
  EXPECT_TRUE(dig_act(world_, 0, {0, 5, 3}).empty());
}

TEST_F(InteractionTest, PlacesAgainstThePickedFace) {
  look(0.0, -40.0);
  hands_.hotbar().blocks[0] = block::kPlanks;
  frame({});
  const Pick ground = hands_.pick().value();
  EXPECT_EQ(ground.face, 2);
  frame({.place = true});
  EXPECT_EQ(at(ground.voxel.x, ground.voxel.y + 1, ground.voxel.z), block::kPlanks);
  // What is picked now is the new block, already within the frame.
  EXPECT_EQ(hands_.pick()->block, block::kPlanks);
}

TEST_F(InteractionTest, NobodyIsWalledInAndNoBlockGoesIntoAnotherIsland) {
  look(0.0, -90.0);
  hands_.hotbar().blocks[0] = block::kPlanks;
  frame({.place = true});
  EXPECT_EQ(at(0, 0, 0), world::kAir);
  EXPECT_TRUE(hands_.stands_in_way());
  for (int i = 0; i < 120; ++i) {
    frame({.place = true});
    EXPECT_FALSE(hands_.stands_in_way()) << "said once a press";
  }
  frame({});
  frame({.place = true});
  EXPECT_TRUE(hands_.stands_in_way());
  // A torch stops nobody: it may stand where they stand.
  hands_.hotbar().blocks[0] = block::kTorch;
  frame({});
  frame({.place = true});
  EXPECT_EQ(at(0, 0, 0), block::kTorch);
  EXPECT_FALSE(hands_.stands_in_way());
  // A second island, turned, with a stone just over the ground three blocks ahead.
  world_.islands.push_back({[](double) { return turning(at_blocks(0.5, 0.0, 3.5), 0.6, 1.0); },
                            [](IVec3 v) {
                              return v == IVec3{0, 0, 0} ? block::kStone : block::kAirBlock;
                            }});
  const Pick below{0, {0, -1, 3}, block::kStone, 2, 3.0};
  EXPECT_TRUE(place_act(world_, below, block::kPlanks, 0.0).empty());
  const Pick beside{0, {0, -1, 6}, block::kStone, 2, 3.0};
  EXPECT_EQ(place_act(world_, beside, block::kPlanks, 0.0).size(), 1u);
}

TEST_F(InteractionTest, ThingsNeedTheirHoldWherePlaced) {
  const Pick ceiling{0, {0, 3, 3}, block::kStone, 3, 3.0};  // its lower face
  world_.set_block(0, {0, 3, 3}, block::kStone);
  EXPECT_TRUE(place_act(world_, ceiling, block::kTorch, 0.0).empty());
  EXPECT_FALSE(place_act(world_, ceiling, block::kLamp, 0.0).empty());
  const Pick side{0, {0, 3, 3}, block::kStone, 4, 3.0};
  EXPECT_FALSE(place_act(world_, side, block::kTorch, 0.0).empty());
  EXPECT_TRUE(place_act(world_, side, block::kFern, 0.0).empty());
  // A plant gives way, a torch does not.
  world_.set_block(0, {5, 0, 5}, block::kTallGrass);
  const EditAct over =
      place_act(world_, {0, {5, 0, 5}, block::kTallGrass, 2, 3.0}, block::kLamp, 0.0);
  ASSERT_EQ(over.size(), 1u);
  EXPECT_EQ(over[0].voxel, (IVec3{5, 0, 5}));
  world_.set_block(0, {6, 0, 5}, block::kTorch);
  EXPECT_TRUE(place_act(world_, {0, {6, -1, 5}, block::kStone, 2, 3.0}, block::kLamp, 0.0).empty());
}

TEST_F(InteractionTest, HoldingPlacesOneBlockAPeriod) {
  look(0.0, -30.0);
  hands_.hotbar().blocks[0] = block::kGlass;
  frame({});
  const int frames = static_cast<int>(kPlacePeriod * 2.5 / kFrame);
  for (int i = 0; i < frames; ++i) frame({.place = true});
  EXPECT_EQ(hands_.history().undoable(), 3u);
}

TEST_F(InteractionTest, AnyRowOfActsIsTakenBackAndDoneAgainExactly) {
  std::mt19937 random(23);
  std::vector<std::map<IVec3, BlockId>> states{world_.islands[0].edits};
  const auto voxels = [&] {
    std::map<IVec3, BlockId> now;
    for (const auto& [voxel, id] : world_.islands[0].edits)
      if (id != *plain(voxel)) now[voxel] = id;
    return now;
  };
  for (int round = 0; round < 4000 && states.size() < 60; ++round) {
    look(static_cast<double>(random() % 360), -20.0 - static_cast<double>(random() % 50));
    hands_.hotbar().selected = static_cast<int>(random() % kHotbarSlots);
    const std::size_t before = hands_.history().undoable();
    frame({.dig = random() % 2 == 0, .place = random() % 2 == 0}, 2.0);
    ASSERT_LE(hands_.history().undoable(), before + 2);
    // One frame may dig and place: look at rows of whole frames only when one act was made.
    if (hands_.history().undoable() == before + 1) states.push_back(voxels());
    if (hands_.history().undoable() == before + 2) {
      frame({.undo = true});
      states.push_back(voxels());
    }
  }
  ASSERT_EQ(states.size(), 60u);
  // The two-act frames have left something to redo; a new act forgets it.
  look(10.0, -60.0);
  for (std::size_t i = states.size() - 1; i > 0; --i) {
    ASSERT_EQ(voxels(), states[i]) << i;
    frame({.undo = true});
  }
  EXPECT_EQ(voxels(), states[0]);
  EXPECT_EQ(hands_.history().undoable(), 0u);
  for (std::size_t i = 1; i < states.size(); ++i) {
    frame({.redo = true});
    ASSERT_EQ(voxels(), states[i]) << i;
  }
}

TEST_F(InteractionTest, UndoLeavesAloneWhatSomeoneElseChangedAndWhereSomeoneStands) {
  look(0.0, -50.0);
  ASSERT_GT(dig(), 0);
  const IVec3 hole = world_.islands[0].edits.begin()->first;
  world_.set_block(0, hole, block::kGlass);
  frame({.undo = true});
  EXPECT_EQ(*world_.block(0, hole), block::kGlass);
  // Dig the ground under the feet, fall into the hole, take it back: not while standing there.
  look(0.0, -90.0);
  ASSERT_GT(dig(), 0);
  player_.advance(1.0, {}, world_);
  EXPECT_EQ(at(0, -1, 0), world::kAir);
  frame({.undo = true});
  EXPECT_EQ(at(0, -1, 0), world::kAir);
}

TEST_F(InteractionTest, ARefusedUndoWaitsUntilItCanBeDone) {
  look(0.0, -50.0);
  ASSERT_GT(dig(), 0);
  const IVec3 hole = world_.islands[0].edits.begin()->first;
  world_.refuses = true;  // as out of reach
  frame({.undo = true});
  EXPECT_TRUE(hands_.replay_refused());
  EXPECT_EQ(hands_.history().undoable(), 1u);
  world_.refuses = false;
  frame({.redo = true});
  EXPECT_FALSE(hands_.replay_refused());
  EXPECT_EQ(*world_.block(0, hole), world::kAir) << "there is nothing to do again";
  frame({.undo = true});
  EXPECT_FALSE(hands_.replay_refused());
  EXPECT_EQ(*world_.block(0, hole), block::kStone);
  world_.refuses = true;
  frame({.redo = true});
  EXPECT_TRUE(hands_.replay_refused());
  world_.refuses = false;
  frame({.redo = true});
  EXPECT_EQ(*world_.block(0, hole), world::kAir);
}

TEST_F(InteractionTest, AnActThatSomethingElseUndidDoesNotBarTheOneBefore) {
  look(0.0, -50.0);
  ASSERT_GT(dig(), 0);
  const IVec3 first = world_.islands[0].edits.begin()->first;
  look(90.0, -50.0);
  ASSERT_GT(dig(), 0);
  for (const auto& [voxel, id] : world_.islands[0].edits)
    if (voxel != first) world_.set_block(0, voxel, block::kGlass);
  frame({.undo = true});
  EXPECT_FALSE(hands_.replay_refused());
  EXPECT_EQ(*world_.block(0, first), block::kStone);
  EXPECT_EQ(hands_.history().undoable(), 0u);
}

TEST_F(InteractionTest, ARefusedEditIsNoAct) {
  world_.refuses = true;
  look(0.0, -45.0);
  EXPECT_EQ(dig(), -1);
  EXPECT_EQ(hands_.history().undoable(), 0u);
  EXPECT_TRUE(world_.islands[0].edits.empty());
}

TEST(Hotbar, ScrollsAroundTheEndsAndTakesBlocks) {
  Hotbar bar;
  bar.scroll(-1);
  EXPECT_EQ(bar.selected, kHotbarSlots - 1);
  bar.scroll(kHotbarSlots * 3 + 1);
  EXPECT_EQ(bar.selected, 0);
  bar.take(bar.blocks[4]);
  EXPECT_EQ(bar.selected, 4);
  bar.take(block::kObsidian);
  EXPECT_EQ(bar.held(), block::kObsidian);
  EXPECT_EQ(bar.selected, 4);
}

TEST(EditHistory, ForgetsTheOldestActs) {
  TestWorld world;
  world.islands.push_back({[](double) { return still({}); }, plain});
  EditHistory history;
  for (int i = 0; i < 300; ++i)
    EXPECT_TRUE(history.perform({{0, {i, 5, 0}, world::kAir, block::kStone}}, world));
  EXPECT_EQ(history.undoable(), EditHistory::kMaxActs);
}

}  // namespace
}  // namespace skerry::game
