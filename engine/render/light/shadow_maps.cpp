#include "engine/render/light/shadow_maps.h"

#include <utility>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

namespace skerry::render {

Result<void> ShadowMaps::ensure(const ShadowLayout& layout) {
  if (layout == layout_ && (maps_ || layout.layers == 0)) return {};
  maps_ = {};
  layout_ = layout;
  ++generation_;
  if (layout.layers == 0) return {};
  Result<gpu::Image> image =
      device_->create_image({.name = "shadow maps",
                             .format = VK_FORMAT_D32_SFLOAT,
                             .extent = {layout.edge, layout.edge},
                             .layers = layout.layers,
                             .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                             .array = true});
  if (!image) return image.error();
  maps_ = *std::move(image);
  return {};
}

}  // namespace skerry::render
