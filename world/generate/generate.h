#pragma once
#include <cstdint>
#include <memory>

#include "world/chunk.h"
#include "world/island.h"

namespace skerry::world {

struct IslandPlan;

/// Generates one island's voxels. Construction precomputes what all chunks share (height maps, tree
/// places ...); generate() is const and may run on many threads at once. Integer noise only: same
/// bits on every compiler, optimisation level, CPU and thread count.
class IslandGenerator {
 public:
  explicit IslandGenerator(const IslandSpec& spec);
  ~IslandGenerator();
  IslandGenerator(IslandGenerator&&) noexcept;
  IslandGenerator& operator=(IslandGenerator&&) noexcept;

  /// Voxels of one chunk with its one-voxel shell.
  /// @param chunk chunk coordinate at this level (docs/conventions.md).
  /// @param level a voxel's edge is 2^level blocks, 0..4. Coarse levels keep silhouettes, surface
  /// materials and tree crowns.
  /// @param out 66^3 ids, index z + 66 x + 66^2 y, position (0,0,0) is voxel (-1,-1,-1) of the
  /// chunk.
  /// @return false when all of out is air (the common case; found quickly), true otherwise. out is
  /// filled either way.
  bool generate_padded(IVec3 chunk, int level, std::span<BlockId> out) const;

  /// Chunks at this level that can hold anything but air: bounds are tight to within a chunk.
  /// Order: y, then x, then z.
  std::vector<IVec3> chunks(int level) const;

 private:
  std::unique_ptr<const IslandPlan> plan_;
};

}  // namespace skerry::world
