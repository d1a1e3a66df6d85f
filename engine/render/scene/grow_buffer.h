#pragma once
#include <cstdint>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"

namespace skerry::gpu {
class Device;
}

namespace skerry::render {

/// Tables that stay on the GPU between frames.
inline constexpr VkBufferUsageFlags kTableUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                  VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                                  VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

/// Puts a bigger buffer with the old one's bytes in its place. Waits for the GPU: growth is rare,
/// and doubles.
Result<void> grow_buffer(gpu::Device& device, gpu::Buffer& buffer, std::uint64_t size_bytes);

}  // namespace skerry::render
