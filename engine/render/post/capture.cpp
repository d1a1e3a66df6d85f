#include "engine/render/post/capture.h"

#include <glm/gtc/packing.hpp>

#include "engine/core/check.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

namespace skerry::render {

Result<void> Captures::reserve(Capture what, VkExtent2D size, std::uint32_t layers,
                               std::uint32_t texel_bytes) {
  Result<gpu::Buffer> made = device_->create_buffer(
      {"capture", std::uint64_t{size.width} * size.height * layers * texel_bytes,
       VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::kReadback});
  if (!made) return made.error();
  room(what) = {*std::move(made), size, layers};
  return {};
}

Result<void> Captures::begin(VkExtent2D picture, VkExtent2D drawn, bool geometry,
                             const gpu::Image* maps) {
  rooms_ = {};
  if (Result<void> ok = reserve(Capture::kRadiance, picture, 1, 8); !ok) return ok;
  if (!geometry) return {};
  if (Result<void> ok = reserve(Capture::kDepth, drawn, 1, 4); !ok) return ok;
  if (Result<void> ok = reserve(Capture::kSurfaces, drawn, 1, 4); !ok) return ok;
  if (!maps) return {};
  return reserve(Capture::kShadowMaps, maps->desc().extent, maps->desc().layers, 4);
}

void Captures::add(gpu::FrameGraph& graph, Capture what, gpu::ImageRef image) {
  SKERRY_ASSERT(room(what).buffer);
  gpu::BufferRef to = graph.import(room(what).buffer);
  graph.add_pass(
      "capture",
      [&](gpu::PassBuilder& b) {
        b.read(image, gpu::Use::kTransferRead);
        to = b.write(to, gpu::Use::kTransferWrite);
      },
      [image, to](gpu::Commands& c) { c.copy(image, to); });
  graph.add_pass(
      "capture_to_cpu",
      [&](gpu::PassBuilder& b) {
        b.read(to, gpu::Use::kHostRead);
        b.keep();
      },
      [](gpu::Commands&) {});
}

Captured Captures::take(Capture what) const {
  const Room& from = rooms_[static_cast<std::size_t>(what)];
  Captured out{from.size, from.layers, {}};
  if (from.buffer)
    out.texels.assign(from.buffer.mapped(), from.buffer.mapped() + from.buffer.size_bytes());
  return out;
}

gpu::ImageRef FaultPass::add(gpu::FrameGraph& graph, gpu::ImageRef image, const Fault& fault) {
  gpu::BufferRef texel = graph.create(gpu::BufferDesc{"fault", 8});
  const std::uint32_t half = glm::packHalf1x16(fault.value);
  graph.add_pass(
      "fill_fault", [&](gpu::PassBuilder& b) { texel = b.write(texel, gpu::Use::kTransferWrite); },
      [texel, half](gpu::Commands& c) { c.fill(texel, 0, 8, half << 16 | half); });
  graph.add_pass(
      "inject_fault",
      [&](gpu::PassBuilder& b) {
        b.read(texel, gpu::Use::kTransferRead);
        image = b.write(image, gpu::Use::kTransferWrite);
      },
      [texel, image, at = fault.texel](gpu::Commands& c) {
        c.copy_texel(texel, image,
                     {static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y)});
      });
  return image;
}

Shaded FaultPass::add(gpu::FrameGraph& graph, Shaded shaded, const Fault& fault) {
  return Shaded(add(graph, shaded.radiance(), fault));
}

}  // namespace skerry::render
