#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/gpu/graph/frame_graph.h"
#include "shaders/shared/clusters.h"
#include "shaders/shared/exposure.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {

/// Numbers of a frame the GPU has finished. Times, programs and allocations are sums over its
/// parts.
struct FrameReport {
  std::vector<gpu::PassTime> passes;
  double gpu_ms = 0.0;
  shared::CullStats camera{};
  shared::CullStats shadows{};  ///< sums over the cascades drawn
  shared::PixelStats pixels{};
  float exposure_ev = 0.0f;  ///< that the picture was developed at
  /// What the meter asks for; none if it was not asked, or every pixel it looked at was as good as
  /// black.
  std::optional<float> metered_ev;
  std::uint32_t lights = 0;        ///< whose range the view touches
  shared::ClusterWork clusters{};  ///< that those were sorted into; none under the oracle
  gpu::FrameCounts counts{};       ///< of the frame's graph
  int pipelines_created = 0;       ///< see Renderer::pipelines_created
  bool lagged = false;             ///< drawn by earlier settings: see FrameInput::may_lag
  int programs_made = 0;           ///< pipelines this frame had to wait for
  std::uint64_t allocations = 0;   ///< of device memory, in this frame
  std::uint64_t memory_bytes = 0;  ///< of the device, in use when the frame was recorded
};

}  // namespace skerry::render
