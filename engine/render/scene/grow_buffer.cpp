#include "engine/render/scene/grow_buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/uploader.h"

namespace skerry::render {

Result<gpu::Buffer> make_table(gpu::Device& device, MemoryBudget& budget, const char* name,
                               std::uint64_t size_bytes, bool texels) {
  if (!budget.take(size_bytes))
    return Error{
        fmt::format("'{}' needs {} bytes and the world's memory budget has {} left; raise "
                    "memory.budget or lower view.distance",
                    name, size_bytes, budget.left())};
  Result<gpu::Buffer> made = device.create_buffer(
      {name, size_bytes, texels ? kTexelTableUsage : kTableUsage, gpu::Memory::kDevice, texels});
  if (!made) budget.give_back(size_bytes);
  return made;
}

Result<void> grow_buffer(gpu::Device& device, MemoryBudget& budget, gpu::Uploader& uploader,
                         gpu::Buffer& buffer, std::uint64_t size_bytes) {
  const std::uint64_t old_bytes = buffer.size_bytes();
  budget.give_back(old_bytes);
  Result<gpu::Buffer> bigger = make_table(device, budget, buffer.name().c_str(), size_bytes,
                                          buffer.texels() != VK_NULL_HANDLE);
  if (!bigger) {
    budget.take(old_bytes);
    return bigger.error();
  }
  uploader.replace(buffer, *std::move(bigger));
  return {};
}

Result<gpu::ArenaRange> allocate(gpu::Device& device, MemoryBudget& budget, gpu::Uploader& uploader,
                                 const ArenaTable& table, std::uint32_t count) {
  if (Result<gpu::ArenaRange> range = table.arena.allocate(count); range) return range;
  const std::uint64_t most =
      std::min(device.limits().max_storage_range / table.element_bytes, table.format_limit);
  const std::uint64_t now = table.arena.capacity();
  const std::uint64_t affordable = now + budget.left() / table.element_bytes;
  const std::uint64_t next = std::min({most, affordable, std::max(now * 2, now + count)});
  if (next < now + count)
    return Error{fmt::format(
        "'{}' is full: {} more of {} bytes each are needed, {} are in use, the "
        "device allows {} and memory.budget {}; lower view.distance or "
        "view.detail",
        table.buffer.name(), count, table.element_bytes, table.arena.used(), most, affordable)};
  if (Result<void> grew =
          grow_buffer(device, budget, uploader, table.buffer, next * table.element_bytes);
      !grew)
    return grew.error();
  table.arena.grow(static_cast<std::uint32_t>(next));
  return table.arena.allocate(count);
}

}  // namespace skerry::render
