#include "engine/render/post/picture.h"

#include <fmt/format.h>

namespace skerry::render {

/// Makes an image anew unless it has its size already.
Result<void> Picture::remake(gpu::Image& image, const gpu::ImageDesc& desc) {
  if (image && gpu::same_size(image.desc().extent, desc.extent)) return {};
  image = {};
  Result<gpu::Image> made = device_->create_image(desc);
  if (!made) return made.error();
  image = *std::move(made);
  return {};
}

Result<void> Picture::resize(const Sizes& sizes, int samples, std::uint32_t parts) {
  const VkExtent2D size = sizes.shown;
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
  gpu::ImageDesc desc{.name = "picture",
                      .format = VK_FORMAT_R8G8B8A8_UNORM,
                      .extent = sizes.drawn,
                      .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                               VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
  if (Result<void> ok = remake(image_, desc); !ok) return ok;
  desc.name = "fresh picture";
  if (!sizes.mixed)
    fresh_ = {};
  else if (Result<void> ok = remake(fresh_, desc); !ok)
    return ok;
  desc.name = "enlarged picture";
  desc.extent = sizes.shown;
  if (gpu::same_size(sizes.drawn, size))
    enlarged_ = {};
  else if (Result<void> ok = remake(enlarged_, desc); !ok)
    return ok;
  if (parts == 1) {
    total_ = {};
    return {};
  }
  return remake(total_, {.name = "total of parts",
                         .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                         .extent = sizes.drawn,
                         .usage = VK_IMAGE_USAGE_STORAGE_BIT});
}

}  // namespace skerry::render
