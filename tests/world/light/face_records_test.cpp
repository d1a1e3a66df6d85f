#include "world/light/base/face_records.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/world/light/voxel_rooms.h"
#include "world/light/sky_transfer.h"

namespace skerry::world {
namespace {

using test::chunks_of;
using test::Voxels;

ChunkSky sky_of(const LightChunks& chunks) {
  SkyTransfer transfer(chunks);
  for (int octant = 0; octant < kOctants; ++octant) transfer.look(octant);
  transfer.spread_lamps();
  return *transfer.make_faces().at({0, 0, 0});
}

Voxels ground(std::mt19937& random) {
  Voxels stone;
  for (int x = 4; x < 44; ++x)
    for (int z = 4; z < 44; ++z)
      for (int y = 0; y < 4 + static_cast<int>(random() % 3); ++y) stone.insert({x, y, z});
  return stone;
}

TEST(FaceRecords, FacesThatStayKeepTheirRecords) {
  std::mt19937 random(2);
  Voxels stone = ground(random);
  const ChunkSky before = sky_of(chunks_of(stone));
  for (int y = 3; y < 8; ++y) stone.erase({20, y, 20});
  const LightChunks after = chunks_of(stone);
  const ChunkSky guess = inherit_faces(before, after.at({0, 0, 0})->quads);
  std::size_t kept = 0, fresh = 0;
  for (const IVec3& v : stone)
    for (int face = 0; face < 6; ++face) {
      const auto now = find_record(guess, v, face), then = find_record(before, v, face);
      if (!now) continue;
      if (!then) {
        ++fresh;
        EXPECT_NE(guess.texels[*now], glm::uvec4(0)) << "a hole in lit ground is guessed to be lit";
        continue;
      }
      ++kept;
      for (std::size_t i = 0; i < shared::kIndirectRecordTexels; ++i)
        ASSERT_EQ(guess.texels[*now + i], before.texels[*then + i]);
    }
  EXPECT_GT(kept, 1000u);
  EXPECT_GE(fresh, 1u);
}

// A guess names exactly the faces that there are.
TEST(FaceRecords, AGuessHasTheFacesOfTheExactLight) {
  std::mt19937 random(3);
  Voxels stone = ground(random);
  const ChunkSky before = sky_of(chunks_of(stone));
  for (int i = 0; i < 200; ++i)
    stone.erase({4 + static_cast<int>(random() % 40), static_cast<int>(random() % 6),
                 4 + static_cast<int>(random() % 40)});
  const LightChunks after = chunks_of(stone);
  const ChunkSky exact = sky_of(after), guess = inherit_faces(before, after.at({0, 0, 0})->quads);
  EXPECT_EQ(exact.table, guess.table);
  EXPECT_EQ(exact.texels.size(), guess.texels.size());
  for (const IVec3& v : stone)
    for (int face = 0; face < 6; ++face)
      ASSERT_EQ(find_record(exact, v, face), find_record(guess, v, face));
}

// New faces deep inside dark rock are guessed to be dark.
TEST(FaceRecords, NothingNearIsDark) {
  Voxels stone;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      for (int z = 0; z < 20; ++z) stone.insert({x, y, z});
  const ChunkSky before = sky_of(chunks_of(stone));
  stone.erase({10, 10, 10});
  const ChunkSky guess = inherit_faces(before, chunks_of(stone).at({0, 0, 0})->quads);
  const auto record = find_record(guess, {10, 9, 10}, 2);
  ASSERT_TRUE(record);
  EXPECT_EQ(guess.texels[*record], glm::uvec4(0));
}

// More faces than there were: all that were keep their record, new ones have the guess of a chunk
// that has both.
TEST(FaceRecords, MoreFacesHaveTheGuessesOfAllTogether) {
  std::mt19937 random(4);
  Voxels stone = ground(random);
  const LightChunks chunks = chunks_of(stone);
  const ChunkSky before = sky_of(chunks);
  const std::vector<shared::Quad>& own = chunks.at({0, 0, 0})->quads;
  std::vector<shared::Quad> more, all = own;
  for (int i = 0; i < 400; ++i) {
    const auto x = random() % 64, y = random() % 12, z = random() % 64, face = random() % 6;
    more.push_back({static_cast<std::uint32_t>(x | y << 6 | z << 12),
                    static_cast<std::uint32_t>(face << shared::kFaceShift)});
  }
  all.insert(all.end(), more.begin(), more.end());
  EXPECT_EQ(with_faces(before, more), inherit_faces(before, all));
  EXPECT_EQ(with_faces(before, own), before);
}

// As asked of every voxel about each face.
TEST(FaceRecords, LitFacesHaveARecordBesideThem) {
  std::mt19937 random(5);
  const ChunkSky before = sky_of(chunks_of(ground(random)));
  std::size_t lit = 0;
  for (int i = 0; i < 2000; ++i) {
    const IVec3 at{static_cast<int>(random() % 64), static_cast<int>(random() % 12),
                   static_cast<int>(random() % 64)};
    bool expected = false;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          for (int face = 0; face < 6 && x * x + y * y + z * z <= 2; ++face)
            expected |= find_record(before, at + IVec3{x, y, z}, face).has_value();
    const shared::Quad quad{static_cast<std::uint32_t>(at.x | at.y << 6 | at.z << 12), 0};
    ASSERT_EQ(lit_faces(before, {&quad, 1}).size(), expected ? 1u : 0u);
    lit += expected;
  }
  EXPECT_GT(lit, 200u);
  EXPECT_LT(lit, 1800u);
}

}  // namespace
}  // namespace skerry::world
