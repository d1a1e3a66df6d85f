#include "engine/render/light/shadow_maps.h"

#include <algorithm>
#include <utility>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

namespace skerry::render {

namespace {

std::uint32_t layers_a_body(const ShadowLayout& layout) {
  const auto bodies = std::count(layout.casting.begin(), layout.casting.end(), true);
  return bodies == 0 ? 0 : layout.layers / static_cast<std::uint32_t>(bodies);
}

std::uint32_t all_layers(const ShadowLayout& layout) {
  return layout.layers + layout.spares;
}

/// Whether an array made for one layout serves another. At sunset the sun's layers stay for the
/// next twilight.
bool serves(const ShadowLayout& made, const ShadowLayout& wanted) {
  return wanted.edge == made.edge && layers_a_body(wanted) == layers_a_body(made) &&
         wanted.layers <= made.layers && all_layers(wanted) <= all_layers(made);
}

}  // namespace

Result<void> ShadowMaps::ensure(const ShadowLayout& layout) {
  if (layout.layers == 0 ? !maps_ : maps_ && serves(layout_, layout)) return {};
  maps_ = {};
  layout_ = layout;
  ++generation_;
  if (layout.layers == 0) return {};
  Result<gpu::Image> image =
      device_->create_image({.name = "shadow maps",
                             .format = VK_FORMAT_D32_SFLOAT,
                             .extent = {layout.edge, layout.edge},
                             .layers = all_layers(layout),
                             .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                             .array = true});
  if (!image) return image.error();
  maps_ = *std::move(image);
  return {};
}

}  // namespace skerry::render
