#include "engine/gpu/device/resources.h"

#include <map>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {
namespace {

constexpr VkImageUsageFlags kViewable = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;

VkImageView create_view(ResourceOwner& owner, VkImage image, const ImageDesc& desc,
                        VkImageViewType type, const VkImageSubresourceRange& range) {
  auto info = vk_struct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  info.image = image;
  info.viewType = type;
  info.format = desc.format;
  info.subresourceRange = range;
  VkImageView view{};
  GPU_CHECK(vkCreateImageView(owner.handle(), &info, nullptr, &view));
  owner.set_name(reinterpret_cast<std::uint64_t>(view), VK_OBJECT_TYPE_IMAGE_VIEW,
                 desc.name.c_str());
  return view;
}

void retire_view(ResourceOwner& owner, VkImageView view, const std::string& name) {
  owner.retire(reinterpret_cast<std::uint64_t>(view), VK_OBJECT_TYPE_IMAGE_VIEW, VK_NULL_HANDLE, 0,
               name);
}

}  // namespace

Buffer::~Buffer() {
  if (!owner_) return;
  if (texels_)
    owner_->retire(reinterpret_cast<std::uint64_t>(texels_), VK_OBJECT_TYPE_BUFFER_VIEW,
                   VK_NULL_HANDLE, 0, name_);
  owner_->retire(reinterpret_cast<std::uint64_t>(handle_), VK_OBJECT_TYPE_BUFFER, memory_,
                 allocated_, name_);
}

void Buffer::swap(Buffer& other) noexcept {
  std::swap(state, other.state);
  std::swap(owner_, other.owner_);
  std::swap(handle_, other.handle_);
  std::swap(texels_, other.texels_);
  std::swap(memory_, other.memory_);
  std::swap(size_, other.size_);
  std::swap(allocated_, other.allocated_);
  std::swap(mapped_, other.mapped_);
  std::swap(name_, other.name_);
}

struct Image::Views {
  std::map<std::pair<std::uint32_t, std::uint32_t>, VkImageView> by_mip_and_layer;
};

void Image::adopt(ResourceOwner& owner, VkDeviceMemory memory, std::uint64_t allocated,
                  const ImageDesc& desc) {
  owner_ = &owner;
  memory_ = memory;
  allocated_ = allocated;
  desc_ = desc;
  views_ = new Views;
  if (!(desc.usage & kViewable)) return;
  const bool array = desc.array || desc.layers > 1;
  const VkImageViewType flat = array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  view_ = create_view(owner, handle_, desc, desc.depth != 0 ? VK_IMAGE_VIEW_TYPE_3D : flat,
                      {aspect(), 0, desc.mips, 0, desc.layers});
}

Image::~Image() {
  if (!owner_) return;
  for (const auto& [where, view] : views_->by_mip_and_layer) retire_view(*owner_, view, desc_.name);
  delete views_;
  if (view_) retire_view(*owner_, view_, desc_.name);
  owner_->retire(reinterpret_cast<std::uint64_t>(handle_), VK_OBJECT_TYPE_IMAGE, memory_,
                 allocated_, desc_.name);
}

VkImageView Image::view_of(std::uint32_t mip, std::uint32_t layer) const {
  SKERRY_ASSERT(owner_ && mip < desc_.mips && layer < desc_.layers);
  if (!desc_.array && desc_.mips == 1 && desc_.layers == 1) return view_;
  VkImageView& view = views_->by_mip_and_layer[{mip, layer}];
  if (!view)
    view =
        create_view(*owner_, handle_, desc_, VK_IMAGE_VIEW_TYPE_2D, {aspect(), mip, 1, layer, 1});
  return view;
}

VkImageAspectFlags Image::aspect() const {
  switch (desc_.format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    default:
      return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

void Image::swap(Image& other) noexcept {
  std::swap(state, other.state);
  std::swap(owner_, other.owner_);
  std::swap(handle_, other.handle_);
  std::swap(view_, other.view_);
  std::swap(memory_, other.memory_);
  std::swap(allocated_, other.allocated_);
  std::swap(views_, other.views_);
  std::swap(desc_, other.desc_);
}

}  // namespace skerry::gpu
