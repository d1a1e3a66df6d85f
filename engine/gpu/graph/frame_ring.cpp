#include "engine/gpu/graph/frame_ring.h"

#include "engine/core/check.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {

FrameRing::FrameRing(Device& device, std::uint32_t slots)
    : device_(device), slots_(slots), current_(slots - 1) {
  SKERRY_ASSERT(slots > 0);
  for (Slot& slot : slots_) {
    auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.queueFamilyIndex = device.queue_family();
    GPU_CHECK(vkCreateCommandPool(device.handle(), &pool, nullptr, &slot.pool));
    device.set_name(reinterpret_cast<std::uint64_t>(slot.pool), VK_OBJECT_TYPE_COMMAND_POOL,
                    "frame");
    auto allocate =
        vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    allocate.commandPool = slot.pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    GPU_CHECK(vkAllocateCommandBuffers(device.handle(), &allocate, &slot.commands));
    device.set_name(reinterpret_cast<std::uint64_t>(slot.commands), VK_OBJECT_TYPE_COMMAND_BUFFER,
                    "frame");
  }
}

FrameRing::~FrameRing() {
  for (const Slot& slot : slots_) {
    device_.retire(reinterpret_cast<std::uint64_t>(slot.pool), VK_OBJECT_TYPE_COMMAND_POOL,
                   VK_NULL_HANDLE, 0, {});
  }
}

FrameRing::Frame FrameRing::begin() {
  current_ = (current_ + 1) % static_cast<std::uint32_t>(slots_.size());
  const Slot& slot = slots_[current_];
  device_.wait(slot.value);
  device_.collect();
  begin_commands(slot);
  return {slot.commands, current_};
}

void FrameRing::begin_commands(const Slot& slot) {
  GPU_CHECK(vkResetCommandPool(device_.handle(), slot.pool, 0));
  auto begin = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  GPU_CHECK(vkBeginCommandBuffer(slot.commands, &begin));
}

void FrameRing::flush() {
  device_.wait(submit());
  begin_commands(slots_[current_]);
}

std::uint64_t FrameRing::submit(std::span<const VkSemaphoreSubmitInfo> waits,
                                std::span<const VkSemaphoreSubmitInfo> signals) {
  Slot& slot = slots_[current_];
  GPU_CHECK(vkEndCommandBuffer(slot.commands));
  slot.value = device_.submit(slot.commands, waits, signals);
  return slot.value;
}

}  // namespace skerry::gpu
