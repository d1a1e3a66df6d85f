#include "game/client/helm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "game/client/island_name.h"
#include "tests/folder.h"
#include "tests/world/made_islands.h"
#include "world/motion/motion.h"
#include "world/store/world_file.h"

namespace skerry::game {
namespace {

using world::IVec3;

constexpr std::uint64_t kRaft = 5, kRock = 6;

/// A raft of 3x1x3 blocks, and to the south (+z) a rock of 16,000 that lies still.
class HelmTest : public testing::Test {
 protected:
  void SetUp() override {
    write_world();
    auto session = Session::open(path_);
    ASSERT_TRUE(session) << session.error().message;
    session_ = std::make_unique<SessionClient>(*std::move(session));
    helm_.take(kRaft);
  }

  void write_world() const {
    world::WorldInfo info{"Raft", "1", {}};
    info.desc.seed = 1;
    info.desc.generated = false;
    auto file = world::WorldFile::create(path_, info);
    ASSERT_TRUE(file);
    auto transaction = (*file)->begin();
    const auto put = [&](std::uint64_t id, world::WorldPos origin, const std::vector<IVec3>& all) {
      world::IslandSpec spec;
      spec.id = id;
      spec.origin = origin;
      transaction.put_island({spec, true, {}});
      for (const auto& [at, chunk] : world::chunks_from(all, world::block::kStone))
        transaction.put_chunk(id, at, chunk);
    };
    put(kRaft, {}, world::voxels_in({-1, 0, -1}, {2, 1, 2}));
    put(kRock, world::blocks(0.0, 0.0, 4.0), world::voxels_in({-20, -5, 0}, {20, 5, 40}));
    ASSERT_TRUE(transaction.commit());
  }

  world::Pose pose() const { return *session_->world()->pose(kRaft, session_->time_s()); }

  /// A frame as PlayLoop's. @return the line for the player.
  std::optional<std::string> frame(double forward, double seconds) {
    SavedPlay here;  // on the raft, wherever it is
    here.player.island = kRaft;
    here.player.feet = world::moved(pose().origin, {0.5, 1.0, 0.5});
    here.eye.position = world::moved(here.player.feet, {0.0, 1.62, 0.0});
    session_->send(PlayerMoved{here});
    Intent intent;
    intent.move.y = forward;
    helm_.steer(intent, 0.0, *session_);  // yaw 0 looks along +z
    const double before_s = session_->time_s();
    const world::Pose before = pose();
    session_->advance(seconds);
    (void)session_->hear();
    moved_ = glm::length(world::difference_blocks(pose().origin, before.origin));
    watched_s_ = session_->time_s() - before_s;
    return helm_.watch(before, pose(), watched_s_);
  }
  /// Shapes of islands come from another thread: until then nothing moves.
  void wait_until_it_moves() {
    for (int i = 0; i < 5000 && helm_.speed() == 0.0; ++i) {
      (void)frame(1.0, 1.0 / 60.0);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_GT(helm_.speed(), 0.0) << "the raft never moved";
  }

  Folder folder_;
  std::filesystem::path path_ = folder_ / "raft.skerry";
  std::unique_ptr<SessionClient> session_;
  Helm helm_;
  double moved_ = 0.0, watched_s_ = 0.0;  // blocks, seconds of the last frame
};

TEST_F(HelmTest, ShowsTheSpeedAtWhichTheIslandMovesAndSaysThatItIsHeldFast) {
  wait_until_it_moves();
  std::vector<std::string> lines;
  double held_after_s = -1.0, now_s = 0.0, fastest = 0.0, bump = 0.0;
  for (int i = 0; i < 600; ++i) {
    const auto line = frame(1.0, 1.0 / 60.0);
    now_s += watched_s_;
    if (line) lines.push_back(*line);
    ASSERT_NEAR(helm_.speed() * watched_s_, moved_, 1e-9);
    fastest = std::max(fastest, helm_.speed());
    EXPECT_TRUE(helm_.bump() == 0.0 || bump == 0.0) << "it is heard once";
    bump = std::max(bump, helm_.bump());
    if (helm_.held_fast() && held_after_s < 0.0) held_after_s = now_s;
  }
  ASSERT_EQ(lines.size(), 2u) << "each thing is said once: " << testing::PrintToString(lines);
  EXPECT_EQ(lines[0].rfind(island_name(kRaft) + " bumped into something at ", 0), 0u) << lines[0];
  EXPECT_EQ(lines[1],
            island_name(kRaft) + " is held fast by another island: back off, rise or turn");
  // 2 blocks/s^2 over the gap of 2 blocks are 2.8 blocks/s, and take 1.4 s.
  EXPECT_GT(fastest, 2.0);
  EXPECT_LT(fastest, 2.83);
  EXPECT_EQ(bump, fastest);
  EXPECT_GT(held_after_s, 0.6);
  EXPECT_LT(held_after_s, 4.0);
  EXPECT_TRUE(helm_.held_fast());
  EXPECT_LT(helm_.speed(), 0.05);
  // Whoever lets go of the keys is not held, and backing off frees it: with what the engines give
  // it from then on, not with what they gave while it stood.
  (void)frame(0.0, 1.0 / 60.0);
  EXPECT_FALSE(helm_.held_fast());
  for (int i = 1; i <= 120; ++i) {
    EXPECT_EQ(frame(-1.0, 1.0 / 60.0), std::nullopt) << i;
    EXPECT_LT(helm_.speed(), 0.25 + world::kThrust * i / 60.0) << i;
  }
  EXPECT_FALSE(helm_.held_fast());
  EXPECT_GT(helm_.speed(), 1.0);
}

/// One that strains against a corner may find room for a thousandth of a block after seconds.
TEST_F(HelmTest, WhatIsHeldAndJerksIsStillHeld) {
  Intent ahead;
  ahead.move.y = 1.0;
  helm_.steer(ahead, 0.0, *session_);
  world::Pose at = pose();
  int lines = 0;
  const auto go = [&](double blocks, double angle) {
    const world::Pose before = at;
    at.origin = world::moved(at.origin, {0.0, 0.0, blocks});
    at.rotation = glm::angleAxis(angle, glm::dvec3{0.0, 1.0, 0.0}) * at.rotation;
    lines += helm_.watch(before, at, 1.0 / 60.0).has_value();
  };
  for (int i = 0; i < 40; ++i) go(0.0, 0.0);
  EXPECT_TRUE(helm_.held_fast());
  for (int i = 0; i < 120; ++i) {
    go(i == 60 ? 0.003 : 0.0, i == 60 ? 0.0014 : 0.0);
    EXPECT_TRUE(helm_.held_fast()) << i;
  }
  EXPECT_EQ(lines, 1);
  // What is free is never held, not even where its way or its turn goes the other way.
  for (const bool turns : {false, true}) {
    for (int i = -120; i < 120; ++i) {
      const double speed = i / 60.0;
      go(turns ? 0.0 : speed * world::kThrust / 60.0,
         turns ? speed * world::kTurnThrust / 60.0 : 0);
      EXPECT_TRUE(i < -110 || !helm_.held_fast()) << i << (turns ? " turning" : "");
    }
  }
}

/// The world has 60 ticks a second; frames between two of them see it move as well.
TEST_F(HelmTest, FramesShorterThanATickAreNoBumps) {
  wait_until_it_moves();
  for (int i = 0; i < 200; ++i) {
    const double was = helm_.speed();
    EXPECT_EQ(frame(-1.0, 1.0 / 240.0), std::nullopt) << i;
    if (i > 20) {
      EXPECT_NEAR(helm_.speed(), was, 0.05) << i;
    }
  }
  EXPECT_GT(helm_.speed(), 0.5);
}

TEST_F(HelmTest, LeavingItSwitchesTheEnginesOff) {
  wait_until_it_moves();
  for (int i = 0; i < 60; ++i) (void)frame(-1.0, 1.0 / 60.0);
  helm_.leave(*session_);
  EXPECT_FALSE(helm_.island());
  EXPECT_EQ(helm_.speed(), 0.0);
  const auto speed_over = [&](double seconds) {
    const double before_s = session_->time_s();
    const world::Pose before = pose();
    session_->advance(seconds);
    return glm::length(world::difference_blocks(pose().origin, before.origin)) /
           (session_->time_s() - before_s);
  };
  const double at_first = speed_over(0.1);
  EXPECT_GT(at_first, 0.1);
  EXPECT_LT(speed_over(0.4), at_first) << "only the air acts on it";
}

}  // namespace
}  // namespace skerry::game
