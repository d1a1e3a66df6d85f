#include "world/light/base/face_changes.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "world/voxel/blocks.h"

namespace skerry::world {
namespace {

/// Faces looking up, by place: the block that each is of.
using Plane = std::map<std::pair<int, int>, BlockId>;
constexpr int kEdge = 24, kHeight = 5;

/// Faces as quads of strips of random length along z, rows in order.
std::vector<shared::Quad> strips(const Plane& faces, std::mt19937& random) {
  std::vector<shared::Quad> out;
  for (auto at = faces.begin(); at != faces.end();) {
    const auto [x, z] = at->first;
    const BlockId block = at->second;
    int length = 0;
    const int most = 1 + static_cast<int>(random() % 6);
    while (at != faces.end() && at->first == std::pair(x, z + length) && at->second == block &&
           length < most)
      ++at, ++length;
    // u of a face that looks up is along x, v along z.
    out.push_back({static_cast<std::uint32_t>(x | kHeight << 6 | z << 12 | (length - 1) << 24),
                   static_cast<std::uint32_t>(block | 2 << shared::kFaceShift)});
  }
  return out;
}

Plane placed(const std::vector<BlockFace>& faces) {
  Plane out;
  for (const BlockFace& face : faces) {
    EXPECT_EQ(face.drawn.direction, 2);
    EXPECT_EQ(face.drawn.voxel.y, kHeight);
    EXPECT_TRUE(out.emplace(std::pair(face.drawn.voxel.x, face.drawn.voxel.z), face.block).second);
  }
  return out;
}

TEST(FaceChanges, AreThoseOfSetsOfFacesHoweverTheyAreMerged) {
  std::mt19937 random(3);
  constexpr std::array<BlockId, 2> kBlocks{block::kStone, block::kSand};
  Plane before;
  for (int x = 0; x < kEdge; ++x)
    for (int z = 0; z < kEdge; ++z)
      if (random() % 4 != 0) before[{x, z}] = kBlocks[random() % 2];
  for (int round = 0; round < 30; ++round) {
    Plane now = before, came, went, turned;
    for (int i = 0; i < round; ++i) {
      const std::pair place(static_cast<int>(random() % kEdge), static_cast<int>(random() % kEdge));
      if (random() % 2 == 0)
        now.erase(place);
      else
        now[place] = kBlocks[random() % 2];
    }
    for (const auto& [place, block] : now) {
      if (!before.contains(place))
        came[place] = block;
      else if (before.at(place) != block)
        turned[place] = block;
    }
    for (const auto& [place, block] : before)
      if (!now.contains(place)) went[place] = block;
    std::vector<shared::Quad> old_quads = strips(before, random), quads = strips(now, random);
    if (round % 3 == 0) std::shuffle(quads.begin(), quads.end(), random);
    const FaceChanges changes = face_changes(old_quads, quads);
    EXPECT_EQ(placed(changes.came), came) << round;
    EXPECT_EQ(placed(changes.went), went) << round;
    EXPECT_EQ(placed(changes.turned), turned) << round;
    before = std::move(now);
  }
}

TEST(FaceChanges, APlantIsOneFaceAndNotTheGroundThatItStandsIn) {
  const auto quad = [](std::uint32_t face) {
    return shared::Quad{1 | 2 << 6 | 3 << 12, block::kFlowerRed | face << shared::kFaceShift};
  };
  const FaceChanges changes = face_changes(std::vector{quad(2)}, std::vector{quad(6), quad(6)});
  ASSERT_EQ(changes.came.size(), 1u);
  EXPECT_TRUE(changes.came[0].drawn.plant);
  ASSERT_EQ(changes.went.size(), 1u);
  EXPECT_FALSE(changes.went[0].drawn.plant);
  EXPECT_TRUE(changes.turned.empty());
}

}  // namespace
}  // namespace skerry::world
