#include "world/islands/dig.h"

#include <gtest/gtest.h>

namespace skerry::world {
namespace {

TEST(Dig, NoBlockTakesLongAndPlantsTakeNoTime) {
  for (BlockId id = 0; id < block::kBuiltInCount; ++id) {
    EXPECT_GE(dig_seconds(id), 0.0);
    EXPECT_LE(dig_seconds(id), 1.5) << block_types()[id].name;
    EXPECT_EQ(dig_seconds(id) == 0.0, block_kind(id) == BlockKind::kPlant)
        << block_types()[id].name;
  }
  EXPECT_LT(dig_seconds(block::kOakLeaves), dig_seconds(block::kDirt));
  EXPECT_LT(dig_seconds(block::kDirt), dig_seconds(block::kOakLog));
  EXPECT_LT(dig_seconds(block::kOakLog), dig_seconds(block::kStone));
  EXPECT_LT(dig_seconds(block::kStone), dig_seconds(block::kObsidian));
}

TEST(Dig, WhatHandsTakeAndWhatGivesWay) {
  for (BlockId id = 0; id < block::kBuiltInCount; ++id) {
    EXPECT_EQ(can_dig(id), id != kAir && id != block::kWater);
    // Nothing that carries a player gives way to what is placed.
    EXPECT_FALSE(can_replace(id) && is_solid(id)) << block_types()[id].name;
  }
  EXPECT_TRUE(can_replace(block::kTallGrass));
  EXPECT_FALSE(can_replace(block::kTorch));
  EXPECT_FALSE(can_replace(block::kLava));
}

TEST(Dig, OnlyPlantsAndTorchesNeedAHold) {
  for (BlockId id = 0; id < block::kBuiltInCount; ++id) {
    const Support expected = id == block::kTorch                   ? Support::kFace
                             : block_kind(id) == BlockKind::kPlant ? Support::kGround
                                                                   : Support::kNone;
    EXPECT_EQ(support_of(id), expected) << block_types()[id].name;
  }
}

}  // namespace
}  // namespace skerry::world
