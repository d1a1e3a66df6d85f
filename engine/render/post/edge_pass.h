#pragma once
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "shaders/shared/frame.h"

namespace skerry::render {

/// Pixels at edges of surfaces.
struct EdgeLists {
  gpu::BufferRef dispatches;  ///< shared::TileDispatch[kEdgeDispatches]
  gpu::BufferRef tiles;       ///< x | y << 16
  gpu::BufferRef pixels;      ///< shared::EdgePixel[]
};

struct SmoothEdges {
  Developed picture;
  EdgeLists lists;
};

/// Smooth edges from one sample a pixel (`aa=edge`): pixels at edges of surfaces are listed, and
/// show the surfaces around them by the share that each covers, which planes and lattice lines give
/// exactly. docs/decisions/0043.
struct EdgePass {
  /// @param developed a picture of the G-buffer's size. @param frame of the same frame.
  static SmoothEdges add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                         const Geometry& geometry, Developed developed,
                         const shared::FrameConstants& frame);
};

}  // namespace skerry::render
