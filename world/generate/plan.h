#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "world/generate/columns.h"
#include "world/generate/trees.h"
#include "world/voxel/chunk.h"
#include "world/voxel/island.h"

namespace skerry::world {

/// A ball that adds or removes rock above `floor`.
struct Ball {
  int x, y, z, radius, floor;
  bool open =
      true;  ///< a hole may break through a cliff; otherwise it stays below the ground's surface
};

/// One voxel set after everything else: crystals, cave floors, boulders.
struct Stamp {
  std::int16_t x, y, z;
  BlockId id;
  bool into_air;  ///< only where there is air; otherwise only where there is rock
};

inline constexpr int kBandPeriod = 64;  ///< rock bands repeat after this many blocks of height

/// Everything an island's chunks share.
struct IslandPlan {
  explicit IslandPlan(const IslandSpec& spec);

  Shape shape;
  Columns columns;
  std::vector<Ball> solids;  ///< arches
  std::vector<Ball> holes;   ///< caves
  std::vector<Tree> trees;
  std::vector<Stamp> stamps;
  std::array<BlockId, kBandPeriod> bands{};
  int highest = 0;  ///< no block at or above this
  int lowest = 0;   ///< no block below this

  const BiomeType& biome() const { return biome_type(shape.biome); }
  std::uint32_t shift_seed() const { return shape.seed + 201; }
  /// Whether the rock, shifted but neither arched nor hollowed, fills a voxel at full detail.
  bool rock_at(int x, int y, int z) const;
  /// Highest voxel a hole may take in a column, exclusive.
  int roof_of(const Ball& hole, std::size_t column) const;
  /// Whether an arch fills a voxel at full detail.
  bool arch_at(int x, int y, int z) const;
  /// Whether anything that carries weight fills a voxel at full detail.
  bool solid_at(int x, int y, int z) const;
};

/// The steps of planning, in order. Each reads what the ones before it made.
void plan_arches(IslandPlan& plan);
void plan_caves(IslandPlan& plan);
void plan_trees(IslandPlan& plan);
void plan_crystals(IslandPlan& plan);

/// The voxels of IslandGenerator::generate_padded.
bool fill_padded(const IslandPlan& plan, IVec3 chunk, int level, std::span<BlockId> out);

}  // namespace skerry::world
