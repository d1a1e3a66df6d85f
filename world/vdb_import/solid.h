#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <set>

#include "engine/core/jobs.h"
#include "engine/core/result.h"
#include "world/vdb_import/import_cost.h"
#include "world/vdb_import/placement.h"
#include "world/vdb_import/solid_rule.h"
#include "world/vdb_import/volume_field.h"
#include "world/voxel/chunk.h"

namespace skerry::world {

/// Which voxels of a chunk are solid. Mixed: bit z of rows[x + 64 * y].
struct ChunkMask {
  enum class Fill : std::uint8_t { kEmpty, kFull, kMixed };
  using Rows = std::array<std::uint64_t, kChunkEdge * kChunkEdge>;

  Fill fill = Fill::kEmpty;
  std::unique_ptr<Rows> rows;

  std::uint64_t row(int x, int y) const {
    if (fill == Fill::kMixed) return (*rows)[static_cast<std::size_t>(x + kChunkEdge * y)];
    return fill == Fill::kFull ? ~std::uint64_t{0} : 0;
  }
};

/// A lattice's solid voxels by chunk; chunks that are not named are empty.
using SolidMasks = std::map<IVec3, ChunkMask>;

/// Bounds of all values that the blocks of a cube of the lattice can see.
/// @param corner of its lowest voxel.
VolumeField::Range values_in_cube(const VolumeField& field, const Placement& placement,
                                  glm::dvec3 corner, int edge);

/// Chunks into which a brick or tile with a solid value reaches.
/// Errors: more than kMaxImportChunks or kMaxNamedChunks, or further than kMaxImportReach.
Result<std::set<IVec3>> chunks_of(const VolumeGrid& grid, const SolidRule& rule,
                                  const Placement& placement, ImportCost& cost);

/// What an import counts, works on and reports to.
struct ImportRun {
  ImportCost& cost;
  Jobs& jobs;
  const ReadProgress& progress;
};

/// Asks at each block's centre whether it is solid. Whole cubes of blocks are settled at once where
/// bounds of the values allow it.
/// Errors: more than kMaxDetailedChunks are mixed; more than run.cost.most_looks.
Result<SolidMasks> solid_masks(const VolumeField& field, const SolidRule& rule,
                               const Placement& placement, const std::set<IVec3>& chunks,
                               const ImportRun& run);

/// That an import looks more often than it may.
Error too_many_looks(const ImportCost& cost);

}  // namespace skerry::world
