#include "world/light/sky_transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "tests/world/light/voxel_rooms.h"

namespace skerry::world {
namespace {

using test::beside;
using test::chunks_of;
using test::record_of;
using test::Voxels;

/// With white faces that reflect all.
SkyTransfer::Skies sky_of(const LightChunks& chunks) {
  FaceAlbedo white;
  white.fill(glm::vec3(1.0f));
  const std::vector<FaceAlbedo> albedo(block_types().size(), white);
  SkyTransfer transfer(chunks, albedo);
  for (int octant = 0; octant < kOctants; ++octant) transfer.look(octant);
  transfer.spread_lamps();
  for (int step = 0; step < BounceLight::kSteps; ++step)
    for (int part = 0; part < BounceLight::kParts; ++part) transfer.follow_bounces(step, part);
  return transfer.make_faces();
}

// Whether a half-line from a voxel's centre touches a closed cube, in exact integers: in units of
// 1/(2 * 4) of the way along the vector, whose components divide 4.
bool touches(IVec3 from, IVec3 d, IVec3 cube) {
  const std::array<int, 3> dir{d.x, d.y, d.z},
      to{cube.x - from.x, cube.y - from.y, cube.z - from.z};
  int enter = 0, leave = 1 << 28;
  for (std::size_t a = 0; a < 3; ++a) {
    const int sign = dir[a] < 0 ? -1 : 1, n = sign * dir[a], at = sign * to[a];
    enter = std::max(enter, (2 * at - 1) * (4 / n));
    leave = std::min(leave, (2 * at + 1) * (4 / n));
  }
  return enter <= leave;
}

TEST(SkyTransfer, SeesTheSkyExactlyWhereNoCubeTouchesTheRay) {
  std::mt19937 random(7);
  for (int round = 0; round < 6; ++round) {
    Voxels stone;
    const int count = 20 << round;
    for (int i = 0; i < count; ++i)
      stone.insert({static_cast<int>(random() % 12) - 5, static_cast<int>(random() % 10) + 58,
                    static_cast<int>(random() % 14) - 70});
    const LightChunks chunks = chunks_of(stone);
    SkyTransfer transfer(chunks);
    for (int octant = 0; octant < kOctants; ++octant) transfer.look(octant);
    for (const IVec3& v : stone) {
      for (int face = 0; face < 6; ++face) {
        const IVec3 front = beside(v, face);
        if (stone.contains(front)) continue;
        for (int octant = 0; octant < kOctants; ++octant) {
          for (int k = 0; k < 16; ++k) {
            const IVec3 d = sky_direction(octant, k);
            const bool blocked = std::any_of(stone.begin(), stone.end(), [&](const IVec3& cube) {
              return touches(front, d, cube);
            });
            ASSERT_EQ(transfer.seen(front, octant) >> k & 1, blocked ? 0 : 1)
                << round << ": " << front.x << ' ' << front.y << ' ' << front.z << " along " << d.x
                << ' ' << d.y << ' ' << d.z;
          }
        }
      }
    }
  }
}

// A room of random shape, closed by no more than the blocks that share a face with its air: they
// meet each other along edges and at corners only.
struct Room {
  Voxels air, walls;
};
Room random_room(std::mt19937& random) {
  Room room;
  // About a corner of chunks as often as not.
  const auto place = [&] {
    return static_cast<int>(random() % 8) - 4 + 64 * static_cast<int>(random() % 3);
  };
  std::vector<IVec3> grown{{place(), place(), place()}};
  room.air.insert(grown[0]);
  const std::size_t size = 1 + random() % 60;
  while (room.air.size() < size) {
    const IVec3 next = beside(grown[random() % grown.size()], static_cast<int>(random() % 6));
    if (room.air.insert(next).second) grown.push_back(next);
  }
  for (const IVec3& v : room.air)
    for (int face = 0; face < 6; ++face)
      if (!room.air.contains(beside(v, face))) room.walls.insert(beside(v, face));
  return room;
}

// SKERRY_ROOMS=10000 asks for the full count.
TEST(SkyTransfer, ASealedRoomIsExactlyDark) {
  const char* asked = std::getenv("SKERRY_ROOMS");
  const int rooms = asked ? std::atoi(asked) : 300;
  std::mt19937 random(11);
  int faces = 0, lit_outside = 0, lit_by_lamps = 0, lit_by_faces = 0;
  for (int i = 0; i < rooms; ++i) {
    const Room room = random_room(random);
    test::Lamps lamps;
    for (int k = 0; k < 40; ++k) {
      const IVec3 near =
          *std::next(room.walls.begin(), static_cast<int>(random() % room.walls.size()));
      const IVec3 lamp{near.x + static_cast<int>(random() % 7) - 3,
                       near.y + static_cast<int>(random() % 7) - 3,
                       near.z + static_cast<int>(random() % 7) - 3};
      if (!room.air.contains(lamp) && !room.walls.contains(lamp)) lamps.voxels.insert(lamp);
    }
    const SkyTransfer::Skies sky = sky_of(chunks_of(room.walls, lamps));
    for (const IVec3& wall : room.walls) {
      for (int face = 0; face < 6; ++face) {
        const std::vector<std::uint32_t> record = record_of(sky, wall, face);
        if (room.walls.contains(beside(wall, face))) continue;
        ASSERT_EQ(record.size(), 16u);
        const bool dark = std::all_of(record.begin(), record.end(), [](auto w) { return w == 0; });
        if (room.air.contains(beside(wall, face))) {
          ++faces;
          ASSERT_TRUE(dark) << "room " << i;
        } else {
          lit_outside += !dark;
          lit_by_lamps += record[8] != 0;
          lit_by_faces += record[12] != 0;
        }
      }
    }
  }
  EXPECT_GT(faces, 10 * rooms);
  EXPECT_GT(lit_outside, 10 * rooms);
  EXPECT_GT(lit_by_lamps, 10 * rooms);
  EXPECT_GT(lit_by_faces, rooms);
}

TEST(SkyTransfer, AnOpenPlaneSeesAllOfItsSky) {
  Voxels stone;
  for (int x = -40; x < 40; ++x)
    for (int z = -40; z < 40; ++z) stone.insert({x, 0, z});
  const SkyTransfer::Skies sky = sky_of(chunks_of(stone));
  for (const IVec3& v : stone)
    for (int face : {2, 3}) {
      const std::vector<std::uint32_t> record = record_of(sky, v, face);
      for (std::size_t i = 0; i < 8; ++i) ASSERT_EQ(record[i], 0xffffffffu);
    }
}

// At the foot of a wall without end half of the sky is left: both quarters on the wall's side are
// dark, the others are open.
TEST(SkyTransfer, AWallHidesTheQuartersBehindIt) {
  Voxels stone;
  for (int z = -70; z < 70; ++z) {
    for (int x = -60; x < 0; ++x) stone.insert({x, 0, z});
    for (int y = 1; y < 260; ++y) stone.insert({0, y, z});
  }
  const std::vector<std::uint32_t> record = record_of(sky_of(chunks_of(stone)), {-1, 0, 0}, 2);
  ASSERT_EQ(record.size(), 16u);
  // A face that looks up has z as its first axis and x as its second: bit 1 of a quarter is towards
  // -x, away from the wall. The corners at -x are shared with voxels further from the wall, which
  // see over nothing either.
  for (std::size_t corner = 0; corner < 4; ++corner) {
    EXPECT_EQ(record[2 * corner + 1], 0xffffffffu) << "open quarters, corner " << corner;
    // Along the wall some lines run beside it for a while and pass its ends 70 blocks away.
    for (int lobe = 0; lobe < 4; ++lobe)
      EXPECT_EQ(record[2 * corner] >> (8 * lobe) & 255u, 0u) << corner << ' ' << lobe;
  }
}

// Light by the formula of shaders/shared/light.h, at the faces before which a voxel is.
TEST(LampLight, FallsOffAsLightsDo) {
  const AirVolume air = air_volume_of(chunks_of({{0, 0, 0}}));
  const WeakLamp lamp{{0.5f, 4.5f, 0.5f}, {2.0f, 1.0f, 0.5f}, 8.0f};
  const LampLight above = light_of_lamp(air, lamp, {0, 1, 0});
  const float window = std::pow(1.0f - std::pow(3.5f / 8.0f, 4.0f), 2.0f);
  EXPECT_NEAR(above[2].x, 2.0f / 12.25f * window, 1e-5f);
  EXPECT_EQ(above[3], glm::vec3(0.0f));
  const LampLight aside = light_of_lamp(air, lamp, {4, 1, 0});
  const auto at = [](float across, float along) {
    const float d2 = across * across + along * along;
    return along / std::pow(d2, 1.5f) * std::pow(1.0f - d2 * d2 / 4096.0f, 2.0f);
  };
  EXPECT_NEAR(aside[2].y, at(4.0f, 3.5f), 1e-5f);
  EXPECT_NEAR(aside[1].y, at(3.0f, 4.5f), 1e-5f);
  // Beside the lamp, as ground is from which a glowing plant grows.
  EXPECT_NEAR(light_of_lamp(air, lamp, {1, 4, 0})[2].y, at(1.0f, 0.5f), 1e-5f);
  EXPECT_EQ(light_of_lamp(air, lamp, {0, -5, 0})[2], glm::vec3(0.0f)) << "behind the stone";
  EXPECT_EQ(light_of_lamp(air, lamp, {8, 4, 0})[1], glm::vec3(0.0f)) << "out of range";
}

// Two blocks that meet along an edge or at a corner stop what passes exactly between them.
TEST(LampLight, DoesNotPassBetweenBlocksThatTouch) {
  const WeakLamp lamp{{3.5f, 3.5f, 3.5f}, glm::vec3(1.0f), 20.0f};
  const AirVolume edge = air_volume_of(chunks_of({{2, 3, 3}, {3, 2, 3}}));
  const AirVolume corner = air_volume_of(chunks_of({{2, 3, 3}, {3, 2, 2}}));
  const AirVolume none = air_volume_of(chunks_of({{9, 9, 9}}));
  const auto lit = [&](const AirVolume& air, IVec3 at) {
    return light_of_lamp(air, lamp, at)[0] != glm::vec3(0.0f);
  };
  EXPECT_TRUE(lit(none, {2, 2, 3}) && lit(none, {2, 2, 2}) && lit(none, {0, 0, 0}));
  EXPECT_FALSE(lit(edge, {2, 2, 3}));
  EXPECT_FALSE(lit(corner, {2, 2, 2}));
  EXPECT_FALSE(lit(corner, {0, 0, 0}));
}

TEST(SkyTransfer, DoesNotDependOnTheOrderOfQuads) {
  std::mt19937 random(3);
  Voxels stone;
  for (int i = 0; i < 3000; ++i)
    stone.insert({static_cast<int>(random() % 40), static_cast<int>(random() % 40),
                  static_cast<int>(random() % 90)});
  const LightChunks chunks = chunks_of(stone);
  LightChunks shuffled;
  for (const auto& [at, chunk] : chunks) {
    LightChunk copy = *chunk;
    std::shuffle(copy.quads.begin(), copy.quads.end(), random);
    shuffled[at] = std::make_shared<const LightChunk>(std::move(copy));
  }
  EXPECT_TRUE(std::ranges::equal(
      sky_of(chunks), sky_of(shuffled),
      [](const auto& a, const auto& b) { return a.first == b.first && *a.second == *b.second; }));
}

// Each lobe has the cells of its patterns, and all of its light when all of them are seen.
TEST(SkyRays, LobesAreSeenByTheWeightsOfTheirPatterns) {
  for (int face = 0; face < 6; ++face) {
    std::array<double, 8> whole{}, odd{};
    std::array<std::uint32_t, 8> seen_whole{}, seen_odd{};
    const int axis = face / 2;
    for (int octant = 0; octant < kOctants; ++octant) {
      if ((octant >> axis & 1) != face % 2) continue;
      add_lobes_seen(axis, octant, 0xffffu, seen_whole);
      add_lobes_seen(axis, octant, 0xaaaau, seen_odd);
      for (std::size_t k = 0; k < 16; ++k) {
        whole[lobe_of(axis, octant, k)] += lobe_weights(axis)[k];
        if (k % 2 == 1) odd[lobe_of(axis, octant, k)] += lobe_weights(axis)[k];
      }
    }
    for (std::size_t lobe = 0; lobe < 8; ++lobe) {
      EXPECT_EQ(seen_whole[lobe], 65280u) << face << ' ' << lobe;
      EXPECT_NEAR(seen_odd[lobe] / 65280.0, odd[lobe] / whole[lobe], 1e-4) << face << ' ' << lobe;
    }
  }
}

// Of an upright face, what is below the level is a lobe, and high parts of the sky have their own:
// directions of one lobe are at like heights.
TEST(SkyRays, LobesOfUprightFacesAreSplitByHeight) {
  for (const int axis : {0, 2})
    for (int octant = 0; octant < kOctants; ++octant)
      for (std::size_t k = 0; k < 16; ++k) {
        const glm::dvec3 p = glm::normalize(glm::dvec3(shared::kSkyPatterns[k]));
        const std::size_t part = lobe_of(axis, octant, k) % 4;
        const bool below = (octant & 2) != 0;
        EXPECT_EQ(part, below ? 3u : p.y > 0.6 ? 0u : p.y > 0.3 ? 1u : 2u) << axis << ' ' << octant;
        EXPECT_EQ(lobe_of(axis, octant, k) / 4, octant >> (2 - axis) & 1u) << axis << ' ' << octant;
      }
}

// The weights of the lobes are integrals over the cells of the patterns: done again by a sum over a
// grid that the table was not made with.
TEST(SkyRays, WeightsAreTheIntegralsOfTheirCells) {
  constexpr int kGrid = 400;
  std::array<std::array<double, 16>, 3> share{};
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const double x = (i + 0.5) / kGrid, turn = (j + 0.5) / kGrid * std::numbers::pi / 2.0;
      const double flat = std::sqrt(1.0 - x * x);
      const glm::dvec3 d{x, flat * std::cos(turn), flat * std::sin(turn)};
      std::size_t nearest = 0;
      double most = 0.0;
      for (std::size_t k = 0; k < 16; ++k) {
        const double cosine = glm::dot(d, glm::normalize(glm::dvec3(shared::kSkyPatterns[k])));
        if (cosine > most) most = cosine, nearest = k;
      }
      for (int axis = 0; axis < 3; ++axis)
        share[static_cast<std::size_t>(axis)][nearest] += d[axis] * 2.0 / (kGrid * kGrid);
    }
  }
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < 16; ++k)
      EXPECT_NEAR(lobe_weights(axis)[k] / 65280.0, share[static_cast<std::size_t>(axis)][k], 2e-3)
          << axis << ' ' << k;
}

}  // namespace
}  // namespace skerry::world
