#include "engine/gpu/transfer/readback.h"

#include <algorithm>

#include "engine/core/check.h"
#include "engine/gpu/device/access.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

namespace skerry::gpu {
namespace {

constexpr Access kRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, false};
constexpr Access kWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                        VK_IMAGE_LAYOUT_UNDEFINED, true};
constexpr Access kHost{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT,
                       VK_IMAGE_LAYOUT_UNDEFINED, false};

Result<Buffer> landing(Device& device, std::uint64_t bytes) {
  return device.create_buffer(
      {"readback", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::kReadback});
}

std::vector<std::byte> contents(const Buffer& buffer) {
  return {buffer.mapped(), buffer.mapped() + buffer.size_bytes()};
}

}  // namespace

Result<std::vector<std::byte>> read_back(Device& device, Buffer& from, std::uint64_t offset_bytes,
                                         std::uint64_t size_bytes) {
  SKERRY_ASSERT(offset_bytes <= from.size_bytes() &&
                size_bytes <= from.size_bytes() - offset_bytes);
  if (size_bytes == 0) return std::vector<std::byte>{};
  Result<Buffer> to = landing(device, size_bytes);
  if (!to) return to.error();
  device.run_now([&](VkCommandBuffer commands) {
    touch(device, commands, from, kRead);
    touch(device, commands, *to, kWrite);
    const VkBufferCopy region{offset_bytes, 0, size_bytes};
    vkCmdCopyBuffer(commands, from.handle(), to->handle(), 1, &region);
    touch(device, commands, *to, kHost);
  });
  return contents(*to);
}

Result<std::vector<std::byte>> read_back(Device& device, Image& from, std::uint32_t texel_bytes,
                                         std::uint32_t mip, std::uint32_t layer) {
  const ImageDesc& desc = from.desc();
  SKERRY_ASSERT(mip < desc.mips && layer < desc.layers);
  const VkExtent3D extent{std::max(1u, desc.extent.width >> mip),
                          std::max(1u, desc.extent.height >> mip), 1};
  Result<Buffer> to = landing(device, std::uint64_t{extent.width} * extent.height * texel_bytes);
  if (!to) return to.error();
  device.run_now([&](VkCommandBuffer commands) {
    touch(device, commands, from, kRead);
    touch(device, commands, *to, kWrite);
    VkBufferImageCopy region{};
    region.imageSubresource = {from.aspect(), mip, layer, 1};
    region.imageExtent = extent;
    vkCmdCopyImageToBuffer(commands, from.handle(), from.state.layout, to->handle(), 1, &region);
    touch(device, commands, *to, kHost);
  });
  return contents(*to);
}

}  // namespace skerry::gpu
