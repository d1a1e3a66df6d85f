#pragma once
#include <volk.h>

#include <cstdint>
#include <optional>

#include "engine/gpu/device/resources.h"

namespace skerry::gpu {

class Device;

/// How a pass touches a resource; decides stage, access mask and layout.
enum class Use : std::uint8_t {
  kIndirect,        ///< buffer: indirect commands and counts
  kIndex,           ///< buffer: index data
  kVertexRead,      ///< storage buffer read in a vertex shader
  kFragmentRead,    ///< storage buffer or sampled image read in a fragment shader
  kComputeRead,     ///< storage buffer or storage image read in a compute shader
  kComputeSampled,  ///< image sampled in a compute shader
  kComputeWrite,    ///< storage buffer or image written (or read and written) in a compute shader
  kColor,           ///< colour attachment
  kDepth,           ///< depth attachment, tested and written
  kTransferRead,
  kTransferWrite,
  kHostRead,  ///< buffer read by the CPU after the frame
};

/// What a Use means to Vulkan.
struct UseInfo {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< undefined: not a use of images
  VkImageUsageFlags image_usage = 0;
  VkBufferUsageFlags buffer_usage = 0;
  bool buffer = true;
  bool write = false;
};

UseInfo use_info(Use use);

/// All access bits that write.
inline constexpr VkAccessFlags2 kWriteAccess =
    VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
    VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

/// One access of a pass to a resource or to one of its layers: all its uses in that pass together.
struct Access {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  bool write = false;
};

/// Synchronisation scopes of a barrier.
struct Scopes {
  VkPipelineStageFlags2 src_stages = 0;
  VkAccessFlags2 src_access = 0;
  VkPipelineStageFlags2 dst_stages = 0;
  VkAccessFlags2 dst_access = 0;
};

/// What the accesses in `state` oblige `next` to wait for, if anything, in an unchanged layout:
/// read after write and write after write wait for the write to become visible; write after read
/// waits for execution only; a read after reads that its stage has seen waits for nothing; in
/// another stage it chains to them, as they saw the write.
std::optional<Scopes> hazard(const AccessState& state, const Access& next);

/// The state after `next`, keeping the layout and submit value.
AccessState after(const AccessState& state, const Access& next);

/// For commands outside a frame graph: records the barrier that `next` needs, if any, and updates
/// the resource's state for the submit being recorded. An image changes to next.layout as a whole.
void touch(const Device& device, VkCommandBuffer commands, Buffer& buffer, const Access& next);
void touch(const Device& device, VkCommandBuffer commands, Image& image, const Access& next);

}  // namespace skerry::gpu
