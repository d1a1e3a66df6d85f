#include "world/light/sky_transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "tests/world/light/voxel_rooms.h"
#include "world/light/base/shared_exponent.h"

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

bool passes(glm::dvec3 from, IVec3 d, IVec3 cube) {
  const glm::dvec3 way(d.x, d.y, d.z), low(cube.x, cube.y, cube.z);
  double enter = 0.0, leave = 1e300;
  for (int a = 0; a < 3; ++a) {
    const double one = (low[a] - from[a]) / way[a], other = (low[a] + 1.0 - from[a]) / way[a];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter < leave;
}

TEST(SkyTransfer, SeesTheSkyExactlyWhereTheLinePassesNoCube) {
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
        for (std::size_t fan = 0; fan < kFans; ++fan) {
          for (int k = 0; k < 16; ++k) {
            const IVec3 d = sky_direction(octant_of(fan), k);
            const glm::dvec3 start = test::start_of_line(front, d, axis_of(fan));
            const bool blocked = std::any_of(stone.begin(), stone.end(), [&](const IVec3& cube) {
              return passes(start, d, cube);
            });
            ASSERT_EQ(transfer.seen(front, fan) >> k & 1, blocked ? 0 : 1)
                << round << ": " << front.x << ' ' << front.y << ' ' << front.z << " along " << d.x
                << ' ' << d.y << ' ' << d.z << ", axis " << axis_of(fan);
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

/// Mean over the side behind a voxel, which a face of a direction is at, of what a point of
/// intensity 1 gives it: a sum over its parts.
double mean_over_face(glm::dvec3 lamp, IVec3 voxel, int face) {
  constexpr int kParts = 200;
  const int axis = face / 2;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; j < kParts; ++j) {
      glm::dvec3 place(voxel.x, voxel.y, voxel.z);
      place[axis] += face % 2 == 0 ? 0.0 : 1.0;
      place[(axis + 1) % 3] += (i + 0.5) / kParts;
      place[(axis + 2) % 3] += (j + 0.5) / kParts;
      const glm::dvec3 way = lamp - place;
      const double along = face % 2 == 0 ? way[axis] : -way[axis];
      sum += std::max(0.0, along) / std::pow(glm::dot(way, way), 1.5);
    }
  return sum / (kParts * kParts);
}

TEST(LampLight, IsTheMeanOverFacesOfWhatAPointGives) {
  const AirVolume air = air_volume_of(chunks_of({{20, 20, 20}}));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> even(-5.0, 6.0);
  for (int i = 0; i < 60; ++i) {
    // The first ones are in the voxel, or next to it.
    const glm::dvec3 place =
        glm::dvec3(even(random), even(random), even(random)) * (i < 20   ? 0.15
                                                                : i < 40 ? 0.4
                                                                         : 1.0);
    const WeakLamp lamp{glm::vec3(place), {4.0f, 2.0f, 1.0f}, 1000.0f};
    const LampLight light = light_of_lamp(air, lamp, {0, 0, 0});
    for (int face = 0; face < 6; ++face) {
      const double mean = mean_over_face(glm::dvec3(lamp.place), {0, 0, 0}, face);
      // From 4 blocks on as if the face were a point.
      const glm::vec3& found = light[static_cast<std::size_t>(face)];
      EXPECT_NEAR(found.x, 4.0 * mean, 4.0 * (glm::length(place - 0.5) < 3.5 ? 2e-3 : 4e-2) * mean)
          << place.x << ' ' << place.y << ' ' << place.z << ' ' << face;
      EXPECT_EQ(found.y, 0.5f * found.x);
      EXPECT_EQ(found.z, 0.25f * found.x);
    }
  }
}

// Between corners light is interpolated. A point's own light at corners would give 37% too much
// there from one to two voxels on, and 15% from two to three.
TEST(LampLight, IsOnAverageBetweenCornersWhatAPointGives) {
  Voxels stone;
  for (int x = -12; x < 12; ++x)
    for (int z = -12; z < 12; ++z) stone.insert({x, 0, z});
  const SkyTransfer::Skies faces = sky_of(chunks_of(stone, {{{0, 1, 0}}, 40.0f}));
  struct Ring {
    double within, bias, rms;  // voxels; most of the mean
    double count = 0.0, right = 0.0, off = 0.0, squares = 0.0;
  };
  std::array<Ring, 4> rings{
      {{2.0, 0.05, 0.2}, {3.0, 0.02, 0.08}, {5.0, 0.02, 0.04}, {7.0, 0.02, 0.03}}};
  constexpr int kSteps = 8;
  for (int x = -7; x < 7; ++x)
    for (int z = -7; z < 7; ++z) {
      const std::vector<std::uint32_t> record = record_of(faces, {x, 0, z}, 2);
      std::array<double, 4> corners{};
      for (std::size_t corner = 0; corner < 4; ++corner)
        corners[corner] = static_cast<double>(unpack_shared_exponent(record[8 + corner]).y);
      for (int step = 0; step < kSteps * kSteps; ++step) {
        const double u = (step % kSteps + 0.5) / kSteps, v = (step / kSteps + 0.5) / kSteps;
        const double distance = std::hypot(x + u - 0.5, z + v - 0.5, 0.5);
        if (distance < 1.0) continue;  // light of a point has no bound
        const auto ring =
            std::ranges::find_if(rings, [distance](const Ring& r) { return distance < r.within; });
        if (ring == rings.end()) continue;
        const double between = (corners[0] * (1.0 - v) + corners[1] * v) * (1.0 - u) +
                               (corners[2] * (1.0 - v) + corners[3] * v) * u,
                     right = 0.5 / (distance * distance * distance);
        ring->count += 1.0;
        ring->right += right;
        ring->off += between - right;
        ring->squares += (between - right) * (between - right);
      }
    }
  for (const Ring& ring : rings) {
    EXPECT_NEAR(ring.off / ring.right, 0.0, ring.bias) << "within " << ring.within;
    EXPECT_LT(std::sqrt(ring.squares / ring.count), ring.rms * ring.right / ring.count)
        << "within " << ring.within;
  }
}

// Faces take up all directions about a lamp, wherever it stands.
TEST(LampLight, AllOfItFallsOnTheWallsOfAClosedRoom) {
  const IVec3 size{4, 3, 5};
  Voxels room;
  for (int x = -1; x <= size.x; ++x)
    for (int y = -1; y <= size.y; ++y)
      for (int z = -1; z <= size.z; ++z)
        if (x < 0 || y < 0 || z < 0 || x == size.x || y == size.y || z == size.z)
          room.insert({x, y, z});
  const AirVolume air = air_volume_of(chunks_of(room));
  for (const glm::vec3 place : {glm::vec3(1.5f, 0.5f, 2.5f), glm::vec3(3.9f, 2.2f, 0.3f)}) {
    const WeakLamp lamp{place, glm::vec3(1.0f), 1000.0f};
    double sum = 0.0;
    for (int x = 0; x < size.x; ++x)
      for (int y = 0; y < size.y; ++y)
        for (int z = 0; z < size.z; ++z) {
          const LampLight light = light_of_lamp(air, lamp, {x, y, z});
          for (int face = 0; face < 6; ++face)
            if (room.contains(beside({x, y, z}, face ^ 1)))
              sum += static_cast<double>(light[static_cast<std::size_t>(face)].x);
        }
    EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 0.01 * 4.0 * std::numbers::pi) << place.x;
  }
}

TEST(LampLight, EndsAtItsRangeAndBehindWalls) {
  const AirVolume air = air_volume_of(chunks_of({{0, 0, 0}}));
  const WeakLamp lamp{{0.5f, 4.5f, 0.5f}, {2.0f, 1.0f, 0.5f}, 8.0f};
  // The window of shaders/shared/light.h, at the middle of the face.
  for (const IVec3 voxel : {IVec3{0, 1, 0}, IVec3{4, 1, 0}}) {
    const double d2 = voxel.x * voxel.x + 3.5 * 3.5;
    EXPECT_NEAR(
        light_of_lamp(air, lamp, voxel)[2].x,
        2.0 * mean_over_face({0.5, 4.5, 0.5}, voxel, 2) * std::pow(1.0 - d2 * d2 / 4096.0, 2.0),
        2e-3)
        << voxel.x;
  }
  EXPECT_EQ(light_of_lamp(air, lamp, {0, 1, 0})[3], glm::vec3(0.0f)) << "looks away";
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

// A quarter of what a lamp sends, and of the lines to the sky: by a hash that differs from set to
// set, and from that of leaves.
TEST(SkyTransfer, PlantsStopAQuarterOfWhatPassesTheirVoxel) {
  const AirVolume air = air_volume_of(chunks_of({{0, 0, 0}}, {}, {{1, 5, 1}, {1, 4, 1}}));
  const AirVolume none = air_volume_of(chunks_of({{0, 0, 0}}));
  const WeakLamp lamp{{1.5f, 7.5f, 1.5f}, glm::vec3(1.0f), 100.0f};
  const auto at = [&](const AirVolume& volume, IVec3 voxel) {
    return static_cast<double>(light_of_lamp(volume, lamp, voxel)[2].x);
  };
  EXPECT_NEAR(at(air, {1, 2, 1}), 0.75 * 0.75 * at(none, {1, 2, 1}), 1e-6);
  EXPECT_NEAR(at(air, {1, 4, 1}), 0.75 * at(none, {1, 4, 1}), 1e-6) << "not by its own";
  std::array<int, kLeafSets> stopped{};
  int beside_others = 0, count = 0;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y, ++count)
      for (int set = 0; set < kLeafSets; ++set) {
        const std::uint64_t bits = plants_that_stop(set, x, y, 3);
        stopped[static_cast<std::size_t>(set)] += std::popcount(bits);
        beside_others += std::popcount(bits & plants_that_stop((set + 1) % kLeafSets, x, y, 3));
      }
  for (const int bits : stopped) EXPECT_NEAR(bits / (64.0 * count), 0.25, 0.01);
  EXPECT_NEAR(beside_others / (64.0 * count * kLeafSets), 0.0625, 0.005);
}

// A plant on open ground takes a quarter of the sky of the ground below it, itself sees as much of
// it as that would, and sends its own light down: among white surfaces nothing is lost by it.
TEST(SkyTransfer, APlantDimsTheGroundBelowItAndLightsIt) {
  Voxels stone;
  for (int x = -12; x < 12; ++x)
    for (int z = -12; z < 12; ++z) stone.insert({x, 0, z});
  const SkyTransfer::Skies sky = sky_of(chunks_of(stone, {}, {{0, 1, 0}}));
  const std::vector<std::uint32_t> ground = record_of(sky, {0, 0, 0}, 2),
                                   plant = record_of(sky, {0, 1, 0}, 2);
  ASSERT_EQ(ground.size(), 16u);
  ASSERT_EQ(plant.size(), 16u);
  for (std::size_t word = 0; word < 8; ++word)
    for (int shift = 0; shift < 32; shift += 8)
      // A corner is the mean of four voxels, one of them the plant's.
      EXPECT_NEAR((plant[word] >> shift & 255u) - (ground[word] >> shift & 255u), 255.0 / 16.0,
                  1.0);
  // Under an even sky of radiance 1, light is pi where nothing hides the sky.
  const auto bounced = [](const std::vector<std::uint32_t>& record) {
    const std::uint32_t c = record[12];
    return (c & 511u) * std::exp2(static_cast<double>(c >> 27) - 24.0) * (record[13] & 255u) /
           255.0 * std::sqrt(4.0 * std::numbers::pi);
  };
  EXPECT_NEAR(bounced(ground) - bounced(plant), std::numbers::pi / 16.0, 0.02);
}

// Of a lamp's light the ground below a plant has a quarter less, and what the plant sends of it:
// among white surfaces nothing is lost or gained. A sixteenth of that is at a corner, the mean of
// four voxels.
TEST(LampLight, NoneIsLostOrGainedByAPlantAmongWhiteSurfaces) {
  Voxels stone;
  for (int x = -12; x < 12; ++x)
    for (int z = -12; z < 12; ++z) stone.insert({x, 0, z});
  const test::Lamps lamp{{{0, 4, 0}}, 20.0f};
  const std::vector<std::uint32_t> bare = record_of(sky_of(chunks_of(stone, lamp)), {0, 0, 0}, 2);
  const SkyTransfer::Skies sky = sky_of(chunks_of(stone, lamp, {{0, 1, 0}}));
  const std::vector<std::uint32_t> ground = record_of(sky, {0, 0, 0}, 2),
                                   plant = record_of(sky, {0, 1, 0}, 2);
  for (std::size_t corner = 8; corner < 12; ++corner) {
    const auto light = [corner](const std::vector<std::uint32_t>& record) {
      return static_cast<double>(unpack_shared_exponent(record[corner]).y);
    };
    EXPECT_GT(light(bare), 0.0);
    EXPECT_NEAR(light(ground) / light(bare), 1.0, 0.01) << corner;
    EXPECT_NEAR(light(plant) / light(bare), 1.0, 0.01) << corner;
  }
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

// A line that runs along an edge of a block for no length is stopped by it as often as not, on
// whichever side of the line the block is.
TEST(SkyRays, HalfOfTheLinesThatTouchAnEdgePassOnEitherSide) {
  int ties = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 16; ++k)
      for (int third = 0; third < 3; ++third) {  // of the edges that run along it
        std::array<int, 2> first{};              // by whether signs of the other two are the same
        for (int octant = 0; octant < kOctants; ++octant) {
          const IVec3 d = sky_direction(octant, k);
          const std::vector<LineVoxel> line = line_voxels(d, axis);
          const int a = (third + 1) % 3, b = (third + 2) % 3;
          const bool alike = (octant >> a & 1) == (octant >> b & 1);
          IVec3 before{};
          for (std::size_t i = 0; i < line.size(); before = line[i++].offset) {
            const IVec3 step{line[i].offset.x - before.x, line[i].offset.y - before.y,
                             line[i].offset.z - before.z};
            ASSERT_EQ(std::abs(step.x) + std::abs(step.y) + std::abs(step.z), 1);
            for (std::size_t j = i + 1; j < line.size(); ++j) {
              if (line[j].entered != line[i].entered) break;
              if (line[i].axis == third || line[j].axis == third) continue;
              first[alike] += line[i].axis == a ? 1 : -1;
              ++ties;
            }
          }
          ASSERT_EQ(before, d);
        }
        EXPECT_EQ(first[0], 0) << axis << ' ' << k << ' ' << third;
        EXPECT_EQ(first[1], 0) << axis << ' ' << k << ' ' << third;
      }
  EXPECT_GT(ties, 100);
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
