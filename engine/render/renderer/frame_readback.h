#pragma once
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/render/frame/frame_report.h"
#include "engine/render/frame/scene_refs.h"

namespace skerry::render {

/// What one frame in flight counts on the GPU, on its way to the CPU.
class FrameReadback {
 public:
  /// Errors: out of memory.
  Result<void> create(gpu::Device& device);
  /// Copies it, behind all that counts.
  /// @param cull_stats shared::CullStats[views], null: nothing was culled.
  /// @param cluster_work shared::ClusterWork, empty: no lights were sorted.
  void add(gpu::FrameGraph& graph, const SceneRefs& scene, const gpu::BufferRef* cull_stats,
           std::uint32_t views, gpu::BufferRef cluster_work);
  /// Fills in camera, shadows, pixels, clusters and exposure. @pre the frame has completed.
  void take(FrameReport& into) const;

 private:
  gpu::Buffer buffer_;       // CullStats[kViewCount], then PixelStats, Exposure, ClusterWork
  std::uint32_t views_ = 0;  // entries of CullStats that the frame wrote
  bool clusters_ = false;    // whether it wrote ClusterWork
};

}  // namespace skerry::render
