#pragma once
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/frame/settings.h"
#include "engine/render/scene/occupancy_reads.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {

/// What a shader reads that looks for walls before lights (shaders/include/light/traced.glsl), as
/// the settings have it.
class WallReads {
 public:
  /// @param looks_up the shader looks voxels up besides (corners, mirrors).
  WallReads(const SceneRefs& scene, const RenderSettings& settings, bool looks_up);
  std::vector<gpu::SpecConstant> with_walls(std::vector<gpu::SpecConstant> own) const;
  void declare(gpu::PassBuilder& builder) const;
  auto bindings() const {
    // Where none is traced, in place of what is then never read.
    return std::tuple{occupancy_.bindings(), gpu::storage<shared::kLightIslandsBinding>(islands_)};
  }

 private:
  bool traced_;
  std::uint32_t lights_, samples_;
  OccupancyReads occupancy_;
  gpu::BufferRef islands_;
};

}  // namespace skerry::render
