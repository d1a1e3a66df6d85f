#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "game/ui/triangles.h"

namespace skerry::game {

/// Draws overlay triangles over an RGBA8 picture that holds sRGB values.
class OverlayPass {
 public:
  /// Frames that may be in flight with buffers of their own.
  static constexpr std::uint32_t kSlots = 2;

  /// Errors: no memory on the device.
  static Result<std::unique_ptr<OverlayPass>> create(gpu::Device& device,
                                                     const ui::OverlayImages& images);

  /// Others in place of the pictures, of the same size; waits for the GPU. Errors: no memory.
  Result<void> set_pictures(const ui::PictureView& pictures);

  /// Another font, of any size; waits for the GPU. Errors: no memory; the old one stays.
  Result<void> set_font(const ui::FontAtlas& font);

  /// Adds the pass "overlay". @param picture drawn over, format VK_FORMAT_R8G8B8A8_UNORM. @param
  /// slot 0 .. kSlots - 1; the frame that used it last must have completed. @return the picture's
  /// new version. Errors: no memory.
  Result<gpu::ImageRef> add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            gpu::ImageRef picture, VkExtent2D size,
                            const ui::OverlayTriangles& triangles, std::uint32_t slot);

 private:
  struct Slot {
    gpu::Buffer vertices, clips;
  };
  OverlayPass(gpu::Device& device, gpu::Image font, gpu::Image pictures, VkSampler sampler);

  gpu::Device& device_;
  gpu::Image font_, pictures_;
  VkSampler sampler_;
  std::array<Slot, kSlots> slots_;
};

}  // namespace skerry::game
