#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "engine/render/frame/phases.h"
#include "engine/render/light/light_clusters.h"
#include "engine/render/plan/frame_plan.h"
#include "engine/render/post/bloom_pass.h"
#include "engine/render/post/capture.h"
#include "engine/render/post/edge_pass.h"
#include "engine/render/post/kept_frames.h"
#include "engine/render/post/meter_pass.h"
#include "engine/render/post/picture.h"
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
  KeptFrames& kept;
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
  std::optional<CulledDraws> revealed{};  ///< none: the camera's view is drawn in one phase
  std::optional<Geometry> geometry{};
  std::optional<Shadows> shadows{};
  TranslucentPass::Layers layers{};
  gpu::ImageRef glass{};  ///< maps of it; empty: it takes no light
  std::optional<ClusteredLights> lights{};
  std::optional<Shaded> shaded{};
  Metered metered{};
  std::optional<Bloom> bloom{};
  std::optional<Developed> developed{};
  std::optional<EdgeLists> edges{};  ///< of aa=edge and temporal

  const ClusteredLights* lights_or_null() const { return lights ? &*lights : nullptr; }
};

/// Passes that a frame needs, or lacks for one reason.
struct StepPasses {
  /// Null: the frame needs them. Else why it does not.
  const char* (*why_not)(const FramePlan& plan);
  /// Listed as left out with that reason; empty: their absence goes without saying.
  std::vector<std::string_view> names{};
};

/// One step of a frame. It is added when the frame needs some of its passes.
struct FrameStep {
  std::vector<StepPasses> passes;
  void (*add)(FrameAssembly& frame);
  /// Where the frame's radiance has to be an image because of this step; null: nowhere. What no
  /// step wants to be one, shading writes to the picture (FramePlan::by_radiance, not known yet).
  ByRadiance (*by_radiance)(const FramePlan& plan) = nullptr;
};

}  // namespace skerry::render
