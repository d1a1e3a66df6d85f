#pragma once
#include <optional>

#include "engine/gpu/device.h"
#include "engine/gpu/frame_graph.h"
#include "engine/gpu/pipeline.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/post/capture.h"

namespace skerry::render {

/// The picture that frames are made for, and how radiance becomes it.
class Picture {
 public:
  explicit Picture(gpu::Device& device) : device_(&device) {}

  /// Makes room for a picture, and for the sum of its parts if there are several.
  /// Errors: a size that the device cannot draw; out of memory.
  Result<void> resize(VkExtent2D size, int samples_per_edge, std::uint32_t parts);
  /// Makes pixels of samples, copies radiance out if asked to, meters and develops it.
  /// @return none: the picture has parts to come.
  std::optional<Developed> finish(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                  Captures& captures, SceneRefs& scene, Shaded shaded,
                                  const FrameInput& input, const RenderSettings& settings);
  /// RGBA8. @pre resize()
  gpu::Image& image() { return image_; }

 private:
  Result<void> remake(gpu::Image& image, const gpu::ImageDesc& desc);

  gpu::Device* device_;
  gpu::Image image_;
  gpu::Image total_;  // of a picture's parts; empty when it has one
};

}  // namespace skerry::render
