#include "engine/render/scene/gbuffer_formats.h"

#include "engine/gpu/device/device.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

VkFormat normal_format(NormalStore store) {
  switch (store) {
    case NormalStore::kExact:
      return VK_FORMAT_UNDEFINED;
    case NormalStore::kOct8:
      return VK_FORMAT_R8G8_SNORM;
    case NormalStore::kOct16:
      return VK_FORMAT_R16G16_SNORM;
    case NormalStore::kRgb8:
      return VK_FORMAT_R8G8B8A8_SNORM;
    case NormalStore::kRgb10a2:
      return VK_FORMAT_A2B10G10R10_UNORM_PACK32;
    case NormalStore::kRgba16f:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
  }
  return VK_FORMAT_UNDEFINED;
}

VkFormat position_format(PositionStore store) {
  switch (store) {
    case PositionStore::kDepth:
      return VK_FORMAT_UNDEFINED;
    case PositionStore::kRgba16f:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    case PositionStore::kRgba32f:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
  }
  return VK_FORMAT_UNDEFINED;
}

VkFormat depth_format(DepthStore store) {
  return store == DepthStore::kD16 ? VK_FORMAT_D16_UNORM : VK_FORMAT_D32_SFLOAT;
}

std::uint32_t normal_code(NormalStore store) {
  switch (store) {
    case NormalStore::kExact:
      return 0;
    case NormalStore::kOct8:
    case NormalStore::kOct16:
      return 1;
    case NormalStore::kRgb8:
    case NormalStore::kRgba16f:
      return 2;
    case NormalStore::kRgb10a2:
      return 3;
  }
  return 0;
}

SurfaceReads::SurfaceReads(const Geometry& geometry)
    : words(geometry.surfaces()),
      depth(geometry.depth()),
      normals(geometry.normals()),
      positions(geometry.positions()),
      store(geometry.store()) {}

std::vector<gpu::SpecConstant> SurfaceReads::with_store(std::vector<gpu::SpecConstant> own) const {
  if (normals) own.push_back({shared::kNormalCodeConstant, normal_code(store.normal)});
  if (positions) own.push_back({shared::kPositionStoredConstant, 1});
  return with_depth(std::move(own));
}

std::vector<gpu::SpecConstant> SurfaceReads::with_depth(std::vector<gpu::SpecConstant> own) const {
  if (store.depth == DepthStore::kD16) own.push_back({shared::kDepth16Constant, 1});
  return own;
}

void SurfaceReads::declare(gpu::PassBuilder& builder) const {
  builder.read(words, gpu::Use::kComputeRead);
  for (const gpu::ImageRef image : {depth, normals, positions})
    if (image) builder.read(image, gpu::Use::kComputeSampled);
}

Result<void> check_store(const gpu::Device& device, const GBufferStore& store) {
  constexpr VkFormatFeatureFlags kColor =
      VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
  const auto can = [&](VkFormat format) {
    if (format == VK_FORMAT_UNDEFINED) return true;
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device.physical(), format, &properties);
    return (properties.optimalTilingFeatures & kColor) == kColor;
  };
  // Vulkan 1.3 demands the other formats of every device; not the signed normalised ones.
  if (!can(normal_format(store.normal)))
    return Error{
        "cannot keep normals that way: this device does not draw to signed normalised images; set "
        "gbuffer.normal to exact, rgb10a2 or rgba16f"};
  return {};
}

}  // namespace skerry::render
