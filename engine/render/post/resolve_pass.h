#pragma once
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"

namespace skerry::render {

/// Averages samples into pixels, before anything that works on pixels.
struct ResolvePass {
  struct In {
    int samples_per_edge = 1;           ///< of a pixel, 1, 2 or 4
    VkExtent2D picture_size{};          ///< becomes scene.size
    std::uint32_t part = 0, parts = 1;  ///< see FrameInput
    gpu::Image* total = nullptr;        ///< RGBA32F of the picture's size, where parts add up
  };
  /// @return the pixels; with the last part, of all parts.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    Shaded shaded, const In& in);
};

}  // namespace skerry::render
