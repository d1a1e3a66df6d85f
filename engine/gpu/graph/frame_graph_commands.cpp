// What a pass may record, checked against what it declared and what its shaders want.
#include <algorithm>

#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/vk_struct.h"
#include "engine/gpu/graph/frame_graph_state.h"

namespace skerry::gpu {

Commands::Commands(FrameGraph& graph, std::uint32_t pass, VkCommandBuffer commands)
    : graph_(graph), pass_(pass), commands_(commands) {}

// Fatal unless the pass declared this version of the resource, as read or written, with all of
// `access`.
void Commands::require(std::uint32_t id, std::uint32_t version, VkAccessFlags2 access) const {
  const FrameGraph::State& state = *graph_.state_;
  const auto& pass = state.passes[pass_];
  VkAccessFlags2 declared = 0;
  bool known = false;
  for (const auto& use : pass.declared) {
    if (use.resource != id || (use.version_in != version && use.version_out != version)) continue;
    known = true;
    declared |= use_info(use.use).access;
  }
  if (id >= state.resources.size())
    state.fail(pass, "records with an empty reference, or one of another frame");
  if (!known) state.fail(pass, id, "it did not declare");
  if ((access & ~declared) != 0) state.fail(pass, id, "it declared for another use");
}

FrameCounts& Commands::counted() const {
  return graph_.state_->recorded;
}

VkImageLayout Commands::layout_of(ImageRef ref) const {
  const auto& merged = graph_.state_->passes[pass_].merged;
  const auto found = std::find_if(merged.begin(), merged.end(),
                                  [&](const auto& m) { return m.resource == ref.id; });
  return found->access.layout;
}

const Image& Commands::image(ImageRef ref) const {
  require(ref.id, ref.version, 0);
  return *graph_.state_->resources[ref.id].image;
}

const Buffer& Commands::buffer(BufferRef ref) const {
  require(ref.id, ref.version, 0);
  return *graph_.state_->resources[ref.id].buffer;
}

void Commands::fail(const std::string& text) const {
  const FrameGraph::State& state = *graph_.state_;
  state.fail(
      state.passes[pass_],
      (pipeline_ ? "with the shader '" + pipeline_->name + "' " : "without a pipeline ") + text);
}

void Commands::bind(const Pipeline& pipeline) {
  pipeline_ = &pipeline;
  bound_.assign(pipeline.bindings.size(), {});
  dirty_ = true;
  pushed_ = false;
  vkCmdBindPipeline(commands_, pipeline.bind_point, pipeline.made().handle);
}

Commands::Bound& Commands::slot(std::uint32_t binding) {
  if (!pipeline_) fail("sets the binding " + std::to_string(binding));
  for (std::size_t i = 0; i < bound_.size(); ++i) {
    if (pipeline_->bindings[i].binding != binding) continue;
    bound_[i].set = true;
    bound_[i].type = pipeline_->bindings[i].type;
    dirty_ = true;
    return bound_[i];
  }
  fail("sets the binding " + std::to_string(binding) + ", which the shader does not have");
}

void Commands::storage(std::uint32_t binding, BufferRef ref) {
  require(ref.id, ref.version, VK_ACCESS_2_SHADER_READ_BIT);
  Bound& bound = slot(binding);
  if (bound.type != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER &&
      bound.type != VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) {
    fail("gives a buffer to the binding " + std::to_string(binding));
  }
  bound.buffer = {buffer(ref).handle(), 0, VK_WHOLE_SIZE};
}

void Commands::texels(std::uint32_t binding, BufferRef ref) {
  require(ref.id, ref.version, VK_ACCESS_2_SHADER_READ_BIT);
  Bound& bound = slot(binding);
  bound.texels = buffer(ref).texels();
  if (bound.type != VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER || !bound.texels)
    fail("gives texels of a buffer to the binding " + std::to_string(binding));
}

void Commands::storage(std::uint32_t binding, ImageRef ref, std::uint32_t mip,
                       std::uint32_t layer) {
  require(ref.id, ref.version, VK_ACCESS_2_SHADER_READ_BIT);
  Bound& bound = slot(binding);
  if (bound.type != VK_DESCRIPTOR_TYPE_STORAGE_IMAGE)
    fail("gives a storage image to the binding " + std::to_string(binding));
  const VkImageView view = layer == kAllLayers ? image(ref).view() : image(ref).view_of(mip, layer);
  bound.image = {VK_NULL_HANDLE, view, layout_of(ref)};
}

void Commands::sampled(std::uint32_t binding, ImageRef ref, VkSampler sampler) {
  require(ref.id, ref.version, VK_ACCESS_2_SHADER_READ_BIT);
  Bound& bound = slot(binding);
  if (bound.type != VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER &&
      bound.type != VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE) {
    fail("gives a texture to the binding " + std::to_string(binding));
  }
  bound.image = {sampler, image(ref).view(), layout_of(ref)};
}

void Commands::push_bytes(const void* data, std::size_t size) {
  if (!pipeline_ || size != pipeline_->push_bytes) {
    fail("pushes " + std::to_string(size) + " bytes of constants, but the shader has " +
         std::to_string(pipeline_ ? pipeline_->push_bytes : 0));
  }
  vkCmdPushConstants(commands_, pipeline_->layout, pipeline_->push_stages, 0, pipeline_->push_bytes,
                     data);
  pushed_ = true;
}

void Commands::flush_bindings() {
  if (!pipeline_) fail("draws or dispatches");
  if (pipeline_->push_bytes > 0 && !pushed_) fail("draws or dispatches before push()");
  if (!dirty_) return;
  std::array<VkWriteDescriptorSet, 32> writes;  // every device takes that many (Roadmap 2022)
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < bound_.size(); ++i) {
    const Pipeline::Binding& wanted = pipeline_->bindings[i];
    const Bound& bound = bound_[i];
    if (!bound.set) {
      fail("draws or dispatches without the binding " + std::to_string(wanted.binding));
    }
    auto& write = writes[count++] =
        vk_struct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstBinding = wanted.binding;
    write.descriptorCount = 1;
    write.descriptorType = wanted.type;
    write.pBufferInfo = &bound.buffer;
    write.pImageInfo = &bound.image;
    write.pTexelBufferView = &bound.texels;
  }
  counted().descriptor_writes += count;
  if (count > 0)
    vkCmdPushDescriptorSetKHR(commands_, pipeline_->bind_point, pipeline_->layout, 0, count,
                              writes.data());
  dirty_ = false;
}

void Commands::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  flush_bindings();
  ++counted().dispatches;
  vkCmdDispatch(commands_, x, y, z);
}

void Commands::dispatch_indirect(BufferRef arguments, std::uint64_t offset_bytes) {
  require(arguments.id, arguments.version, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
  flush_bindings();
  ++counted().dispatches;
  vkCmdDispatchIndirect(commands_, buffer(arguments).handle(), offset_bytes);
}

void Commands::index_buffer(BufferRef ref, VkIndexType type) {
  require(ref.id, ref.version, VK_ACCESS_2_INDEX_READ_BIT);
  vkCmdBindIndexBuffer(commands_, buffer(ref).handle(), 0, type);
}

void Commands::draw(std::uint32_t vertices, std::uint32_t instances) {
  flush_bindings();
  ++counted().draws;
  vkCmdDraw(commands_, vertices, instances, 0, 0);
}

void Commands::draw_indirect_count(BufferRef commands, std::uint64_t offset_bytes, BufferRef count,
                                   std::uint64_t count_offset_bytes, std::uint32_t max_draws) {
  require(commands.id, commands.version, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
  require(count.id, count.version, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
  flush_bindings();
  ++counted().draws;
  vkCmdDrawIndexedIndirectCount(commands_, buffer(commands).handle(), offset_bytes,
                                buffer(count).handle(), count_offset_bytes, max_draws,
                                sizeof(VkDrawIndexedIndirectCommand));
}

void Commands::fill(BufferRef ref, std::uint64_t offset, std::uint64_t size, std::uint32_t value) {
  require(ref.id, ref.version, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  ++counted().copies;
  vkCmdFillBuffer(commands_, buffer(ref).handle(), offset, size, value);
}

void Commands::copy(BufferRef from, BufferRef to, std::uint64_t from_offset,
                    std::uint64_t to_offset, std::uint64_t size) {
  require(from.id, from.version, VK_ACCESS_2_TRANSFER_READ_BIT);
  require(to.id, to.version, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  const VkBufferCopy region{from_offset, to_offset, size};
  ++counted().copies;
  vkCmdCopyBuffer(commands_, buffer(from).handle(), buffer(to).handle(), 1, &region);
}

void Commands::copy(ImageRef from, BufferRef to) {
  require(from.id, from.version, VK_ACCESS_2_TRANSFER_READ_BIT);
  require(to.id, to.version, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  const Image& source = image(from);
  VkBufferImageCopy region{};
  region.imageSubresource = {source.aspect(), 0, 0, source.desc().layers};
  region.imageExtent = {source.desc().extent.width, source.desc().extent.height, 1};
  ++counted().copies;
  vkCmdCopyImageToBuffer(commands_, source.handle(), layout_of(from), buffer(to).handle(), 1,
                         &region);
}

void Commands::copy_texel(BufferRef from, ImageRef to, VkOffset2D at) {
  require(from.id, from.version, VK_ACCESS_2_TRANSFER_READ_BIT);
  require(to.id, to.version, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  const Image& target = image(to);
  VkBufferImageCopy region{};
  region.imageSubresource = {target.aspect(), 0, 0, 1};
  region.imageOffset = {at.x, at.y, 0};
  region.imageExtent = {1, 1, 1};
  ++counted().copies;
  vkCmdCopyBufferToImage(commands_, buffer(from).handle(), target.handle(), layout_of(to), 1,
                         &region);
}

void Commands::clear(ImageRef ref, VkClearColorValue value) {
  require(ref.id, ref.version, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  const Image& target = image(ref);
  const VkImageSubresourceRange all{target.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0,
                                    VK_REMAINING_ARRAY_LAYERS};
  ++counted().copies;
  vkCmdClearColorImage(commands_, target.handle(), layout_of(ref), &value, 1, &all);
}

}  // namespace skerry::gpu
