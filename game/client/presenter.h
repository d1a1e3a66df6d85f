#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/graph/frame_ring.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/gpu/transfer/swapchain.h"
#include "game/client/overlay_pass.h"

namespace skerry::game {

/// Brings pictures to the window, with the overlay on top when there is one.
class Presenter {
 public:
  /// @param surface outlives this. Errors: the device cannot present to it, no memory.
  static Result<std::unique_ptr<Presenter>> create(gpu::Device& device, VkSurfaceKHR surface,
                                                   const ui::OverlayImages& images);

  /// See gpu::Swapchain::set_sync; to begin with it is off.
  void set_sync(gpu::Sync sync);
  bool waits_for_display() const { return swapchain_->waits_for_display(); }

  /// The window's next image; none while the window has no area.
  std::optional<gpu::SwapchainFrame> acquire(VkExtent2D window_px);
  /// Seconds that acquire() has waited since the last call.
  double take_waited_s() { return std::exchange(waited_s_, 0.0); }
  VkExtent2D extent() const { return swapchain_->extent(); }

  /// Records the way from a finished picture to the window's image. The picture stays without
  /// overlay: screenshots read it.
  /// @param overlay null: none, which saves a copy. Errors: no memory.
  Result<void> record(VkCommandBuffer commands, gpu::Image& picture,
                      const gpu::SwapchainFrame& frame, const ui::OverlayTriangles* overlay);
  /// See OverlayPass::set_pictures.
  Result<void> set_pictures(const ui::PictureView& pictures) {
    return overlay_pass_->set_pictures(pictures);
  }
  /// See OverlayPass::set_font.
  Result<void> set_font(const ui::FontAtlas& font) { return overlay_pass_->set_font(font); }
  /// Brings a picture that is finished to the window once more, with another overlay, and presents
  /// it. Errors: no memory.
  Result<void> show_again(gpu::Image& picture, const gpu::SwapchainFrame& frame,
                          const ui::OverlayTriangles& overlay);
  /// Presents triangles alone, over black. Errors: no memory.
  Result<void> show_alone(const gpu::SwapchainFrame& frame, const ui::OverlayTriangles& overlay);
  /// After the submit. @param value the timeline value it signals.
  void present(const gpu::SwapchainFrame& frame, std::uint64_t value);

 private:
  Presenter(gpu::Device& device, std::unique_ptr<gpu::Swapchain> swapchain,
            std::unique_ptr<OverlayPass> overlay_pass);
  Result<void> fit_canvas(VkExtent2D size);
  /// @param picture that lies under it; null: black.
  Result<void> draw_overlay(VkCommandBuffer commands, gpu::Image* picture,
                            const ui::OverlayTriangles& triangles);

  gpu::Device& device_;
  gpu::Pipelines pipelines_;
  gpu::FrameGraph graph_;
  gpu::FrameRing ring_;  // of pictures that are shown again
  std::unique_ptr<gpu::Swapchain> swapchain_;
  std::unique_ptr<OverlayPass> overlay_pass_;
  gpu::Image canvas_;  // the picture's copy that the overlay is drawn on
  std::array<std::uint64_t, OverlayPass::kSlots>
      slot_values_{};  // timeline values of the frames that used the slots last
  std::uint32_t slot_ = 0;
  gpu::Sync sync_ = gpu::Sync::kOff;
  double waited_s_ = 0.0;
};

}  // namespace skerry::game
