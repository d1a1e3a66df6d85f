#include "engine/gpu/device/access.h"

#include <array>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {

namespace {

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

/// One row a Use, in its order. Shader reads use the one general access bit: a stage then says it
/// all, which lets a state keep reads as a set of stages.
constexpr std::array kUses{
    UseInfo{VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
            VK_IMAGE_LAYOUT_UNDEFINED, 0, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},  // kIndirect
    UseInfo{VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT,
            VK_IMAGE_LAYOUT_UNDEFINED, 0, VK_BUFFER_USAGE_INDEX_BUFFER_BIT},  // kIndex
    UseInfo{VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
            VK_IMAGE_LAYOUT_UNDEFINED, 0, kStorage},  // kVertexRead
    UseInfo{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT,
            kStorage},  // kFragmentRead
    UseInfo{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
            VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT, kStorage},  // kComputeRead
    UseInfo{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT, 0,
            false},  // kComputeSampled
    UseInfo{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL,
            VK_IMAGE_USAGE_STORAGE_BIT, kStorage, true, true},  // kComputeWrite
    UseInfo{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
            VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0, false,
            true},  // kColor
    UseInfo{
        VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
        VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0, false, true},  // kDepth
    UseInfo{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
            VK_BUFFER_USAGE_TRANSFER_SRC_BIT},  // kTransferRead
    UseInfo{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_USAGE_TRANSFER_DST_BIT,
            VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, true},  // kTransferWrite
    UseInfo{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, 0,
            0},  // kHostRead
};
static_assert(kUses.size() == static_cast<std::size_t>(Use::kHostRead) + 1);

}  // namespace

UseInfo use_info(Use use) {
  return kUses[static_cast<std::size_t>(use)];
}

std::optional<Scopes> hazard(const AccessState& state, const Access& next) {
  if (state.stages == 0) return std::nullopt;
  const VkAccessFlags2 unseen_writes = state.written ? state.access & kWriteAccess : 0;
  const bool seen = !next.write && !state.written && (next.stages & ~state.stages) == 0;
  if (seen) return std::nullopt;
  return Scopes{state.stages, unseen_writes, next.stages, next.access};
}

AccessState after(const AccessState& state, const Access& next) {
  AccessState result = state;
  result.written = next.write;
  const bool more_readers = !next.write && !state.written;
  result.stages = more_readers ? state.stages | next.stages : next.stages;
  result.access = more_readers ? state.access | next.access : next.access;
  return result;
}

void touch(const Device& device, VkCommandBuffer commands, Buffer& buffer, const Access& next) {
  if (const std::optional<Scopes> scopes = hazard(buffer.state, next)) {
    auto barrier = vk_struct<VkBufferMemoryBarrier2>(VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2);
    barrier.srcStageMask = scopes->src_stages;
    barrier.srcAccessMask = scopes->src_access;
    barrier.dstStageMask = scopes->dst_stages;
    barrier.dstAccessMask = scopes->dst_access;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.buffer = buffer.handle();
    barrier.size = VK_WHOLE_SIZE;
    auto info = vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.bufferMemoryBarrierCount = 1;
    info.pBufferMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
  }
  buffer.state = after(buffer.state, next);
  buffer.state.last_value = device.next_value();
}

void touch(const Device& device, VkCommandBuffer commands, Image& image, const Access& next) {
  const bool changes = image.state.layout != next.layout;
  std::optional<Scopes> scopes = hazard(image.state, next);
  if (changes && !scopes) {
    // Readers before a transition have to be waited for even if the next access only reads: a
    // transition writes.
    scopes = Scopes{image.state.stages, 0, next.stages, next.access};
  }
  if (scopes) {
    auto barrier = vk_struct<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
    barrier.srcStageMask = scopes->src_stages;
    barrier.srcAccessMask = scopes->src_access;
    barrier.dstStageMask = scopes->dst_stages;
    barrier.dstAccessMask = scopes->dst_access;
    barrier.oldLayout = image.state.layout;
    barrier.newLayout = next.layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0,
                                VK_REMAINING_ARRAY_LAYERS};
    auto info = vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
  }
  image.state = changes ? AccessState{next.stages, next.access, next.layout, next.write, 0}
                        : after(image.state, next);
  image.state.last_value = device.next_value();
}

}  // namespace skerry::gpu
