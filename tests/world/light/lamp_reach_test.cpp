#include "world/light/lamp_reaches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "tests/world/light/voxel_rooms.h"
#include "world/light/base/face_records.h"

namespace skerry::world {
namespace {

using test::beside;
using test::chunk_holding;
using test::chunks_of;
using test::Voxels;

constexpr float kRange = 14.0f;

/// Lights a lamp in a stone voxel, a little within one of its faces.
struct Lamp {
  IVec3 voxel{};
  glm::vec3 place{};  // lattice
};
Lamp lamp_at(IVec3 voxel, int face) {
  const FaceAxes axes(face);
  Lamp lamp{voxel, glm::vec3(voxel.x, voxel.y, voxel.z) + 0.5f};
  lamp.place[axes.own] += 0.45f * static_cast<float>(axes.sign);
  return lamp;
}

LampReach::Bricks reach_of(const Voxels& stone, const Lamp& lamp, float range = kRange) {
  const IVec3 chunk = chunk_holding(lamp.voxel);
  const glm::vec3 corner(glm::ivec3(chunk.x, chunk.y, chunk.z) * kChunkEdge);
  return LampReach(chunks_of(stone)).of(chunk, {lamp.place - corner, range}).lit;
}

/// Whether a line passes through the inside of a stone voxel other than the lamp's: each against
/// its cube, by slabs, in double precision.
bool hidden(const Voxels& stone, const Lamp& lamp, glm::dvec3 from) {
  const glm::dvec3 way = glm::dvec3(lamp.place) - from;
  return std::any_of(stone.begin(), stone.end(), [&](IVec3 v) {
    if (v == lamp.voxel) return false;
    double enter = 0.0, leave = 1.0;
    for (int a = 0; a < 3; ++a) {
      const double low = (a == 0 ? v.x : a == 1 ? v.y : v.z) - from[a], high = low + 1.0;
      if (std::abs(way[a]) < 1e-12) {
        if (low >= 0.0 || high <= 0.0) return false;
        continue;
      }
      enter = std::max(enter, std::min(low / way[a], high / way[a]));
      leave = std::min(leave, std::max(low / way[a], high / way[a]));
    }
    return leave - enter > 1e-9;
  });
}

glm::dvec3 on_face(IVec3 v, int face, double b, double c) {
  const FaceAxes axes(face);
  glm::dvec3 p(v.x, v.y, v.z);
  p[axes.own] += axes.sign > 0 ? 1.0 : 0.0;
  p[axes.b] += b;
  p[axes.c] += c;
  return p;
}

TEST(LampReach, HoldsEveryFaceThatALineFromTheLampReaches) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto within = [&](int low, int count) { return low + static_cast<int>(random() % count); };
  int lit = 0, dark = 0;
  for (int round = 0; round < 24; ++round) {
    Voxels stone;
    // About a corner of chunks, at negative coordinates too.
    for (int i = 0; i < 10 << round % 6; ++i)
      stone.insert({within(-7, 14), within(57, 14), within(-71, 14)});
    const IVec3 voxel{within(-4, 8), within(60, 8), within(-68, 8)};
    stone.insert(voxel);
    const int lamp_face = within(0, 6);
    if (stone.contains(beside(voxel, lamp_face))) continue;
    const Lamp lamp = lamp_at(voxel, lamp_face);
    const LampReach::Bricks bricks = reach_of(stone, lamp);
    for (const IVec3& v : stone) {
      for (int face = 0; face < 6; ++face) {
        const IVec3 front = beside(v, face);
        if (stone.contains(front)) continue;
        const FaceAxes axes(face);
        bool seen = false;
        for (int i = 0; i < 24 && !seen; ++i) {
          const glm::dvec3 p = on_face(v, face, share(random), share(random));
          const double before = axes.sign * (lamp.place[axes.own] - p[axes.own]);
          seen = before > 0.0 && glm::distance(p, glm::dvec3(lamp.place)) < kRange &&
                 !hidden(stone, lamp, p);
        }
        if (seen) {
          ++lit;
          EXPECT_TRUE(bricks.at(v)) << round << ": " << v.x << ' ' << v.y << ' ' << v.z;
          EXPECT_TRUE(bricks.at(front)) << round << ": " << v.x << ' ' << v.y << ' ' << v.z;
        } else if (!bricks.at(v) && !bricks.at(front)) {
          ++dark;
        }
      }
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dark, 300) << "a bound that holds everything bounds nothing";
}

/// The walls of a box whose inside is `edge` wide, from a corner on.
Voxels room(IVec3 low, int edge) {
  Voxels stone;
  for (int x = -1; x <= edge; ++x)
    for (int y = -1; y <= edge; ++y)
      for (int z = -1; z <= edge; ++z)
        if (std::min({x, y, z}) == -1 || std::max({x, y, z}) == edge)
          stone.insert({low.x + x, low.y + y, low.z + z});
  return stone;
}

TEST(LampReach, ASealedRoomKeepsItsLight) {
  Voxels stone = room({60, 60, 60}, 6);  // over the corner of eight chunks
  const Lamp lamp = lamp_at({62, 59, 62}, 2);
  // Beside the room, lit if its wall were open.
  for (int i = 0; i < 12; ++i) stone.insert({58 + i, 70, 62});
  LampReach::Bricks bricks = reach_of(stone, lamp, 30.0f);
  EXPECT_TRUE(bricks.at({62, 66, 62})) << "the ceiling";
  EXPECT_FALSE(bricks.at({62, 70, 62})) << "what lies beyond it";
  stone.erase({62, 66, 62});
  bricks = reach_of(stone, lamp, 30.0f);
  EXPECT_TRUE(bricks.at({62, 70, 62})) << "through the hole";
}

TEST(LampReach, FacesThatLookAwayAreDark) {
  Voxels stone;
  for (int x = 0; x < 32; ++x)
    for (int z = 0; z < 32; ++z) stone.insert({x, 20, z});
  // Below a floor that ends: its upper side is never lit, whatever way round the edge is open.
  stone.insert({30, 10, 16});
  const LampReach::Bricks bricks = reach_of(stone, lamp_at({30, 10, 16}, 0), 40.0f);
  ASSERT_FALSE(bricks.empty());
  EXPECT_TRUE(bricks.at({30, 20, 16})) << "its lower side";
  ASSERT_LE(bricks.edge_log2, 2);
  EXPECT_FALSE(bricks.at({16, 24, 16})) << "the bricks above";
}

TEST(LampReach, NothingInRangeIsNoBrick) {
  const Lamp lamp = lamp_at({3, 3, 3}, 2);
  EXPECT_TRUE(reach_of({{3, 3, 3}}, lamp, 0.02f).empty());
  EXPECT_EQ(reach_of({{3, 3, 3}, {3, 8, 3}}, lamp), reach_of({{3, 8, 3}, {3, 3, 3}}, lamp));
}

TEST(LampReach, ALongRangeHasCoarserBricks) {
  Voxels stone;
  for (int x = 0; x < 150; x += 2)
    for (int z = 0; z < 150; z += 2) stone.insert({x, (x * 7 + z * 3) % 20, z});
  stone.insert({70, 40, 70});
  const LampReach::Bricks fine = reach_of(stone, lamp_at({70, 40, 70}, 3), 24.0f),
                          coarse = reach_of(stone, lamp_at({70, 40, 70}, 3), 200.0f);
  EXPECT_LT(fine.edge_log2, coarse.edge_log2);
  for (const IVec3& v : stone) EXPECT_TRUE(coarse.at(v) || !fine.at(v));
}

TEST(LampReach, EntersWhatAStepAwayFromTheLampLeadsTo) {
  std::mt19937 random(5);
  const IVec3 voxel{3, 2, -4};
  for (int round = 0; round < 6; ++round) {
    Voxels stone{voxel};
    for (int i = 0; i < 60 << round; ++i)
      stone.insert({static_cast<int>(random() % 12) - 3, static_cast<int>(random() % 12) - 4,
                    static_cast<int>(random() % 12) - 10});
    const Lamp lamp = lamp_at(voxel, 2);
    const glm::vec3 corner(vector_of(corner_of(chunk_holding(voxel))));
    constexpr float kShort = 6.0f;  // bricks of one voxel
    const LampReach::Found found =
        LampReach(chunks_of(stone), voxel + IVec3{-9, -9, -9}, voxel + IVec3{9, 9, 9})
            .of(chunk_holding(voxel), {lamp.place - corner, kShort});
    ASSERT_EQ(found.entered.edge_log2, 0);
    // Voxel by voxel, the nearest along the axes first.
    Voxels entered{voxel};
    for (int steps = 1; steps <= 21; ++steps)
      for (int x = -7; x <= 7; ++x)
        for (int y = -7; y <= 7; ++y)
          for (int z = -7; z <= 7; ++z) {
            const IVec3 at = voxel + IVec3{x, y, z};
            if (std::abs(x) + std::abs(y) + std::abs(z) != steps || stone.contains(at)) continue;
            const auto back = [](int by) { return by > 0 ? -1 : by < 0 ? 1 : 0; };
            if ((x != 0 && entered.contains(at + IVec3{back(x), 0, 0})) ||
                (y != 0 && entered.contains(at + IVec3{0, back(y), 0})) ||
                (z != 0 && entered.contains(at + IVec3{0, 0, back(z)})))
              entered.insert(at);
          }
    for (int x = -7; x <= 7; ++x)
      for (int y = -7; y <= 7; ++y)
        for (int z = -7; z <= 7; ++z) {
          const IVec3 at = voxel + IVec3{x, y, z};
          const glm::vec3 low(vector_of(at));
          const glm::vec3 off = lamp.place - glm::clamp(lamp.place, low, low + 1.0f);
          if (std::abs(glm::dot(off, off) - kShort * kShort) < 1e-3f) continue;  // rounding
          EXPECT_EQ(found.entered.at(at),
                    entered.contains(at) && glm::dot(off, off) < kShort * kShort)
              << round << ": " << x << ' ' << y << ' ' << z;
          EXPECT_EQ(found.entered.any_within(at, at), found.entered.at(at));
        }
  }
}

TEST(LampReach, AnyWithinLooksAtAllOfABox) {
  Voxels stone{{3, 3, 3}};
  for (int x = 0; x < 40; ++x)
    for (int z = 0; z < 40; ++z) stone.insert({x, 0, z});
  const LampReach::Bricks lit = reach_of(stone, lamp_at({3, 3, 3}, 3), 30.0f);
  std::mt19937 random(2);
  int some = 0, none = 0;
  for (int i = 0; i < 300; ++i) {
    const IVec3 low{static_cast<int>(random() % 50) - 8, static_cast<int>(random() % 12) - 6,
                    static_cast<int>(random() % 50) - 8};
    const IVec3 high = low + IVec3{static_cast<int>(random() % 9), static_cast<int>(random() % 9),
                                   static_cast<int>(random() % 9)};
    bool any = false;
    for (int x = low.x; x <= high.x; ++x)
      for (int y = low.y; y <= high.y; ++y)
        for (int z = low.z; z <= high.z; ++z) any |= lit.at({x, y, z});
    EXPECT_EQ(lit.any_within(low, high), any);
    ++(any ? some : none);
  }
  EXPECT_GT(std::min(some, none), 50);
}

TEST(LampReach, AfterEditsIsThatOfTheChunksAsTheyAre) {
  std::mt19937 random(8);
  const auto place = [&] {
    return IVec3{static_cast<int>(random() % 90), static_cast<int>(random() % 12),
                 static_cast<int>(random() % 90)};
  };
  Voxels stone;
  for (int i = 0; i < 9000; ++i) stone.insert(place());
  std::vector<IVec3> lamps;
  const auto chunks_now = [&] {
    LightChunks chunks = chunks_of(stone);
    for (const IVec3& v : lamps) {
      const IVec3 at = chunk_holding(v);
      LightChunk copy = *chunks.at(at);
      const IVec3 low = corner_of(at);
      copy.strong.push_back({glm::vec3(v.x - low.x, v.y - low.y, v.z - low.z) + 0.5f, 9.0f});
      chunks[at] = std::make_shared<const LightChunk>(std::move(copy));
    }
    return chunks;
  };
  for (int i = 0; i < 20; ++i) {
    lamps.push_back(place());
    stone.insert(lamps.back());
  }
  LightChunks before = chunks_now();
  LampReaches reaches = reaches_of(before);
  bool any_other = false;
  for (int round = 0; round < 40; ++round) {
    const IVec3 at = place();
    if (std::ranges::find(lamps, at) == lamps.end() && stone.erase(at) == 0) stone.insert(at);
    if (round % 8 == 7) {
      lamps.erase(lamps.begin() + static_cast<std::ptrdiff_t>(random() % lamps.size()));
      lamps.push_back(place());
      stone.insert(lamps.back());
    }
    const LightChunks now = chunks_now();
    const LampReaches old = reaches;
    reaches = reaches_after(now, before, reaches);
    ASSERT_TRUE(reaches == reaches_of(now)) << round;
    any_other |= reaches != old;
    before = now;
  }
  EXPECT_TRUE(any_other);
}

}  // namespace
}  // namespace skerry::world
