#pragma once
#include <optional>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/camera.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "shaders/shared/marker.h"

namespace skerry::render {

/// The pass's constants for a marked block. None: no pixel of it is in view.
std::optional<shared::MarkerConstants> marker_constants(const BlockMarker& marker,
                                                        const IslandPlacement& island,
                                                        const Camera& camera, VkExtent2D picture);

/// Draws the outline of the block that a player points at, and the cracks of digging, over the
/// picture; what is nearer hides them. A compute pass over the pixels that they can touch.
struct MarkerPass {
  static Developed add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                       const Geometry& geometry, Developed developed,
                       const shared::MarkerConstants& marker);
};

}  // namespace skerry::render
