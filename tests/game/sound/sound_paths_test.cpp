#include "game/sound/sound_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <numeric>
#include <queue>
#include <random>
#include <vector>

#include "game/sound/room_echo.h"
#include "tests/game/sound/listen.h"

namespace skerry::game {
namespace {

namespace block = world::block;
using world::IVec3;

void fill(SoundRoom& room, IVec3 low, IVec3 high, world::BlockId block) {
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      for (int z = low.z; z < high.z; ++z) room.set({x, y, z}, block);
}

/// A closed box of air, its walls a block thick, in open air.
void wall_in(SoundRoom& room, IVec3 low, IVec3 high, world::BlockId block) {
  fill(room, {low.x - 1, low.y - 1, low.z - 1}, {high.x + 1, high.y + 1, high.z + 1}, block);
  fill(room, low, high, world::kAir);
}

double level_db(SoundPaths& paths, const glm::dvec3& listener, const glm::dvec3& source) {
  paths.listen_at(listener);
  return decibels(paths.path_from(source).gain());
}

TEST(SoundPaths, InTheOpenLoudnessFallsWithDistance) {
  const SoundRoom room;
  SoundPaths paths(room);
  const glm::dvec3 here{32.3, 30.7, 31.1};
  for (const double distance : {1.0, 2.0, 5.0, 16.0, 31.0, 100.0}) {
    const glm::dvec3 towards = glm::normalize(glm::dvec3{1.0, 0.3, -0.2});
    paths.listen_at(here);
    const SoundPath path = paths.path_from(here + distance * towards);
    EXPECT_NEAR(path.length, distance, 1e-9);
    EXPECT_NEAR(path.gain(), 1.0 / distance, 1e-9);
    EXPECT_NEAR(glm::dot(path.arrival, towards), 1.0, 1e-9);
    EXPECT_GE(path.cutoff_hz, 20000.0);
  }
  EXPECT_EQ(paths.floods(), 0u);  // what is in sight costs none
}

// Truth: breadth first over faces tells what is reached, Bellman and Ford over all neighbours by
// the same rule how far it is.
struct Truth {
  std::vector<int> cost;
  bool reached(IVec3 cell) const { return cost[SoundRoom::index(cell)] < 1 << 20; }
};
bool diagonal_is_open(const SoundRoom& room, IVec3 at, IVec3 by) {
  for (const int y : {0, by.y})
    for (const int x : {0, by.x})
      for (const int z : {0, by.z}) {
        const IVec3 cell{at.x + x, at.y + y, at.z + z};
        if (room.is_solid(cell)) return false;
      }
  return true;
}
Truth relax(const SoundRoom& room, IVec3 from, int edge) {
  Truth truth{std::vector<int>(SoundRoom::kCells, 1 << 20)};
  truth.cost[SoundRoom::index(from)] = 0;
  constexpr std::array<int, 4> kCost{0, 10, 14, 17};
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x)
        for (int z = 0; z < edge; ++z) {
          const IVec3 at{x, y, z};
          if (room.is_solid(at) || !truth.reached(at)) continue;
          for (int n = 0; n < 27; ++n) {
            const IVec3 by{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
            const IVec3 to{x + by.x, y + by.y, z + by.z};
            if (!SoundRoom::inside(to) || !diagonal_is_open(room, at, by)) continue;
            const int cost =
                truth.cost[SoundRoom::index(at)] +
                kCost[static_cast<std::size_t>(std::abs(by.x) + std::abs(by.y) + std::abs(by.z))];
            if (cost >= truth.cost[SoundRoom::index(to)]) continue;
            truth.cost[SoundRoom::index(to)] = cost;
            changed = true;
          }
        }
  }
  return truth;
}
std::vector<bool> breadth_first(const SoundRoom& room, IVec3 from) {
  std::vector<bool> seen(SoundRoom::kCells, false);
  std::queue<IVec3> due;
  due.push(from);
  seen[SoundRoom::index(from)] = true;
  constexpr std::array<IVec3, 6> kFaces{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  while (!due.empty()) {
    const IVec3 at = due.front();
    due.pop();
    for (const IVec3 by : kFaces) {
      const IVec3 to{at.x + by.x, at.y + by.y, at.z + by.z};
      if (!SoundRoom::inside(to) || room.is_solid(to) || seen[SoundRoom::index(to)]) continue;
      seen[SoundRoom::index(to)] = true;
      due.push(to);
    }
  }
  return seen;
}

TEST(SoundPaths, AgreeWithBruteForceInRandomRooms) {
  constexpr int kInner = 9;
  std::mt19937 dice(7);
  for (int round = 0; round < 20; ++round) {
    SoundRoom room;
    fill(room, {0, 0, 0}, {kInner + 2, kInner + 2, kInner + 2}, block::kStone);
    for (int y = 1; y <= kInner; ++y)
      for (int x = 1; x <= kInner; ++x)
        for (int z = 1; z <= kInner; ++z)
          if (dice() % 100 >= 25u + static_cast<unsigned>(round) * 3 / 2)
            room.set({x, y, z}, world::kAir);
    const IVec3 from{5, 5, 5};
    room.set(from, world::kAir);
    const Truth truth = relax(room, from, kInner + 2);
    const std::vector<bool> reached = breadth_first(room, from);
    SoundPaths paths(room);
    const glm::dvec3 listener = SoundRoom::middle_of(from) + glm::dvec3{0.2, -0.1, 0.3};
    paths.listen_at(listener);
    for (int y = 1; y <= kInner; ++y)
      for (int x = 1; x <= kInner; ++x)
        for (int z = 1; z <= kInner; ++z) {
          const IVec3 cell{x, y, z};
          if (room.is_solid(cell)) continue;
          const std::size_t index = SoundRoom::index(cell);
          ASSERT_EQ(paths.way_cost(cell) >= 0, reached[index]);
          if (reached[index]) {
            ASSERT_EQ(paths.way_cost(cell), truth.cost[index]);
          }
          const glm::dvec3 source = SoundRoom::middle_of(cell);
          const SoundPath path = paths.path_from(source);
          // Never shorter than the crow flies, never longer than over the voxels' middles.
          ASSERT_GE(path.length, glm::length(source - listener) - 1e-9);
          if (path.open && reached[index]) {
            ASSERT_LE(path.length, truth.cost[index] * 0.1 * 1.02 + 0.8);
          }
          if (!reached[index]) {
            ASSERT_FALSE(path.open);
            ASSERT_GE(path.loss_db, 40.0);
          }
          if (cell != from) {
            ASSERT_NEAR(glm::length(path.arrival), 1.0, 1e-9);
          }
        }
  }
}

TEST(SoundPaths, ASealedRoomIsDampedByFortyDecibelsWhateverItsWalls) {
  const glm::dvec3 source{31.5, 31.5, 31.5};
  std::mt19937 dice(3);
  for (const world::BlockId wall :
       {block::kStone, block::kDirt, block::kSand, block::kPlanks, block::kSnow, block::kGlass}) {
    SoundRoom room;
    wall_in(room, {29, 30, 29}, {34, 34, 34}, wall);
    SoundPaths paths(room);
    const SoundRoom none;
    SoundPaths open(none);
    for (int i = 0; i < 300; ++i) {
      const auto part = [&dice] { return 60.0 * static_cast<double>(dice()) / 4294967296.0 + 2.0; };
      const glm::dvec3 listener{part(), part(), part()};
      const glm::dvec3 off = glm::abs(listener - source);
      if (std::max({off.x, off.y, off.z}) < 4.0) continue;
      ASSERT_LE(level_db(paths, listener, source) - level_db(open, listener, source), -40.0);
    }
  }
}

// Voxels that only touch at an edge leave no gap: edges and corners of the shell may be missing.
TEST(SoundPaths, ARoomWithoutItsEdgesIsSealed) {
  SoundRoom room;
  wall_in(room, {30, 30, 30}, {33, 33, 33}, block::kPlanks);
  for (int a = 29; a <= 33; ++a)
    for (const int b : {29, 33})
      for (const int c : {29, 33}) {
        room.set({a, b, c}, world::kAir);
        room.set({b, a, c}, world::kAir);
        room.set({b, c, a}, world::kAir);
      }
  SoundPaths paths(room);
  for (const glm::dvec3 listener :
       {glm::dvec3{28.5, 28.5, 31.5}, glm::dvec3{28.0, 28.0, 28.0}, glm::dvec3{40.5, 22.5, 31.5}}) {
    paths.listen_at(listener);
    EXPECT_GE(paths.path_from({31.5, 31.5, 31.5}).loss_db, 40.0);
  }
}

TEST(SoundPaths, ThickerWallsDampMore) {
  double before = 0.0;
  for (const int thickness : {1, 2, 3}) {
    SoundRoom room;
    fill(room, {0, 0, 30}, {64, 64, 30 + thickness}, block::kPlanks);
    SoundPaths paths(room);
    const double level = level_db(paths, {32.5, 32.5, 25.5}, {32.5, 32.5, 36.5});
    if (before != 0.0) {
      EXPECT_NEAR(before - level, 42.0, 0.01) << thickness;
    }
    before = level;
  }
}

TEST(SoundPaths, AnOpenedRoomIsHeardAtOnceFromItsDoor) {
  SoundRoom room;
  wall_in(room, {29, 30, 29}, {34, 33, 34}, block::kStone);
  SoundPaths paths(room);
  const glm::dvec3 source{31.5, 30.5, 31.5}, listener{31.5, 31.5, 20.5};
  const double sealed = level_db(paths, listener, source);
  room.set({34, 31, 31}, world::kAir);  // a door in the wall towards +x, the listener is at -z
  const double opened = level_db(paths, listener, source);
  EXPECT_GT(opened, sealed + 25.0);
  const SoundPath path = paths.path_from(source);
  EXPECT_TRUE(path.open);
  EXPECT_GT(path.arrival.x, 0.2);  // round the corner, on the door's side
  EXPECT_GT(path.length, glm::length(source - listener));
  EXPECT_LT(path.cutoff_hz, 10000.0);
  room.set({34, 31, 31}, block::kStone);
  EXPECT_EQ(level_db(paths, listener, source), sealed);
}

// A wall up to the room's top and bottom, open beyond one edge: the shortest way bends there once.
TEST(SoundPaths, RoundACornerIsAsFarAsTheTightString) {
  SoundRoom room;
  fill(room, {0, 0, 32}, {32, 64, 33}, block::kStone);
  SoundPaths paths(room);
  const glm::dvec3 listener{22.5, 32.5, 24.5}, source{22.5, 32.5, 40.5};
  paths.listen_at(listener);
  const SoundPath path = paths.path_from(source);
  ASSERT_TRUE(path.open);
  // Ideal: by (32, 32) and (32, 33); the path keeps to middles of voxels, one beside them.
  const double ideal = 2.0 * std::hypot(9.5, 7.5) + 1.0;
  EXPECT_GE(path.length, ideal);
  EXPECT_LE(path.length, 1.10 * ideal);
  const glm::dvec3 to_corner = glm::normalize(glm::dvec3{9.5, 0.0, 7.5});
  EXPECT_GT(glm::dot(path.arrival, to_corner), 0.98);
  const double turned = 2.0 * std::atan2(9.5, 7.5) / (0.5 * std::numbers::pi);
  EXPECT_NEAR(path.loss_db, kCornerLossDb * turned, 1.5);
}

TEST(SoundPaths, LeavesDampALittleAndWaterMakesDull) {
  SoundRoom room;
  fill(room, {0, 0, 30}, {64, 64, 34}, block::kOakLeaves);
  SoundPaths paths(room);
  paths.listen_at({32.5, 32.5, 20.5});
  const SoundPath leaves = paths.path_from({32.5, 32.5, 40.5});
  EXPECT_TRUE(leaves.open);
  EXPECT_NEAR(leaves.loss_db, 4.0 * 1.5, 1e-9);

  SoundRoom sea;
  fill(sea, {0, 0, 0}, {64, 32, 64}, block::kWater);
  SoundPaths below(sea);
  below.listen_at({32.5, 20.5, 32.5});
  const SoundPath both = below.path_from({40.5, 20.5, 32.5});
  EXPECT_EQ(both.loss_db, 0.0);
  EXPECT_LE(both.cutoff_hz, kWaterCutoffHz);
  const SoundPath through = below.path_from({32.5, 40.5, 32.5});
  EXPECT_NEAR(through.loss_db, kSurfaceLossDb, 1e-9);
  EXPECT_LE(through.cutoff_hz, kWaterCutoffHz);
}

TEST(SoundPaths, OneFloodServesAllSourcesUntilSomethingChanges) {
  SoundRoom room;
  fill(room, {0, 0, 30}, {50, 64, 31}, block::kStone);
  SoundPaths paths(room);
  paths.listen_at({32.5, 32.5, 20.5});
  for (int i = 0; i < 20; ++i) (void)paths.path_from({20.5 + i, 32.5, 40.5});
  EXPECT_EQ(paths.floods(), 1u);
  paths.listen_at({32.7, 32.3, 20.9});  // the same voxel
  (void)paths.path_from({20.5, 32.5, 40.5});
  EXPECT_EQ(paths.floods(), 1u);
  room.set({1, 1, 1}, block::kStone);
  (void)paths.path_from({20.5, 32.5, 40.5});
  EXPECT_EQ(paths.floods(), 2u);
}

// A screen in open air: the flood runs until its bound.
TEST(SoundPaths, AFloodInTheOpenIsBounded) {
  SoundRoom room;
  fill(room, {26, 26, 40}, {38, 38, 41}, block::kStone);
  SoundPaths paths(room);
  std::vector<double> ms;
  for (int i = 0; i < 21; ++i) {
    paths.listen_at({30.5 + 2 * (i % 2), 32.5, 32.5});
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(paths.path_from({32.5, 32.5, 44.5}).open);
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
                     .count());
  }
  EXPECT_EQ(paths.floods(), 21u);
  int reached = 0;
  for (int i = 0; i < static_cast<int>(SoundRoom::kCells); ++i)
    reached += paths.way_cost({i / 64 % 64, i / 4096, i % 64}) >= 0;
  EXPECT_LT(reached, 2 * SoundPaths::kMostCells);
  std::sort(ms.begin(), ms.end());
  std::printf("flood in the open: median %.2f ms, p90 %.2f ms\n", ms[10], ms[18]);
}

/// A screen on the ground: what is beyond it is heard round its edges.
SoundRoom room_with_screen() {
  SoundRoom room;
  fill(room, {24, 20, 40}, {40, 40, 41}, block::kStone);
  fill(room, {0, 0, 0}, {64, 20, 64}, block::kStone);
  return room;
}

// Truth: paths whose flood begins where the listener is.
TEST(SoundPaths, AFloodFromBesideTheListenerServes) {
  const SoundRoom room = room_with_screen();
  SoundPaths walked(room);
  std::uint64_t fresh_floods = 0;
  double most_db = 0.0, most_deg = 0.0;
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 ear{29.5 + 0.1 * i, 31.9 + 0.02 * i, 35.5};
    walked.listen_at(ear);
    SoundPaths fresh(room);
    fresh.listen_at(ear);
    for (int source = 0; source < 16; ++source) {
      const glm::dvec3 at{26.5 + 3.0 * (source % 4), 24.5 + 2.0 * (source / 4), 43.5};
      const SoundPath path = walked.path_from(at), truth = fresh.path_from(at);
      ASSERT_TRUE(path.open && truth.open) << "not round the screen";
      most_db = std::max(most_db, std::abs(20.0 * std::log10(path.gain() / truth.gain())));
      most_deg = std::max(
          most_deg, glm::degrees(std::acos(std::min(1.0, glm::dot(path.arrival, truth.arrival)))));
    }
    fresh_floods += fresh.floods();
  }
  std::printf("floods %d of %d, off by %.2f dB and %.1f degrees at most\n",
              static_cast<int>(walked.floods()), static_cast<int>(fresh_floods), most_db, most_deg);
  EXPECT_LE(walked.floods(), 4u);
  EXPECT_LT(most_db, 3.0);
  EXPECT_LT(most_deg, 15.0);
}

TEST(InSight, IsWhatTheStraightWaySays) {
  std::mt19937 dice(11);
  SoundRoom room;
  for (int i = 0; i < 20000; ++i)
    room.set({int(dice() % 64), int(dice() % 64), int(dice() % 64)},
             dice() % 3 == 0 ? block::kWater : block::kStone);
  std::uniform_real_distribution<double> place(-4.0, 68.0);
  int open = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 from{place(dice), place(dice), place(dice)};
    const glm::dvec3 to = from + glm::dvec3{place(dice), place(dice), place(dice)} * 0.2;
    const bool sees = in_sight(room, from, to);
    ASSERT_EQ(sees, straight_way(room, from, to).open) << i;
    open += sees ? 1 : 0;
  }
  EXPECT_GT(open, 4000);
  EXPECT_LT(open, 16000);
}

// A listener behind the screen walks, sixty frames to six voxels.
TEST(SoundPaths, OfSixtyFourSourcesAreFoundInASmallPartOfAFrame) {
  const SoundRoom room = room_with_screen();
  SoundPaths paths(room);
  constexpr int kFrames = 60;
  std::vector<double> ms;
  int round = 0;
  for (int i = 0; i < kFrames; ++i) {
    paths.listen_at({29.5 + 0.1 * i, 32.5, 35.5});
    const auto begin = std::chrono::steady_clock::now();
    for (int source = 0; source < 64; ++source) {
      const glm::dvec3 at{25.5 + 2.0 * (source % 8), 23.5 + 2.0 * (source / 8), 44.5};
      round += paths.path_from(at).open ? 1 : 0;
    }
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
                     .count());
  }
  EXPECT_GT(round, kFrames * 32) << "not round the screen";
  EXPECT_LE(paths.floods(), 4u);
  const double mean_ms = std::accumulate(ms.begin(), ms.end(), 0.0) / kFrames;
  std::sort(ms.begin(), ms.end());
  std::printf("64 sources, a frame: median %.3f ms, mean %.3f ms, most %.2f ms\n", ms[kFrames / 2],
              mean_ms, ms.back());
  EXPECT_LT(ms[kFrames / 10], 5.0);
}

TEST(RoomEcho, MeasuresVolumeAndSurfaceOfABox) {
  for (const int edge : {4, 8, 16, 26}) {
    SoundRoom room;
    const int low = 32 - edge / 2, high = low + edge;
    fill(room, {0, 0, 0}, {64, 64, 64}, block::kStone);
    fill(room, {low, low, low}, {high, high, high}, world::kAir);
    for (const glm::dvec3 off : {glm::dvec3(0.0), glm::dvec3{0.31, -0.2, 0.12}}) {
      const RoomEcho echo = room_echo(room, glm::dvec3(32.0) + off * double(edge));
      EXPECT_NEAR(echo.volume, std::pow(edge, 3), 0.12 * std::pow(edge, 3)) << edge;
      EXPECT_NEAR(echo.surface, 6.0 * edge * edge, 0.12 * 6.0 * edge * edge) << edge;
      EXPECT_EQ(echo.open, 0.0);
      // Eyring with the box's own numbers.
      const double a = absorption_of(block::kStone);
      const double eyring = 0.161 * edge / (-6.0 * std::log(1.0 - a));
      EXPECT_NEAR(echo.decay_s, eyring, 0.25 * eyring) << edge;
    }
  }
}

TEST(RoomEcho, LargerCavesEchoLongerAndTheOpenNotAtAll) {
  const auto cave = [](int edge, world::BlockId wall) {
    SoundRoom room;
    fill(room, {0, 0, 0}, {64, 64, 64}, wall);
    fill(room, {32 - edge / 2, 32 - edge / 2, 32 - edge / 2},
         {32 + edge / 2, 32 + edge / 2, 32 + edge / 2}, world::kAir);
    return room_echo(room, {32.1, 32.2, 31.9});
  };
  EXPECT_LT(cave(4, block::kStone).decay_s, cave(8, block::kStone).decay_s);
  EXPECT_LT(cave(8, block::kStone).decay_s, cave(20, block::kStone).decay_s);
  EXPECT_LT(cave(8, block::kSnow).decay_s, 0.3 * cave(8, block::kStone).decay_s);
  EXPECT_LT(cave(20, block::kStone).level, cave(6, block::kStone).level);
  const SoundRoom sky;
  EXPECT_EQ(room_echo(sky, {32.1, 32.2, 31.9}).level, 0.0);
  SoundRoom field;
  fill(field, {0, 0, 0}, {64, 32, 64}, block::kStone);
  const RoomEcho open = room_echo(field, {32.5, 33.6, 32.5});
  EXPECT_GT(open.open, 0.4);
  EXPECT_LT(open.level, 0.02);
}

}  // namespace
}  // namespace skerry::game
