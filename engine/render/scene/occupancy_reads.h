#pragma once
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {

/// What a shader that includes occupancy.glsl reads. Without a store, buffers of the scene that are
/// never read are bound in its place, so that every binding is valid.
class OccupancyReads {
 public:
  /// @param wanted whether the pass looks anything up; without a store it cannot.
  OccupancyReads(const SceneRefs& scene, bool wanted);
  /// Whether anything is looked up.
  explicit operator bool() const { return read_; }
  void declare(gpu::PassBuilder& builder) const;
  auto bindings() const {
    return std::tuple{gpu::storage<shared::kOccupancyGridsBinding>(grids_),
                      gpu::storage<shared::kOccupancyTablesBinding>(tables_),
                      gpu::storage<shared::kOccupancyBricksBinding>(words_)};
  }

 private:
  bool read_;
  gpu::BufferRef grids_, tables_, words_;
};

/// A shader's constants with that of corners.glsl.
std::vector<gpu::SpecConstant> with_ao(std::vector<gpu::SpecConstant> own, bool ao);

}  // namespace skerry::render
