#pragma once
#include <cstdint>

#include "world/vdb_import/placement.h"
#include "world/vdb_import/solid_rule.h"
#include "world/vdb_import/volume_field.h"
#include "world/voxel/chunk.h"

namespace skerry::world {

/// A chunk of a grid of block ids.
struct IdChunk {
  Chunk chunk = Chunk(kAir);
  std::uint64_t unknown = 0;  ///< blocks of unknown ids; now stone
  std::uint64_t looks = 0;    ///< into the grid, in units of import_cost.h
};

/// Each block is the nearest sample's. Whole cubes are settled at once where bounds of the values
/// allow it: tiles may be large.
IdChunk id_chunk(const VolumeField& field, const SolidRule& rule, const Placement& placement,
                 IVec3 chunk);

}  // namespace skerry::world
