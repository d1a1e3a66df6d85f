#include "engine/render/scene/occupancy_store.h"

#include <random>

#include "tests/render/occupancy_on_gpu.h"

namespace skerry::render {
namespace {

/// Land with caves: full, mixed and empty bricks. Of no use to a chunk's neighbours.
bool land(int x, int y, int z) {
  const int height = 20 + (x * 7 + z * 3) / 9 % 11;
  const bool cave = (x & 15) > 3 && (x & 15) < 9 && (y & 15) > 5 && (z & 31) > 9;
  return y < height && !cave;
}

constexpr const char* kLookUp = R"(
  struct Question { ivec3 voxel; uint island; };
  struct Answer { uint opaque; };
  Answer answer_to(Question q) {
    return Answer(voxel_opaque(voxel_grid(q.island), q.voxel) ? 1u : 0u);
  })";

class OccupancyOfIslands : public OccupancyOnGpu {
 protected:
  struct Question {
    glm::ivec3 voxel;
    std::uint32_t island;
  };
  /// Random voxels of a box about some chunks, the same each time.
  static std::vector<Question> voxels(std::uint32_t island, glm::ivec3 low, glm::ivec3 size,
                                      std::size_t count) {
    std::mt19937 random(7);
    std::vector<Question> out(count);
    for (Question& q : out) {
      for (int axis = 0; axis < 3; ++axis)
        q.voxel[axis] = low[axis] + static_cast<int>(random() % static_cast<unsigned>(size[axis]));
      q.island = island;
    }
    return out;
  }
  int wrong(const std::vector<Question>& questions, const OpaqueAt& expected) {
    const auto answers = ask<std::uint32_t>(kLookUp, questions);
    int count = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const glm::ivec3 v = questions[i].voxel;
      count += (answers[i] != 0) != expected(v.x, v.y, v.z);
    }
    return count;
  }
  static OpaqueAt within(glm::ivec3 low, glm::ivec3 end, OpaqueAt opaque = land) {
    return [=](int x, int y, int z) {
      return x >= low.x && y >= low.y && z >= low.z && x < end.x && y < end.y && z < end.z &&
             opaque(x, y, z);
    };
  }
};

TEST_F(OccupancyOfIslands, OnTheGpuEveryVoxelIsWhatItWasInTheWorld) {
  add_island(3, land, {{-2, -1, -1}, {3, 2, 2}, 0});
  EXPECT_EQ(wrong(voxels(3, {-192, -128, -128}, {320, 256, 256}, 400000),
                  within({-128, -64, -64}, {64, 64, 64})),
            0);
  // An island that is not there has nothing.
  EXPECT_EQ(wrong(voxels(4, {-192, -128, -128}, {320, 256, 256}, 1000),
                  [](int, int, int) { return false; }),
            0);
}

TEST_F(OccupancyOfIslands, ChunksComeAndGo) {
  add_island(0, land, {{0, 0, 0}, {2, 1, 1}, 0});
  store().remove(uploader(), 0, {1, 0, 0});
  const auto questions = voxels(0, {-10, -10, -10}, {150, 84, 84}, 100000);
  EXPECT_EQ(wrong(questions, within({0, 0, 0}, {64, 64, 64})), 0);
  // What it took is used again once the GPU is done with it, and the chunk may come back changed.
  store().collect();
  const std::uint32_t before = store().bricks();
  const OpaqueAt changed = [](int x, int y, int z) { return land(x, y, z) != (y == 40); };
  add(0, {1, 0, 0}, occupancy(changed, {1, 0, 0}));
  EXPECT_GT(store().bricks(), before);
  const OpaqueAt first = within({0, 0, 0}, {64, 64, 64});
  const OpaqueAt second = within({64, 0, 0}, {128, 64, 64}, changed);
  EXPECT_EQ(
      wrong(questions, [&](int x, int y, int z) { return first(x, y, z) || second(x, y, z); }), 0);
  store().end_island(uploader(), 0);
  EXPECT_EQ(wrong(questions, [](int, int, int) { return false; }), 0);
  EXPECT_EQ(store().bricks(), 0u);
  // Another level may follow in the same place.
  add_island(0, land, {{0, 0, 0}, {1, 1, 1}, 3});
  EXPECT_EQ(wrong(questions, within({0, 0, 0}, {64, 64, 64})), 0);
}

TEST_F(OccupancyOfIslands, AGridGrowsToChunksThatWereNotExpected) {
  add_island(1, land, {{0, 0, 0}, {1, 1, 1}, 0});
  add(1, {-2, 1, 0}, occupancy([](int x, int, int) { return x % 3 == 0; }, {-2, 1, 0}));
  const OpaqueAt home = within({0, 0, 0}, {64, 64, 64});
  const OpaqueAt built =
      within({-128, 64, 0}, {-64, 128, 64}, [](int x, int, int) { return x % 3 == 0; });
  EXPECT_EQ(wrong(voxels(1, {-140, -10, -10}, {220, 150, 84}, 200000),
                  [&](int x, int y, int z) { return home(x, y, z) || built(x, y, z); }),
            0);
  // Too far for any grid: left out, and nothing else changes.
  add(1, {600, 0, 0}, occupancy([](int, int, int) { return true; }, {600, 0, 0}));
  EXPECT_EQ(
      wrong(voxels(1, {600 * 64, 0, 0}, {64, 64, 64}, 100), [](int, int, int) { return false; }),
      0);
  EXPECT_EQ(wrong(voxels(1, {0, 0, 0}, {64, 64, 64}, 10000), home), 0);
}

TEST_F(OccupancyOfIslands, BuffersGrowAndKeepWhatTheyHave) {
  const OpaqueAt mixed = [](int x, int y, int z) { return (x + y + z) % 2 == 0; };
  // 512 stored bricks a chunk: more than there is room for to begin with.
  add_island(0, mixed, {{0, 0, 0}, {3, 3, 3}, 0});
  EXPECT_EQ(store().bricks(), 27u * shared::kBricksPerChunk);
  EXPECT_EQ(wrong(voxels(0, {0, 0, 0}, {192, 192, 192}, 200000),
                  within({0, 0, 0}, {192, 192, 192}, mixed)),
            0);
}

}  // namespace
}  // namespace skerry::render
