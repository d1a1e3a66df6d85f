#include "world/vdb_import/import.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "tests/world/vdb/imported.h"
#include "tests/world/vdb/volumes.h"
#include "world/islands/world.h"
#include "world/vdb_import/grid_choice.h"
#include "world/vdb_import/volume_field.h"

namespace skerry::world {
namespace {

BlockId block_of(const ImportedIsland& island, IVec3 voxel) {
  const auto found = island.chunks.find(chunk_of(voxel));
  return found == island.chunks.end() ? kAir : found->second.at(index_in_chunk(voxel));
}

/// Where the centre of a lattice voxel stands in the world [blocks].
glm::dvec3 centre_in_world(const ImportedIsland& island, IVec3 voxel) {
  const Pose pose = pose_at(island.spec, 0.0);
  return difference_blocks(pose.origin, {}) +
         pose.rotation * (glm::dvec3{voxel.x, voxel.y, voxel.z} + 0.5);
}

/// Calls check(voxel, its centre in the file's space) for each voxel of the island's box and a
/// margin around it.
template <class Check>
void for_each_voxel(const ImportedIsland& island, const glm::dmat4& file_from_world,
                    Check&& check) {
  const IVec3 low = island.spec.box_min, high = island.spec.box_max;
  for (int x = low.x - 2; x < high.x + 2; ++x) {
    for (int y = low.y - 2; y < high.y + 2; ++y) {
      for (int z = low.z - 2; z < high.z + 2; ++z) {
        const glm::dvec4 place(centre_in_world(island, {x, y, z}), 1.0);
        check(IVec3{x, y, z}, glm::dvec3(file_from_world * place));
      }
    }
  }
}

VolumeGrid ids_grid() {
  VolumeGrid grid =
      filled_volume(VolumeKind::kIds, {-13, -70, -5}, {90, 21, 40}, 0.0f, [](IVec3 at) {
        const std::uint32_t dice = hash3(9, at.x, at.y, at.z);
        return dice % 3 == 0 ? static_cast<float>(dice / 3 % block::kBuiltInCount) : 0.0f;
      });
  grid.world_from_index = glm::translate(glm::dmat4(1.0), {0.5, 0.5, 0.5});
  return grid;
}

TEST(VdbImport, CopiesBlockIdsToTheVeryPlaceTheFileNames) {
  const VolumeGrid grid = ids_grid();
  const std::vector<ImportedIsland> islands = imported({grid});
  ASSERT_EQ(islands.size(), 1u);
  EXPECT_EQ(islands[0].error_blocks, 0.0);
  EXPECT_EQ(islands[0].blocks, grid.active_voxels);
  const VolumeField field(grid);
  for_each_voxel(
      islands[0], glm::inverse(grid.world_from_index), [&](IVec3 voxel, glm::dvec3 index) {
        ASSERT_NEAR(index.x, std::round(index.x), 1e-9);
        ASSERT_EQ(block_of(islands[0], voxel), static_cast<BlockId>(field.nearest(index)));
      });
}

TEST(VdbImport, MakesCubesOfBlocksOfAWholeScale) {
  const VolumeGrid grid = ids_grid();
  const std::vector<ImportedIsland> islands = imported({grid}, {.scale = 3.0});
  ASSERT_EQ(islands.size(), 1u);
  EXPECT_EQ(islands[0].error_blocks, 0.0);
  EXPECT_EQ(islands[0].blocks, 27 * grid.active_voxels);
}

TEST(VdbImport, KeepsATurnAboutTheVerticalAsTheIslandsHeading) {
  VolumeGrid grid = ids_grid();
  const double yaw = 0.7;
  const glm::dmat4 turn = glm::mat4_cast(glm::angleAxis(yaw, glm::dvec3{0.0, 1.0, 0.0}));
  grid.world_from_index = glm::translate(glm::dmat4(1.0), {1e6, 300.0, -7.25}) * turn;
  const std::vector<ImportedIsland> islands = imported({grid});
  ASSERT_EQ(islands.size(), 1u);
  EXPECT_NEAR(islands[0].spec.yaw_rad, yaw, 1e-12);
  EXPECT_EQ(islands[0].error_blocks, 0.0);
  const VolumeField field(grid);
  for_each_voxel(
      islands[0], glm::inverse(grid.world_from_index), [&](IVec3 voxel, glm::dvec3 index) {
        // The island's place is rounded to 1/65536 block.
        ASSERT_NEAR(index.y, std::round(index.y), 1e-4);
        ASSERT_EQ(block_of(islands[0], voxel), static_cast<BlockId>(field.nearest(index)));
      });
}

/// Distance to a ball's surface.
VolumeGrid ball_grid(double radius) {
  const int reach = static_cast<int>(radius) + 4;
  return filled_volume(
      VolumeKind::kLevelSet, {-reach, -reach, -reach}, {reach, reach, reach}, 3.0f,
      [radius](IVec3 at) {
        const double d =
            std::sqrt(static_cast<double>(at.x * at.x + at.y * at.y + at.z * at.z)) - radius;
        return static_cast<float>(std::clamp(d, -3.0, 3.0));
      });
}

TEST(VdbImport, FillsALevelSetWhereItsDistanceIsNegativeUnderAnyAffineMap) {
  VolumeGrid grid = ball_grid(15.0);
  glm::dmat4 map = glm::translate(glm::dmat4(1.0), {40.0, -20.0, 7.0});
  map = glm::rotate(map, 0.6, glm::dvec3{1.0, 2.0, 0.5});
  map = glm::scale(map, {1.0, 2.0, 0.5});
  grid.world_from_index = map;
  const std::vector<ImportedIsland> islands = imported({grid}, {.scale = 1.5});
  ASSERT_EQ(islands.size(), 1u);
  EXPECT_GT(islands[0].error_blocks, 0.0);
  const double blocks_per_unit = 1.5;  // the voxel's volume is 1
  const glm::dmat4 index_from_world =
      glm::inverse(map) * glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / blocks_per_unit));
  std::uint64_t solid = 0;
  for_each_voxel(islands[0], index_from_world, [&](IVec3 voxel, glm::dvec3 index) {
    const double distance = glm::length(index) - 15.0;
    if (std::abs(distance) < 0.05) return;  // interpolation flattens the ball by less than this
    ASSERT_EQ(is_solid(block_of(islands[0], voxel)), distance < 0.0) << distance;
    solid += distance < 0.0 ? 1 : 0;
  });
  EXPECT_NEAR(static_cast<double>(solid), 4.18879 * std::pow(15.0 * 1.5, 3.0), 600.0);
}

TEST(VdbImport, ReachesTheSizeAskedFor) {
  for (const int size : {40, 100, 333}) {
    const std::vector<ImportedIsland> islands = imported({ball_grid(15.0)}, {.size_blocks = size});
    ASSERT_EQ(islands.size(), 1u);
    const IslandSpec& spec = islands[0].spec;
    EXPECT_NEAR(spec.box_max.x - spec.box_min.x, size, 1.0);
    EXPECT_NEAR(spec.box_max.z - spec.box_min.z, size, 1.0);
  }
}

TEST(VdbImport, TurnsFilesThatPointUpAlongZ) {
  VolumeGrid grid =
      filled_volume(VolumeKind::kMask, {0, 0, 0}, {1, 2, 30}, 0.0f, [](IVec3) { return 1.0f; });
  const std::vector<ImportedIsland> islands = imported({grid}, {.up = UpAxis::kZ});
  ASSERT_EQ(islands.size(), 1u);
  EXPECT_EQ(islands[0].error_blocks, 0.0);
  std::uint64_t solid = 0;
  for_each_voxel(islands[0], glm::dmat4(1.0), [&](IVec3 voxel, glm::dvec3 p) {
    // World (x, y, z) is the file's (x, -z, y).
    const glm::dvec3 index = glm::round(glm::dvec3{p.x, -p.z, p.y});
    const bool inside =
        index.x == 0.0 && index.y >= 0.0 && index.y <= 1.0 && index.z >= 0.0 && index.z <= 29.0;
    ASSERT_EQ(is_solid(block_of(islands[0], voxel)), inside);
    solid += inside ? 1 : 0;
  });
  EXPECT_EQ(solid, 60u);
}

TEST(VdbImport, CoversGentleGroundWithGrassOverDirtAndLeavesCliffsBare) {
  const std::vector<ImportedIsland> islands = imported({ball_grid(50.0)});
  ASSERT_EQ(islands.size(), 1u);
  const ImportedIsland& island = islands[0];
  const auto column = [&island](int x, int z) {
    for (int y = island.spec.box_max.y; y >= island.spec.box_min.y; --y)
      if (is_solid(block_of(island, {x, y, z}))) return y;
    return INT32_MIN;
  };
  const int top = column(0, 0);
  EXPECT_EQ(block_of(island, {0, top, 0}), block::kGrass);
  for (int depth = 1; depth <= 3; ++depth)
    EXPECT_EQ(block_of(island, {0, top - depth, 0}), block::kDirt);
  EXPECT_NE(block_of(island, {0, top - 4, 0}), block::kDirt);
  // Near the equator the ball is a wall.
  const BlockId wall = block_of(island, {0, column(49, 0), 0});
  EXPECT_TRUE(wall == block::kStone || wall == block::kSlate || wall == block::kLimestone ||
              wall == block::kCoalOre)
      << wall;
}

TEST(VdbImport, PutsSnowOnTallIslandsOnly) {
  const auto snow_in = [](const ImportedIsland& island) {
    bool found = false;
    for_each_voxel(island, glm::dmat4(1.0), [&](IVec3 voxel, glm::dvec3) {
      found = found || block_of(island, voxel) == block::kSnow;
    });
    return found;
  };
  EXPECT_FALSE(snow_in(imported({ball_grid(30.0)}, {.size_blocks = 100}).at(0)));
  EXPECT_TRUE(snow_in(imported({ball_grid(30.0)}, {.size_blocks = 160}).at(0)));
}

TEST(VdbImport, PaintsTheSurfaceWithTheNearestBlocksOfAColourGrid) {
  VolumeGrid colors =
      filled_volume(VolumeKind::kColor, {-20, -20, -20}, {20, 20, 20}, 0.0f, [](IVec3 at) {
        const std::uint32_t red = 157u << 16 | 92u << 8 | 68u;
        const std::uint32_t white = 225u << 16 | 232u << 8 | 238u;
        return static_cast<float>(at.x < 0 ? red : white);
      });
  colors.name = "Cd";
  const std::vector<ImportedIsland> islands = imported({ball_grid(12.0), colors});
  ASSERT_EQ(islands.size(), 1u);
  std::set<BlockId> west, east;
  for_each_voxel(islands[0], glm::dmat4(1.0), [&](IVec3 voxel, glm::dvec3 place) {
    const BlockId id = block_of(islands[0], voxel);
    const double radius = glm::length(place);
    if (id != kAir && radius > 11.0 && std::abs(place.x) > 1.0)
      (place.x < 0.0 ? west : east).insert(id);
  });
  EXPECT_TRUE(west.contains(block::kRedRock));
  EXPECT_TRUE(east.contains(block::kSnow));
  EXPECT_FALSE(west.contains(block::kSnow));
  EXPECT_FALSE(east.contains(block::kRedRock));
}

TEST(VdbImport, GivesTheSameVoxelsOnEveryNumberOfThreads) {
  const std::vector<ImportedIsland> one = imported({ball_grid(60.0)}, {}, 1);
  const std::vector<ImportedIsland> four = imported({ball_grid(60.0)}, {}, 4);
  ASSERT_EQ(one.at(0).chunks.size(), four.at(0).chunks.size());
  std::vector<BlockId> a(kChunkVoxels), b(kChunkVoxels);
  for (const auto& [at, chunk] : one[0].chunks) {
    chunk.unpack(a);
    four[0].chunks.at(at).unpack(b);
    ASSERT_EQ(a, b);
  }
}

TEST(VdbImport, MakesUniformChunksOfBlockIdsOfATile) {
  VolumeGrid grid;
  grid.kind = VolumeKind::kIds;
  // One by one, these 1.2e9 blocks would take minutes.
  grid.tiles = {{{0, 0, 0}, 1024, 7.0f}, {{1024, 0, 0}, 512, 1000.0f}};
  const std::vector<ImportedIsland> islands = imported({grid});
  ASSERT_EQ(islands.size(), 1u);
  EXPECT_EQ(islands[0].blocks, (std::uint64_t{1} << 30) + (1 << 27));
  EXPECT_EQ(islands[0].unknown_ids, 1u << 27);
  const VolumeField field(grid);
  for (int x = islands[0].spec.box_min.x - 2; x < islands[0].spec.box_max.x + 2; ++x) {
    const IVec3 voxel{x, -200, -200};
    const float id = field.nearest(centre_in_world(islands[0], voxel));
    const BlockId expected = id == 1000.0f ? BlockId{block::kStone} : static_cast<BlockId>(id);
    ASSERT_EQ(block_of(islands[0], voxel), expected) << x;
  }
}

TEST(VdbImport, MakesAnIslandOfEachGridWhereItsTransformPutsIt) {
  VolumeGrid a = ball_grid(10.0), b = ball_grid(10.0);
  a.name = "a";
  b.name = "b";
  b.world_from_index = glm::translate(glm::dmat4(1.0), {100.0, 50.0, -30.0});
  VolumeGrid empty;
  empty.kind = VolumeKind::kLevelSet;
  empty.background = 1.0f;
  const std::vector<ImportedIsland> islands = imported({a, empty, b});
  ASSERT_EQ(islands.size(), 2u);
  EXPECT_NE(islands[0].spec.id, islands[1].spec.id);
  const glm::dvec3 apart = difference_blocks(islands[1].spec.origin, islands[0].spec.origin);
  EXPECT_EQ(apart, glm::dvec3(100.0, 50.0, -30.0));
  EXPECT_EQ(imported({a, b}, {.grid = "b"}).size(), 1u);
}

VolumeGrid sorted_grid(std::string name, VolumeKind kind, std::string grid_class = "unknown") {
  VolumeGrid out;
  out.name = std::move(name);
  out.kind = kind;
  out.grid_class = std::move(grid_class);
  if (kind == VolumeKind::kOther) {
    out.remark = "points";
  } else {
    out.tiles = {{{0, 0, 0}, 8, 5.0f}};
    out.active_voxels = 512;
    out.max_value = 5.0f;
  }
  return out;
}

TEST(VdbImport, TakesTheBestSortOfGridThatThereIs) {
  // From the last that is taken to the first; of each sort two.
  const std::vector<VolumeGrid> ascending = {
      sorted_grid("obstacles", VolumeKind::kIds),
      sorted_grid("collision_sdf", VolumeKind::kLevelSet, "level set"),
      sorted_grid("vorticity", VolumeKind::kFog),
      sorted_grid("pressure", VolumeKind::kFog),
      sorted_grid("labels", VolumeKind::kIds),
      sorted_grid("material", VolumeKind::kIds),
      sorted_grid("m", VolumeKind::kMask),
      sorted_grid("n", VolumeKind::kMask),
      sorted_grid("smoke", VolumeKind::kFog, "fog volume"),
      sorted_grid("mist", VolumeKind::kFog, "fog volume"),
      sorted_grid("density[0]", VolumeKind::kFog),
      sorted_grid("density[1]", VolumeKind::kFog, "fog volume"),
      sorted_grid("s", VolumeKind::kLevelSet, "level set"),
      sorted_grid("t", VolumeKind::kLevelSet, "level set"),
      sorted_grid("block_id", VolumeKind::kFog),
      sorted_grid("ids", VolumeKind::kIds)};
  std::vector<VolumeGrid> grids = {sorted_grid("temperature", VolumeKind::kFog, "fog volume"),
                                   sorted_grid("Cd", VolumeKind::kColor),
                                   sorted_grid("p", VolumeKind::kOther)};
  EXPECT_TRUE(importable_grids(grids).empty());
  for (std::size_t i = 0; i < ascending.size(); i += 2) {
    grids.insert(grids.end(), {ascending[i], ascending[i + 1]});
    const std::size_t last = grids.size() - 1;
    EXPECT_EQ(importable_grids(grids), (std::vector<std::size_t>{last - 1, last}))
        << ascending[i].name;
  }
}

TEST(VdbImport, PassesOverEmptyGridsOfABetterSort) {
  VolumeGrid empty_ids, empty_set;
  empty_ids.name = "block_id";
  empty_ids.kind = VolumeKind::kIds;
  empty_set.name = "surface";
  empty_set.kind = VolumeKind::kLevelSet;
  const VolumeGrid smoke = sorted_grid("density", VolumeKind::kFog, "fog volume");
  EXPECT_EQ(importable_grids({empty_ids, empty_set, smoke}), std::vector<std::size_t>{2});
  EXPECT_NE(refusal_of({empty_ids, empty_set}).find("empty"), std::string::npos);
}

TEST(VdbImport, TakesNumberedBlockIdsBeforeTheirDensity) {
  const std::vector<VolumeGrid> grids = {sorted_grid("density_0", VolumeKind::kFog, "fog volume"),
                                         sorted_grid("block_id_0", VolumeKind::kIds),
                                         sorted_grid("density_1", VolumeKind::kFog, "fog volume"),
                                         sorted_grid("block_id_12", VolumeKind::kIds)};
  EXPECT_EQ(importable_grids(grids), (std::vector<std::size_t>{1, 3}));
}

TEST(VdbImport, TellsWhichGridsItTakesWhichItLeavesAndWhy) {
  const VolumeGrid obstacles = sorted_grid("obstacles", VolumeKind::kIds);
  const VolumeGrid smoke = sorted_grid("density", VolumeKind::kFog, "fog volume");
  const std::string line = choice_line({obstacles, smoke}, {});
  for (const char* part :
       {"takes 'density'", "class fog volume", "512 active voxels", "its name says density",
        "leaves 'obstacles'", "its name says obstacle", "--import grid=NAME"})
    EXPECT_NE(line.find(part), std::string::npos) << part << ": " << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(choice_line({smoke}, {}), "");
  EXPECT_EQ(choice_line({smoke, smoke}, {}), "") << "all are taken";
  EXPECT_EQ(choice_line({obstacles, smoke}, {.grid = "obstacles"}), "");
  EXPECT_EQ(choice_line({smoke, sorted_grid("p", VolumeKind::kOther)}, {}), "");
  const std::vector<VolumeGrid> many(4000, obstacles);
  std::vector<VolumeGrid> all = many;
  all.push_back(smoke);
  EXPECT_NE(choice_line(all, {}).find("and 3996 more"), std::string::npos);
  EXPECT_LT(choice_line(all, {}).size(), 1000u);
}

TEST(VdbImport, TurnsUnknownIdsIntoStoneAndSaysSo) {
  const VolumeGrid grid = filled_volume(VolumeKind::kIds, {0, 0, 0}, {4, 1, 1}, 0.0f, [](IVec3 at) {
    constexpr float kIds[] = {5.0f, -3.0f, 1e9f, 1000.0f};
    return kIds[at.x];
  });
  const std::vector<ImportedIsland> islands = imported({grid});
  ASSERT_EQ(islands.size(), 1u);
  EXPECT_EQ(islands[0].blocks, 3u);  // what is below 0 is air
  EXPECT_EQ(islands[0].unknown_ids, 2u);
}

TEST(VdbImport, RefusesWhatHasNoInsideInOneLine) {
  EXPECT_NE(refusal_of({}), "");
  VolumeGrid empty;
  empty.kind = VolumeKind::kFog;
  EXPECT_NE(refusal_of({empty}), "");
  VolumeGrid inverted = ball_grid(5.0);
  inverted.background = -3.0f;
  EXPECT_NE(refusal_of({inverted}).find("outside is solid"), std::string::npos);
  VolumeGrid far = ball_grid(5.0);
  far.world_from_index[3][1] = 1e14;
  EXPECT_NE(refusal_of({far}).find("2^40"), std::string::npos);
  EXPECT_NE(refusal_of({ball_grid(5.0)}, {.grid = "other"}).find("'grid'"), std::string::npos);
  EXPECT_NE(refusal_of({ball_grid(5.0)}, {.scale = 0.001}).find("too small"), std::string::npos);
  EXPECT_NE(refusal_of({ball_grid(5.0)}, {.scale = 1e6}).find("--scale"), std::string::npos);
}

TEST(VdbImport, TakesTinyVoxelsAtTheSameScaleAsAnyOther) {
  VolumeGrid grid = ball_grid(10.0);
  grid.world_from_index = glm::scale(glm::dmat4(1.0), glm::dvec3(1e-12));
  EXPECT_EQ(imported({grid}).at(0).blocks, imported({ball_grid(10.0)}).at(0).blocks);
}

}  // namespace
}  // namespace skerry::world
