#pragma once
#include <cstdint>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/offset_arena.h"
#include "engine/render/scene/memory_budget.h"

namespace skerry::gpu {
class Device;
class Uploader;
}  // namespace skerry::gpu

namespace skerry::render {

/// Tables that stay on the GPU between frames.
inline constexpr VkBufferUsageFlags kTableUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                  VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                                  VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
/// Same, for shaders that fetch texels.
inline constexpr VkBufferUsageFlags kTexelTableUsage =
    kTableUsage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;

/// A table, taken from the budget. @param texels shaders fetch texels of it. Errors: more than is
/// left; out of memory.
Result<gpu::Buffer> make_table(gpu::Device& device, MemoryBudget& budget, const char* name,
                               std::uint64_t size_bytes, bool texels = false);

/// Puts a bigger buffer in a table's place; the GPU copies its bytes ahead of what the uploader
/// sends next, and nothing waits for it. Errors, with nothing changed: as make_table.
Result<void> grow_buffer(gpu::Device& device, MemoryBudget& budget, gpu::Uploader& uploader,
                         gpu::Buffer& buffer, std::uint64_t size_bytes);

/// A table whose elements an arena hands out.
struct ArenaTable {
  gpu::OffsetArena& arena;
  gpu::Buffer& buffer;
  std::uint64_t element_bytes;
  std::uint64_t format_limit;  ///< elements that indices can name
};

/// Makes room for `count` more elements; the buffer doubles if need be, or takes what the budget
/// has left. Errors: what is needed, what is in use, what to lower.
Result<gpu::ArenaRange> allocate(gpu::Device& device, MemoryBudget& budget, gpu::Uploader& uploader,
                                 const ArenaTable& table, std::uint32_t count);

}  // namespace skerry::render
