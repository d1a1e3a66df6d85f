// Recording: barriers, dynamic rendering, labels and timers around each pass's own commands.
#include <algorithm>
#include <array>

#include "engine/core/check.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/vk_struct.h"
#include "engine/gpu/graph/frame_graph_state.h"

namespace skerry::gpu {
namespace {

constexpr std::uint32_t kTimerGranule =
    32;  // query pools grow in steps, so that one more pass does not make a new pool

void begin_label(VkCommandBuffer commands, const std::string& name) {
  if (!vkCmdBeginDebugUtilsLabelEXT) return;
  auto label = vk_struct<VkDebugUtilsLabelEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT);
  label.pLabelName = name.c_str();
  vkCmdBeginDebugUtilsLabelEXT(commands, &label);
}

void end_label(VkCommandBuffer commands) {
  if (vkCmdEndDebugUtilsLabelEXT) vkCmdEndDebugUtilsLabelEXT(commands);
}

}  // namespace

void FrameGraph::execute(VkCommandBuffer commands, std::uint32_t frame_slot,
                         const std::function<void()>& before_pass) {
  SKERRY_ASSERT(state_->compiled);
  // The uploader may have touched imported resources since compile(): plan with what is true now.
  state_->plan();
  State& state = *state_;
  const bool real = state.device != nullptr;
  if (real) state.prepare_timers(commands, frame_slot);
  const VkQueryPool pool = real ? state.timers[frame_slot].pool : VK_NULL_HANDLE;
  const auto stamp = [&](std::uint32_t query) {
    if (pool) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool, query);
  };
  stamp(0);
  std::uint32_t done = 0;
  for (std::uint32_t i = 0; i < state.passes.size(); ++i) {
    State::Pass& pass = state.passes[i];
    if (!pass.alive) continue;
    if (before_pass) before_pass();
    if (real) begin_label(commands, pass.name);
    state.record_barriers(commands, pass.before);
    const bool rendering = real && state.begin_rendering(commands, pass, i);
    Commands recorder(*this, i, commands);
    if (pass.record) pass.record(recorder);
    if (rendering) vkCmdEndRendering(commands);
    state.record_barriers(commands, pass.behind);
    if (real) end_label(commands);
    if (state.time_passes) stamp(++done);
  }
  if (!state.time_passes) stamp(++done);
  state.carry_states();
}

void FrameGraph::State::record_barriers(VkCommandBuffer commands,
                                        const std::vector<Barrier>& barriers) const {
  if (!device || barriers.empty()) return;
  std::vector<VkImageMemoryBarrier2> images;
  std::vector<VkBufferMemoryBarrier2> buffers;
  for (const Barrier& barrier : barriers) {
    const Resource& resource = resources[barrier.resource];
    const auto fill = [&](auto& out) {
      out.srcStageMask = barrier.scopes.src_stages;
      out.srcAccessMask = barrier.scopes.src_access;
      out.dstStageMask = barrier.scopes.dst_stages;
      out.dstAccessMask = barrier.scopes.dst_access;
      out.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    };
    if (resource.is_image) {
      auto& out = images.emplace_back(
          vk_struct<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2));
      fill(out);
      out.oldLayout = barrier.old_layout;
      out.newLayout = barrier.new_layout;
      out.image = resource.image->handle();
      out.subresourceRange = {resource.image->aspect(), 0, VK_REMAINING_MIP_LEVELS,
                              barrier.first_layer, barrier.layer_count};
    } else {
      auto& out = buffers.emplace_back(
          vk_struct<VkBufferMemoryBarrier2>(VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2));
      fill(out);
      out.buffer = resource.buffer->handle();
      out.size = VK_WHOLE_SIZE;
    }
  }
  auto info = vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  info.bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffers.size());
  info.pBufferMemoryBarriers = buffers.data();
  info.imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size());
  info.pImageMemoryBarriers = images.data();
  vkCmdPipelineBarrier2(commands, &info);
}

bool FrameGraph::State::begin_rendering(VkCommandBuffer commands, const Pass& pass,
                                        std::uint32_t index) {
  std::vector<VkRenderingAttachmentInfo> colors;
  auto depth = vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  VkExtent2D extent{};
  for (const Declared& use : pass.declared) {
    if (!use.attachment) continue;
    const Resource& resource = resources[use.resource];
    auto attachment =
        vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    attachment.imageView = resource.image->view_of(0, use.layer);
    attachment.imageLayout = use_info(use.use).layout;
    attachment.loadOp = use.load.op;
    const bool wanted_later = resource.imported || resource.last_pass > index;
    attachment.storeOp =
        wanted_later ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.clearValue = use.load.value;
    extent = resource.image_desc.extent;
    if (use.use == Use::kDepth) {
      depth = attachment;
    } else {
      colors.push_back(attachment);
    }
  }
  if (colors.empty() && !depth.imageView) return false;
  auto info = vk_struct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  info.renderArea = pass.area.value_or(VkRect2D{{0, 0}, extent});
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  info.pDepthAttachment = depth.imageView ? &depth : nullptr;
  vkCmdBeginRendering(commands, &info);
  ++recorded.render_passes;
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height), 0.0f, 1.0f};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
  return true;
}

// Timestamps stand between passes: one more than passes. A pass's time is what passes until
// everything up to its end is done, so the times add up to the frame's and none counts twice where
// passes overlap.
void FrameGraph::State::prepare_timers(VkCommandBuffer commands, std::uint32_t slot) {
  Timers& slot_timers = timers[slot];
  slot_timers.names.clear();
  if (!time_passes) slot_timers.names.emplace_back("frame");
  for (const Pass& pass : passes) {
    if (pass.alive && time_passes) slot_timers.names.push_back(pass.name);
  }
  const auto wanted = static_cast<std::uint32_t>(slot_timers.names.size() + 1);
  if (device->limits().timestamp_period_ns <= 0.0f) return;  // this queue cannot measure
  if (slot_timers.capacity < wanted) {
    if (slot_timers.pool) {
      device->retire(reinterpret_cast<std::uint64_t>(slot_timers.pool), VK_OBJECT_TYPE_QUERY_POOL,
                     VK_NULL_HANDLE, 0, {});
    }
    slot_timers.capacity = (wanted + kTimerGranule - 1) / kTimerGranule * kTimerGranule;
    auto info = vk_struct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = slot_timers.capacity;
    GPU_CHECK(vkCreateQueryPool(device->handle(), &info, nullptr, &slot_timers.pool));
    device->set_name(reinterpret_cast<std::uint64_t>(slot_timers.pool), VK_OBJECT_TYPE_QUERY_POOL,
                     "pass timers");
  }
  vkCmdResetQueryPool(commands, slot_timers.pool, 0, wanted);
}

void FrameGraph::time_passes(bool each) {
  state_->time_passes = each;
}

std::vector<PassTime> FrameGraph::times(std::uint32_t frame_slot) {
  const auto found = state_->timers.find(frame_slot);
  if (found == state_->timers.end() || !found->second.pool) return {};
  const State::Timers& timers = found->second;
  std::vector<std::uint64_t> ticks(timers.names.size() + 1);
  const VkResult result = vkGetQueryPoolResults(
      state_->device->handle(), timers.pool, 0, static_cast<std::uint32_t>(ticks.size()),
      ticks.size() * sizeof ticks[0], ticks.data(), sizeof ticks[0], VK_QUERY_RESULT_64_BIT);
  if (result == VK_NOT_READY) return {};
  GPU_CHECK(result);
  std::vector<PassTime> times;
  for (std::size_t i = 0; i < timers.names.size(); ++i) {
    const auto elapsed = static_cast<double>(std::max(ticks[i + 1], ticks[i]) - ticks[i]);
    times.push_back(
        {timers.names[i], elapsed * state_->device->limits().timestamp_period_ns * 1e-6});
  }
  return times;
}

}  // namespace skerry::gpu
