// Islands become volumes.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/core/result.h"
#include "world/islands/world.h"
#include "world/vdb/volume_grid.h"

namespace skerry::world {

/// Blocks of the world, [low, high).
struct BlockBox {
  std::array<std::int64_t, 3> low{}, high{};
};

/// Most bricks and tiles of one export: some 512 MiB, of which the way to the file takes a few
/// copies.
inline constexpr std::size_t kMaxExportParts = std::size_t{1} << 18;
/// Longest side of a box in a world that a seed makes, which has islands everywhere.
inline constexpr std::int64_t kMaxSeedBoxBlocks = 1 << 14;

/// Two grids for each island with a block in the box, as it stands at time 0: `block_id` (kIds, 0
/// for air) and `density` (kFog, 1 where a player can stand). Several islands are numbered. Their
/// index space is the island's lattice, voxel (i, j, k) being block (i, j, k), and their transform
/// takes block centres to the world [blocks], so that import_islands gives the same voxels back.
/// @param progress called with the share that is done.
/// Errors: no block in the box; more than kMaxExportParts; a box longer than kMaxSeedBoxBlocks.
Result<std::vector<VolumeGrid>> volumes_of(World& world, const BlockBox& box,
                                           const ReadProgress& progress = {});

/// The same for two grids whose values are the same at every index, however they are cut into
/// bricks and tiles; no brick may be of one value.
std::uint64_t content_hash(const VolumeGrid& grid);

/// Writes a .vdb file, compressed by Blosc: complete or not at all. It is read again and its values
/// compared before it takes its name. Errors: one line that names the file.
Result<void> write_vdb(const std::vector<VolumeGrid>& grids, const std::filesystem::path& path);

}  // namespace skerry::world
