#include "game/overlay_pass.h"

#include <bit>
#include <cstring>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/uploader.h"

namespace skerry::game {
namespace {

using gpu::Use;

/// Writes values into a mapped buffer, which is replaced by a larger one when they do not fit.
template <class T>
Result<void> fill(gpu::Device& device, gpu::Buffer& buffer, const char* name,
                  const std::vector<T>& values) {
  const std::uint64_t bytes = values.size() * sizeof(T);
  if (buffer.size_bytes() < bytes) {
    Result<gpu::Buffer> larger = device.create_buffer({.name = name,
                                                       .size_bytes = std::bit_ceil(bytes),
                                                       .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                                       .memory = gpu::Memory::kUpload});
    if (!larger) return larger.error();
    buffer = *std::move(larger);
  }
  std::memcpy(buffer.mapped(), values.data(), bytes);
  return {};
}

}  // namespace

Result<std::unique_ptr<OverlayPass>> OverlayPass::create(gpu::Device& device,
                                                         const FontAtlas& font) {
  Result<gpu::Image> image = device.create_image(
      {.name = "overlay_font",
       .format = VK_FORMAT_R8_UNORM,
       .extent = {static_cast<std::uint32_t>(font.width), static_cast<std::uint32_t>(font.height)},
       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
  if (!image) return image.error();
  gpu::Uploader uploader(device, gpu::UploadPath::kUpdateBuffer);
  if (const auto done = uploader.fill_image(*image, std::as_bytes(font.texels)); !done)
    return done.error();
  const Result<VkSampler> sampler = device.sampler({});
  if (!sampler) return sampler.error();
  return std::unique_ptr<OverlayPass>(new OverlayPass(device, *std::move(image), *sampler));
}

OverlayPass::OverlayPass(gpu::Device& device, gpu::Image font, VkSampler sampler)
    : device_(device), font_(std::move(font)), sampler_(sampler) {}

Result<gpu::ImageRef> OverlayPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                       gpu::ImageRef picture, VkExtent2D size,
                                       const OverlayTriangles& triangles, std::uint32_t slot) {
  SKERRY_ASSERT(slot < kSlots);
  if (triangles.vertices.empty()) return picture;
  Slot& buffers = slots_[slot];
  if (auto done = fill(device_, buffers.vertices, "overlay_vertices", triangles.vertices); !done)
    return done.error();
  if (auto done = fill(device_, buffers.clips, "overlay_clips", triangles.clips); !done)
    return done.error();
  const gpu::BufferRef vertices = graph.import(buffers.vertices),
                       clips = graph.import(buffers.clips);
  const gpu::ImageRef font = graph.import(font_);
  const gpu::Pipeline& pipeline =
      pipelines.get(gpu::GraphicsDesc{.vertex = "draw_overlay.vert",
                                      .fragment = "draw_overlay.frag",
                                      .constants = {},
                                      .color_formats = {VK_FORMAT_R8G8B8A8_UNORM},
                                      .cull = VK_CULL_MODE_NONE,
                                      .blend = true});
  const auto count = static_cast<std::uint32_t>(triangles.vertices.size());
  const shared::OverlayConstants constants{
      {2.0f / static_cast<float>(size.width), 2.0f / static_cast<float>(size.height)}};
  gpu::ImageRef drawn = picture;
  graph.add_pass(
      "overlay",
      [&](gpu::PassBuilder& b) {
        b.read(vertices, Use::kVertexRead);
        b.read(clips, Use::kVertexRead);
        b.read(font, Use::kFragmentRead);
        drawn = b.color(picture, gpu::Load::keep());
      },
      [&pipeline, vertices, clips, font, constants, count, sampler = sampler_](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, vertices);
        c.storage(1, clips);
        c.sampled(2, font, sampler);
        c.push(constants);
        c.draw(count, 1);
      });
  return drawn;
}

}  // namespace skerry::game
