#include "engine/render/scene/occupancy_reads.h"

#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

OccupancyReads::OccupancyReads(const SceneRefs& scene, bool wanted)
    : read_(wanted && scene.occupancy_grids),
      grids_(read_ ? scene.occupancy_grids : scene.materials),
      tables_(read_ ? scene.occupancy_tables : scene.materials),
      words_(read_ ? scene.occupancy_words : scene.materials) {}

void OccupancyReads::declare(gpu::PassBuilder& builder) const {
  builder.read(grids_, gpu::Use::kComputeRead);
  if (!read_) return;
  builder.read(tables_, gpu::Use::kComputeRead);
  builder.read(words_, gpu::Use::kComputeRead);
}

std::vector<gpu::SpecConstant> with_ao(std::vector<gpu::SpecConstant> own, bool ao) {
  if (ao) own.push_back({shared::kAoConstant, 1});
  return own;
}

}  // namespace skerry::render
