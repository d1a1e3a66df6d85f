#pragma once
#include <cstdint>
#include <memory>

#include "world/voxel/chunk.h"
#include "world/voxel/island.h"
#include "world/voxel/voxel_source.h"

namespace skerry::world {

struct IslandPlan;

/// Grows whenever a spec no longer generates the voxels that it did: edits that were saved before
/// lie on other ground then.
inline constexpr std::uint32_t kGeneratorVersion = 1;

/// Generates one island's voxels. Construction precomputes what all chunks share (height maps, tree
/// places ...); generate() is const and may run on many threads at once. Integer noise only: same
/// bits on every compiler, optimisation level, CPU and thread count.
class IslandGenerator final : public VoxelSource {
 public:
  explicit IslandGenerator(const IslandSpec& spec);
  ~IslandGenerator() override;
  IslandGenerator(IslandGenerator&&) noexcept;
  IslandGenerator& operator=(IslandGenerator&&) noexcept;

  /// Coarse levels keep silhouettes, surface materials and tree crowns. All air, the common case,
  /// is found quickly.
  bool generate_padded(IVec3 chunk, int level, std::span<BlockId> out) const override;
  /// Bounds are tight to within a chunk.
  std::vector<IVec3> chunks(int level) const override;

 private:
  std::unique_ptr<const IslandPlan> plan_;
};

}  // namespace skerry::world
