#pragma once
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/plan/temporal_plan.h"
#include "engine/render/post/edge_pass.h"
#include "engine/render/post/kept_frames.h"

namespace skerry::render {

/// The picture of this frame mixed with those before (`aa=temporal`): each pixel at an edge finds
/// by the exact motion of what it shows where that was in earlier frames, and what they showed
/// there of the same surfaces. docs/decisions/0088.
struct TemporalPass {
  struct In {
    const TemporalPlan& plan;
    KeptFrames& kept;
    gpu::Image& picture;        ///< RGBA8, of the G-buffer's size; the one that was developed
                                ///< unless the frame is at rest
    gpu::ImageRef water_depth;  ///< nearest layer of water and glass; empty: there is none
    bool clouds;                ///< some are in view
  };
  static Developed add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                       const Geometry& geometry, SmoothEdges fresh, const In& in);
};

}  // namespace skerry::render
