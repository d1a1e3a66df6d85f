#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "world/vdb_import/solid.h"
#include "world/voxel/chunk.h"

namespace skerry::world {

/// What the materials of one island depend on besides its shape.
struct Land {
  std::uint32_t seed = 0;
  /// Ground from here up is snow [blocks, lattice]; none: the island is too low for it.
  std::optional<std::int32_t> snow_from = {};
  /// The block that a surface voxel's colour asks for; empty: no colours, it becomes land.
  std::function<BlockId(IVec3 voxel)> colored = {};
};

/// Where snow begins on an island of this height; low islands have none.
/// @param low, high of solid voxels, lattice, both inclusive.
std::optional<std::int32_t> snow_line(std::int32_t low, std::int32_t high);

/// Whether a chunk and all that touch it by a face are full: then nothing of it is ever seen from
/// outside, and no cover reaches in.
bool is_buried(const SolidMasks& masks, IVec3 chunk);

/// Blocks of a chunk: grass where the ground is gentle, bare rock where it is steep, soil beneath
/// grass, snow high up, banded rock within, and grass and flowers on meadows. Solid voxels become
/// solid blocks and no others do.
Chunk land_chunk(const SolidMasks& masks, IVec3 chunk, const Land& land);

}  // namespace skerry::world
