#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "engine/render/frame/phases.h"
#include "engine/render/light/light_clusters.h"
#include "engine/render/post/bloom_pass.h"
#include "engine/render/post/capture.h"
#include "engine/render/post/meter_pass.h"
#include "engine/render/post/picture.h"
#include "engine/render/renderer/frame_plan.h"
#include "engine/render/scene/cull_pass.h"
#include "engine/render/sky/clouds.h"
#include "engine/render/surface/translucent_pass.h"

namespace skerry::render {

/// What outlives a frame and its passes write to.
struct FrameOwners {
  LightClusters& light_clusters;
  Clouds& clouds;
  Captures& captures;
  Picture& picture;
};

/// A frame's graph as its steps build it: each takes the phases that earlier ones left and leaves
/// its own.
struct FrameAssembly {
  gpu::FrameGraph& graph;
  gpu::Pipelines& pipelines;
  const FramePlan& plan;
  FrameOwners& owners;
  SceneRefs scene;
  gpu::ImageRef shadow_maps;  ///< empty: nothing casts
  std::optional<CulledDraws> draws{};
  std::optional<Geometry> geometry{};
  std::optional<Shadows> shadows{};
  TranslucentPass::Layers layers{};
  std::optional<ClusteredLights> lights{};
  std::optional<Shaded> shaded{};
  Metered metered{};
  std::optional<Bloom> bloom{};
  std::optional<Developed> developed{};

  const ClusteredLights* lights_or_null() const { return lights ? &*lights : nullptr; }
};

/// One step of a frame. A new pass is a row of the table in frame_steps.cpp.
struct FrameStep {
  /// Passes that are named as left out when the step is; empty: its absence goes without saying.
  std::span<const std::string_view> passes;
  /// Null: the frame needs it. Else why it does not.
  const char* (*why_not)(const FramePlan& plan);
  void (*add)(FrameAssembly& frame);
};

/// All steps, in the order of a frame.
std::span<const FrameStep> frame_steps();

}  // namespace skerry::render
