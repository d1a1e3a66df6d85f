#include "game/client/overlay_pass.h"

#include <shader_names.h>
#include <bit>
#include <cstring>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/transfer/uploader.h"
#include "shaders/shared/bindings.h"

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

Result<gpu::Image> make_image(gpu::Device& device, const char* name, VkFormat format, int width,
                              int height) {
  return device.create_image(
      {.name = name,
       .format = format,
       .extent = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)},
       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
}

Result<gpu::Image> upload_font(gpu::Device& device, const ui::FontAtlas& font) {
  Result<gpu::Image> glyphs =
      make_image(device, "overlay_font", VK_FORMAT_R8_UNORM, font.width, font.height);
  if (!glyphs) return glyphs;
  gpu::Uploader uploader(device, gpu::UploadPath::kUpdateBuffer);
  if (const auto done = uploader.fill_image(*glyphs, std::as_bytes(font.texels)); !done)
    return done.error();
  return glyphs;
}

}  // namespace

Result<std::unique_ptr<OverlayPass>> OverlayPass::create(gpu::Device& device,
                                                         const ui::OverlayImages& images) {
  Result<gpu::Image> glyphs = upload_font(device, images.font);
  if (!glyphs) return glyphs.error();
  Result<gpu::Image> pictures = make_image(device, "overlay_pictures", VK_FORMAT_R8G8B8A8_UNORM,
                                           images.pictures.width, images.pictures.height);
  if (!pictures) return pictures.error();
  const Result<VkSampler> sampler = device.sampler({});
  if (!sampler) return sampler.error();
  std::unique_ptr<OverlayPass> pass(
      new OverlayPass(device, *std::move(glyphs), *std::move(pictures), *sampler));
  if (const auto done = pass->set_pictures(images.pictures); !done) return done.error();
  return pass;
}

OverlayPass::OverlayPass(gpu::Device& device, gpu::Image font, gpu::Image pictures,
                         VkSampler sampler)
    : device_(device), font_(std::move(font)), pictures_(std::move(pictures)), sampler_(sampler) {}

Result<void> OverlayPass::set_pictures(const ui::PictureView& pictures) {
  SKERRY_ASSERT(static_cast<std::uint32_t>(pictures.width) == pictures_.desc().extent.width &&
                static_cast<std::uint32_t>(pictures.height) == pictures_.desc().extent.height);
  gpu::Uploader uploader(device_, gpu::UploadPath::kUpdateBuffer);
  return uploader.fill_image(pictures_, std::as_bytes(pictures.pixels));
}

Result<void> OverlayPass::set_font(const ui::FontAtlas& font) {
  Result<gpu::Image> glyphs = upload_font(device_, font);
  if (!glyphs) return glyphs.error();
  font_ = *std::move(glyphs);
  return {};
}

Result<gpu::ImageRef> OverlayPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                       gpu::ImageRef picture, VkExtent2D size,
                                       const ui::OverlayTriangles& triangles, std::uint32_t slot) {
  SKERRY_ASSERT(slot < kSlots);
  if (triangles.vertices.empty()) return picture;
  Slot& buffers = slots_[slot];
  if (auto done = fill(device_, buffers.vertices, "overlay_vertices", triangles.vertices); !done)
    return done.error();
  if (auto done = fill(device_, buffers.clips, "overlay_clips", triangles.clips); !done)
    return done.error();
  const gpu::BufferRef vertices = graph.import(buffers.vertices),
                       clips = graph.import(buffers.clips);
  const gpu::ImageRef font = graph.import(font_), pictures = graph.import(pictures_);
  const auto program =
      gpu::graphics(pipelines, programs::kDrawOverlayVert, programs::kDrawOverlayFrag,
                    gpu::GraphicsDesc{.constants = {},
                                      .color_formats = {VK_FORMAT_R8G8B8A8_UNORM},
                                      .cull = VK_CULL_MODE_NONE,
                                      .blend = gpu::Blend::kOver});
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
        b.read(pictures, Use::kFragmentRead);
        drawn = b.color(picture, gpu::Load::keep());
      },
      [program, vertices, clips, font, pictures, constants, count,
       sampler = sampler_](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kOverlayVerticesBinding>(vertices),
                  gpu::storage<shared::kOverlayClipsBinding>(clips),
                  gpu::sampled<shared::kFontBinding>(font, sampler),
                  gpu::sampled<shared::kOverlayPicturesBinding>(pictures, sampler),
                  gpu::constants(constants));
        c.draw(count, 1);
      });
  return drawn;
}

}  // namespace skerry::game
