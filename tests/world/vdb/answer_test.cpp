#include "world/vdb/answer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/world/vdb/volumes.h"

namespace skerry::world {
namespace {

std::vector<std::byte> encoded(const std::vector<VolumeGrid>& grids) {
  std::vector<std::byte> bytes;
  const ByteSink sink = [&bytes](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  };
  begin_answer(static_cast<std::uint32_t>(grids.size()), sink);
  for (const VolumeGrid& grid : grids) encode_grid(grid, sink);
  return bytes;
}

VolumeGrid sample() {
  VolumeGrid grid = random_volume(1, 20, 3);
  grid.name = "density";
  grid.value_type = "float";
  grid.grid_class = "fog volume";
  grid.active_voxels = 5;
  grid.active_box = {{-8, -8, -8}, {7, 7, 7}};
  return grid;
}

/// What decode_answer says of a grid that was spoiled.
std::string refusal_of(const VolumeGrid& grid) {
  const auto decoded = decode_answer(encoded({grid}));
  return decoded ? "" : decoded.error().message;
}

TEST(VdbAnswer, GivesBackWhatWasEncoded) {
  const VolumeGrid grid = sample();
  const auto back = decode_answer(encoded({grid, grid}));
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->size(), 2u);
  EXPECT_EQ((*back)[0].name, "density[0]");
  EXPECT_EQ((*back)[1].name, "density[1]");
  const VolumeGrid& one = (*back)[1];
  EXPECT_EQ(one.world_from_index, grid.world_from_index);
  EXPECT_EQ(one.active_voxels, 5u);
  EXPECT_EQ(one.grid_class, "fog volume");
  ASSERT_EQ(one.bricks.size(), grid.bricks.size());
  ASSERT_EQ(one.tiles.size(), grid.tiles.size());
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    EXPECT_EQ(one.bricks[i].origin, grid.bricks[i].origin);
    EXPECT_EQ(one.bricks[i].values, grid.bricks[i].values);
  }
}

TEST(VdbAnswer, KnowsLeastLargestAndMeanValue) {
  VolumeGrid grid = sample();
  grid.bricks.clear();
  grid.tiles = {{{0, 0, 0}, 8, 1.0f}, {{16, 0, 0}, 16, -3.0f}};
  const auto back = decode_answer(encoded({grid}));
  ASSERT_TRUE(back);
  EXPECT_EQ((*back)[0].min_value, -3.0f);
  EXPECT_EQ((*back)[0].max_value, 1.0f);
  // 512 voxels of 1 and 4096 of -3.
  EXPECT_FLOAT_EQ((*back)[0].mean_value, (512.0f - 3.0f * 4096.0f) / 4608.0f);
}

TEST(VdbAnswer, RefusesEveryBeginningOfItself) {
  VolumeGrid grid = sample();
  grid.bricks.resize(1);
  const std::vector<std::byte> bytes = encoded({grid});
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_answer(std::span(bytes).first(size))) << size;
  std::vector<std::byte> longer = bytes;
  longer.push_back({});
  EXPECT_FALSE(decode_answer(longer));
}

TEST(VdbAnswer, RefusesWhatItsPromisesForbid) {
  const float kNan = std::nanf("");
  const auto spoiled = [](auto&& spoil) {
    VolumeGrid grid = sample();
    spoil(grid);
    return refusal_of(grid);
  };
  EXPECT_EQ(spoiled([](VolumeGrid&) {}), "");
  EXPECT_NE(spoiled([&](VolumeGrid& g) { g.bricks[3].values[511] = kNan; }), "");
  EXPECT_NE(spoiled([&](VolumeGrid& g) { g.tiles[0].value = kNan; }), "");
  EXPECT_NE(spoiled([&](VolumeGrid& g) { g.background = -INFINITY; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.bricks[1].origin.y += 1; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { std::swap(g.bricks[0], g.bricks[1]); }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.bricks[1] = g.bricks[0]; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.bricks.back().origin.x = kMaxVolumeIndex; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.tiles[0].edge = 0; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.tiles[0].edge = 24; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.tiles[0].edge = -8; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.tiles = {{{0, 0, 0}, 8192, 1.0f}}; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.tiles = {{{-128, -128, -128}, 128, 1.0f}}; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.world_from_index[1] = g.world_from_index[0]; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.world_from_index[1] *= 0.0; }), "");
  EXPECT_EQ(spoiled([](VolumeGrid& g) { g.world_from_index[1] = {0.99, 0.01, 0.0, 0.0}; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.world_from_index[1] = {1.0, 5e-4, 0.0, 0.0}; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.world_from_index[3][0] = 1e300; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.world_from_index[0][3] = 1.0; }), "");
  EXPECT_NE(spoiled([&](VolumeGrid& g) { g.world_from_index[2][2] = std::nan(""); }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.kind = VolumeKind::kOther; }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.kind = static_cast<VolumeKind>(77); }), "");
  EXPECT_NE(spoiled([](VolumeGrid& g) { g.active_box.max.x = -9; }), "");
}

TEST(VdbAnswer, RefusesColoursOutOfRange) {
  VolumeGrid grid = sample();
  grid.kind = VolumeKind::kColor;
  grid.tiles.clear();
  for (VolumeBrick& brick : grid.bricks) brick.values.fill(16777215.0f);
  EXPECT_EQ(refusal_of(grid), "");
  for (const float value : {-1.0f, 16777216.0f, 1e30f}) {
    grid.bricks[0].values[7] = value;
    EXPECT_NE(refusal_of(grid), "") << value;
  }
  grid.bricks[0].values[7] = 0.0f;
  grid.tiles = {{{256, 0, 0}, 16, -3.0f}};
  EXPECT_NE(refusal_of(grid), "");
  grid.tiles.clear();
  grid.background = 1e30f;
  EXPECT_NE(refusal_of(grid), "");
}

TEST(VdbAnswer, FindsBricksAndTilesThatLieInTiles) {
  VolumeGrid grid = sample();
  grid.bricks.resize(1);
  grid.bricks[0].origin = {64, 8, 0};
  const auto with_tile = [&grid](IVec3 origin, std::int32_t edge) {
    grid.tiles = {{{0, 0, 0}, 16, 1.0f}, {origin, edge, 1.0f}};
    return refusal_of(grid);
  };
  EXPECT_EQ(with_tile({64, 0, 0}, 8), "");
  EXPECT_NE(with_tile({64, 8, 0}, 8), "");
  EXPECT_NE(with_tile({64, 0, 0}, 64), "");
  EXPECT_NE(with_tile({8, 8, 8}, 8), "");
}

TEST(VdbAnswer, RefusesMoreTilesThanItCanLookUp) {
  VolumeGrid grid;
  grid.kind = VolumeKind::kFog;
  const auto with_tiles = [&grid](std::size_t count) {
    grid.tiles.clear();
    for (std::size_t i = 0; i < count; ++i)
      grid.tiles.push_back({{static_cast<std::int32_t>(i) * 8, 0, 0}, 8, 1.0f});
    return refusal_of(grid);
  };
  EXPECT_EQ(with_tiles(kMaxVolumeTiles), "");
  EXPECT_NE(with_tiles(kMaxVolumeTiles + 1).find("tiles"), std::string::npos);
}

TEST(VdbAnswer, BelievesNoCount) {
  // A count of bricks beyond the bytes that follow must not be reserved.
  VolumeGrid grid = sample();
  grid.bricks.clear();
  grid.tiles.clear();
  std::vector<std::byte> bytes = encoded({grid});
  for (const std::uint64_t count : {std::uint64_t{1}, std::uint64_t{1} << 62, ~std::uint64_t{0}}) {
    std::memcpy(bytes.data() + bytes.size() - sizeof(count), &count, sizeof(count));
    EXPECT_FALSE(decode_answer(bytes)) << count;
  }
}

TEST(VdbAnswer, PassesOnAnErrorInOneLine) {
  std::vector<std::byte> bytes;
  encode_error("bad\nluck\x1b[2J", [&bytes](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  });
  const auto decoded = decode_answer(bytes);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().message, "bad?luck?[2J");
}

}  // namespace
}  // namespace skerry::world
