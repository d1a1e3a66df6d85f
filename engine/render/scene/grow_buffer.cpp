#include "engine/render/scene/grow_buffer.h"

#include <utility>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::render {

Result<void> grow_buffer(gpu::Device& device, gpu::Buffer& buffer, std::uint64_t size_bytes) {
  Result<gpu::Buffer> bigger =
      device.create_buffer({buffer.name(), size_bytes, kTableUsage, gpu::Memory::kDevice});
  if (!bigger) return bigger.error();
  device.run_now([&](VkCommandBuffer commands) {
    auto barrier = gpu::vk_struct<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    auto dependency = gpu::vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
    const VkBufferCopy region{0, 0, buffer.size_bytes()};
    vkCmdCopyBuffer(commands, buffer.handle(), bigger->handle(), 1, &region);
    vkCmdPipelineBarrier2(commands, &dependency);
  });
  buffer = *std::move(bigger);
  return {};
}

}  // namespace skerry::render
