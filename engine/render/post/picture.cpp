#include "engine/render/post/picture.h"

#include <fmt/format.h>

namespace skerry::render {

/// Makes an image anew unless it has its size already.
Result<void> Picture::remake(gpu::Image& image, const gpu::ImageDesc& desc) {
  if (image && image.desc().extent.width == desc.extent.width &&
      image.desc().extent.height == desc.extent.height)
    return {};
  image = {};
  Result<gpu::Image> made = device_->create_image(desc);
  if (!made) return made.error();
  image = *std::move(made);
  return {};
}

Result<void> Picture::resize(VkExtent2D size, int samples, std::uint32_t parts) {
  const std::uint32_t limit = device_->limits().max_image_edge;
  const std::uint32_t most = limit / static_cast<std::uint32_t>(samples);
  if (size.width == 0 || size.height == 0 || size.width > most || size.height > most)
    return Error{
        samples == 1
            ? fmt::format("cannot draw a picture of {}x{} pixels: the device takes 1 to {} along "
                          "an edge; choose another --size",
                          size.width, size.height, limit)
            : fmt::format("cannot draw a picture of {}x{} pixels with aa.samples={}: the device "
                          "takes 1 to {} samples along an edge; choose fewer samples or another "
                          "--size",
                          size.width, size.height, samples * samples, limit)};
  if (Result<void> ok =
          remake(image_, {.name = "picture",
                          .format = VK_FORMAT_R8G8B8A8_UNORM,
                          .extent = size,
                          .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
      !ok)
    return ok;
  if (parts == 1) {
    total_ = {};
    return {};
  }
  return remake(total_, {.name = "total of parts",
                         .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                         .extent = size,
                         .usage = VK_IMAGE_USAGE_STORAGE_BIT});
}

}  // namespace skerry::render
