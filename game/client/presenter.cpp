#include "game/client/presenter.h"

#include <utility>

#include "engine/core/clock.h"

namespace skerry::game {

Result<std::unique_ptr<Presenter>> Presenter::create(gpu::Device& device, VkSurfaceKHR surface,
                                                     const ui::OverlayImages& images) {
  auto swapchain = gpu::Swapchain::create(device, surface, gpu::Sync::kOff);
  if (!swapchain) return swapchain.error();
  auto overlay_pass = OverlayPass::create(device, images);
  if (!overlay_pass) return overlay_pass.error();
  return std::unique_ptr<Presenter>(
      new Presenter(device, *std::move(swapchain), *std::move(overlay_pass)));
}

Presenter::Presenter(gpu::Device& device, std::unique_ptr<gpu::Swapchain> swapchain,
                     std::unique_ptr<OverlayPass> overlay_pass)
    : device_(device),
      pipelines_(device),
      graph_(&device),
      ring_(device, OverlayPass::kSlots),
      swapchain_(std::move(swapchain)),
      overlay_pass_(std::move(overlay_pass)) {}

void Presenter::set_sync(gpu::Sync sync) {
  if (std::exchange(sync_, sync) != sync) swapchain_->set_sync(sync);
}

std::optional<gpu::SwapchainFrame> Presenter::acquire(VkExtent2D window_px) {
  const Stopwatch watch;
  const std::optional<gpu::SwapchainFrame> frame = swapchain_->acquire(window_px);
  waited_s_ += watch.seconds();
  return frame;
}

Result<void> Presenter::fit_canvas(VkExtent2D size) {
  if (canvas_ && gpu::same_size(canvas_.desc().extent, size)) return {};
  Result<gpu::Image> canvas = device_.create_image({.name = "window_canvas",
                                                    .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                    .extent = size,
                                                    .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                             VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
  if (!canvas) return canvas.error();
  canvas_ = *std::move(canvas);
  return {};
}

Result<void> Presenter::draw_overlay(VkCommandBuffer commands, gpu::Image* picture,
                                     const ui::OverlayTriangles& triangles) {
  const VkExtent2D size = picture ? picture->desc().extent : swapchain_->extent();
  if (auto done = fit_canvas(size); !done) return done;
  slot_ = (slot_ + 1) % OverlayPass::kSlots;
  device_.wait(slot_values_[slot_]);  // two frames ago: done long since
  graph_.begin();
  const gpu::ImageRef from = picture ? graph_.import(*picture) : gpu::ImageRef{};
  gpu::ImageRef to = graph_.import(canvas_);
  graph_.add_pass(
      picture ? "copy_picture" : "clear_canvas",
      [&](gpu::PassBuilder& b) {
        if (from) b.read(from, gpu::Use::kTransferRead);
        to = b.write(to, gpu::Use::kTransferWrite);
      },
      [from, &to, size](gpu::Commands& c) {
        if (!from) return c.clear(to, {});
        VkImageCopy region{};
        region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.extent = {size.width, size.height, 1};
        vkCmdCopyImage(c.raw(), c.image(from).handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       c.image(to).handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
      });
  const gpu::ImageRef copied = to;
  if (auto drawn = overlay_pass_->add(graph_, pipelines_, copied, size, triangles, slot_); !drawn)
    return drawn.error();
  graph_.compile();
  graph_.execute(commands, slot_);
  return {};
}

Result<void> Presenter::record(VkCommandBuffer commands, gpu::Image& picture,
                               const gpu::SwapchainFrame& frame,
                               const ui::OverlayTriangles* overlay) {
  Result<void> done;
  if (overlay) done = draw_overlay(commands, &picture, *overlay);
  swapchain_->show(commands, overlay && done ? canvas_ : picture, frame);
  swapchain_->finish(commands, frame);
  return done;
}

Result<void> Presenter::show_again(gpu::Image& picture, const gpu::SwapchainFrame& frame,
                                   const ui::OverlayTriangles& overlay) {
  const gpu::FrameRing::Frame commands = ring_.begin();
  const Result<void> recorded =
      record(commands.commands, picture, frame, overlay.vertices.empty() ? nullptr : &overlay);
  present(frame, ring_.submit({&frame.wait, 1}, {&frame.signal, 1}));
  return recorded;
}

Result<void> Presenter::show_alone(const gpu::SwapchainFrame& frame,
                                   const ui::OverlayTriangles& overlay) {
  if (auto done = fit_canvas(swapchain_->extent()); !done) return done;
  const gpu::FrameRing::Frame commands = ring_.begin();
  const Result<void> drawn = draw_overlay(commands.commands, nullptr, overlay);
  swapchain_->show(commands.commands, canvas_, frame);
  swapchain_->finish(commands.commands, frame);
  present(frame, ring_.submit({&frame.wait, 1}, {&frame.signal, 1}));
  return drawn;
}

void Presenter::present(const gpu::SwapchainFrame& frame, std::uint64_t value) {
  slot_values_[slot_] = value;
  swapchain_->present(frame);
}

}  // namespace skerry::game
