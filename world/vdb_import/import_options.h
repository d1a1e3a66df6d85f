// What an import is asked for and what it gives.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "world/voxel/chunk.h"
#include "world/voxel/island.h"

namespace skerry::world {

enum class UpAxis : std::uint8_t { kY, kZ };

struct ImportOptions {
  std::optional<std::string> grid =
      {};  ///< only this one; none: importable_grids (grid_choice.h) chooses
  /// SHA-256 that the file must have, 64 lower-case digits. For whoever opens the file:
  /// import_islands has no file to look at.
  std::optional<std::string> expect = {};
  /// Blocks along a voxel's edge; of a box-shaped voxel, along the edge of the cube of its volume.
  /// All grids of a file are scaled as the first. None: 1, or what `size_blocks` asks for.
  std::optional<double> scale = {};
  /// Length of the longest side of the box around all islands. Not beside `scale`.
  std::optional<int> size_blocks = {};
  /// Fog is solid from here on, distances are inside below it. None: half
  /// the mean density of what is not empty; 0.
  std::optional<double> threshold = {};
  UpAxis up = UpAxis::kY;  ///< which axis of the file points up
};

/// Refused beyond this many blocks from an island's centre; import_cost.h has the other limits.
inline constexpr std::int32_t kMaxImportReach = 1 << 20;

struct ImportedIsland {
  IslandSpec spec;
  std::map<IVec3, Chunk> chunks;  ///< of level 0; those that are all air are left out
  std::string grid;
  std::uint64_t blocks = 0;  ///< that are not air
  double threshold = 0.0;    ///< that was used
  /// How far the surface may be from where the file has it [blocks]: 0 when each voxel became one
  /// block or a cube of blocks, else half a block's diagonal, for a block is solid where its centre
  /// is.
  double error_blocks = 0.0;
  std::uint64_t unknown_ids = 0;  ///< blocks of unknown ids; now stone
};

}  // namespace skerry::world
