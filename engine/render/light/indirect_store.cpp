#include "engine/render/light/indirect_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/scene/grow_buffer.h"
#include "shaders/shared/frame.h"

namespace skerry::render {
namespace {

static_assert(shared::kIndirectSkies == shared::kMaxIslands);
static_assert(shared::kIndirectFirst == shared::kMaxIslands * (1 + 6 * shared::kIndirectSkyTexels));

constexpr std::uint64_t kTexelBytes = sizeof(glm::uvec4);
constexpr std::uint32_t kFirstTexels = 1u << 17;          // 2 MiB
constexpr std::uint32_t kMostTexels = (48u << 20) / 16u;  // of the buffer: 48 MiB

std::uint32_t volume(glm::ivec3 size) {
  return static_cast<std::uint32_t>(size.x * size.y * size.z);
}

bool same_grid(const IslandChunks& a, const IslandChunks& b) {
  return a.low == b.low && a.size == b.size && a.voxel_size_log2 == b.voxel_size_log2;
}

bool fits(const IslandChunks& box, glm::ivec3 chunk) {
  for (int a = 0; a < 3; ++a)
    if (chunk[a] < box.low[a] || chunk[a] >= box.low[a] + box.size[a]) return false;
  return true;
}

std::uint32_t table_texel(const IslandChunks& box, std::uint32_t first, glm::ivec3 chunk) {
  const glm::ivec3 at = chunk - box.low;
  return first + static_cast<std::uint32_t>((at.y * box.size.x + at.x) * box.size.z + at.z) *
                     shared::kIndirectTableTexels;
}

glm::uvec4 header(const IslandChunks& box, std::uint32_t first) {
  const auto part = [](int value, std::uint32_t mask) {
    return static_cast<std::uint32_t>(value) & mask;
  };
  return {part(box.low.x, 1023) | part(box.low.y, 1023) << 10 | part(box.low.z, 1023) << 20,
          part(box.size.x, 255) | part(box.size.y, 255) << 8 | part(box.size.z, 255) << 16 |
              box.voxel_size_log2 << 24,
          first, 1u};
}

}  // namespace

IndirectStore::IndirectStore(gpu::Device& device, MemoryBudget& budget)
    : device_(&device), budget_(&budget), arena_(kFirstTexels) {}

IndirectStore::~IndirectStore() {
  budget_->give_back(texels_.size_bytes());
}

Result<std::unique_ptr<IndirectStore>> IndirectStore::create(gpu::Device& device,
                                                             MemoryBudget& budget) {
  std::unique_ptr<IndirectStore> store(new IndirectStore(device, budget));
  Result<gpu::Buffer> made =
      make_table(device, budget, "light of the sky",
                 (shared::kIndirectFirst + kFirstTexels) * kTexelBytes, true);
  if (!made) return made.error();
  store->texels_ = *std::move(made);
  device.run_now([&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, store->texels_.handle(), 0, VK_WHOLE_SIZE, 0);
  });
  return store;
}

Result<gpu::ArenaRange> IndirectStore::allocate(std::uint32_t texels) {
  if (texels == 0) return gpu::ArenaRange{};
  if (Result<gpu::ArenaRange> range = arena_.allocate(texels); range) return range;
  const std::uint64_t now = arena_.capacity();
  // Twice as much, or what the budget affords.
  const std::uint64_t affordable = now + budget_->left() / kTexelBytes;
  const std::uint64_t next = std::min<std::uint64_t>(
      kMostTexels - shared::kIndirectFirst, std::max(std::min(now * 2, affordable), now + texels));
  if (next < now + texels)
    return Error{
        fmt::format("the light of the sky needs {} bytes more, {} are in use and {} are "
                    "allowed; lower view.distance or view.detail, or set indirect=off",
                    texels * kTexelBytes, bytes_in_use(), kMostTexels * kTexelBytes)};
  if (Result<void> grew =
          grow_buffer(*device_, *budget_, texels_, (shared::kIndirectFirst + next) * kTexelBytes);
      !grew)
    return grew.error();
  arena_.grow(static_cast<std::uint32_t>(next));
  return arena_.allocate(texels);
}

void IndirectStore::free(gpu::ArenaRange range) {
  if (range.count != 0) arena_.free(range, device_->next_value());
}

void IndirectStore::write(gpu::Uploader& uploader, std::uint32_t texel,
                          std::span<const glm::uvec4> values) {
  if (!values.empty()) uploader.write(texels_, texel * kTexelBytes, values);
}

/// Writes chunks and their tables. @param all also those that have not changed.
Result<void> IndirectStore::put_chunks(gpu::Uploader& uploader, Island& island,
                                       std::span<const ChunkSkyLight> chunks, bool all) {
  std::vector<glm::uvec4> texels, table(shared::kIndirectTableTexels);
  for (const ChunkSkyLight& chunk : chunks) {
    if (!fits(island.box, chunk.chunk)) continue;
    const Key key{chunk.chunk.x, chunk.chunk.y, chunk.chunk.z};
    if (!all && !chunk.changed && island.chunks.contains(key)) continue;
    SKERRY_ASSERT(chunk.table.size() == shared::kIndirectTableTexels * 4);
    const Result<gpu::ArenaRange> range = allocate(static_cast<std::uint32_t>(chunk.texels.size()));
    if (!range) return range.error();
    if (const auto old = island.chunks.find(key); old != island.chunks.end()) free(old->second);
    island.chunks[key] = *range;
    const std::uint32_t first = shared::kIndirectFirst + range->first;
    texels.assign(chunk.texels.begin(), chunk.texels.end());
    std::uint32_t bricks = 0;
    for (std::size_t i = 0; i < chunk.table.size(); ++i) {
      const std::uint32_t brick = chunk.table[i];
      bricks = std::max(bricks, brick);
      table[i / 4][static_cast<int>(i % 4)] =
          brick == 0 ? 0 : first + (brick - 1) * shared::kIndirectBrickTexels;
    }
    SKERRY_ASSERT(std::size_t{bricks} * shared::kIndirectBrickTexels <= texels.size());
    for (std::size_t i = 0; i < bricks * shared::kIndirectBrickTexels; ++i)
      texels[i].z += first, texels[i].w += first;
    write(uploader, first, texels);
    write(uploader,
          table_texel(island.box, shared::kIndirectFirst + island.tables.first, chunk.chunk),
          table);
  }
  return {};
}

Result<void> IndirectStore::set_island(gpu::Uploader& uploader, std::uint32_t island,
                                       const IslandChunks& box,
                                       std::span<const ChunkSkyLight> chunks) {
  SKERRY_ASSERT(island < shared::kMaxIslands);
  if (const auto found = islands_.find(island);
      found != islands_.end() && same_grid(found->second.box, box)) {
    Island& kept = found->second;
    const std::vector<glm::uvec4> empty(shared::kIndirectTableTexels, glm::uvec4(0));
    std::erase_if(kept.chunks, [&](const auto& entry) {
      const glm::ivec3 at{entry.first[0], entry.first[1], entry.first[2]};
      if (std::ranges::any_of(chunks, [&](const ChunkSkyLight& c) { return c.chunk == at; }))
        return false;
      free(entry.second);
      write(uploader, table_texel(box, shared::kIndirectFirst + kept.tables.first, at), empty);
      return true;
    });
    return put_chunks(uploader, kept, chunks, false);
  }
  Island made{box, {}, {}};
  const Result<gpu::ArenaRange> tables = allocate(volume(box.size) * shared::kIndirectTableTexels);
  if (!tables) return tables.error();
  made.tables = *tables;
  const std::uint32_t first = shared::kIndirectFirst + tables->first;
  uploader.fill(texels_, first * kTexelBytes, tables->count * kTexelBytes, 0);
  if (Result<void> put = put_chunks(uploader, made, chunks, true); !put) {
    free(made.tables);
    for (const auto& [key, range] : made.chunks) free(range);
    end_island(uploader, island);
    return put;
  }
  const glm::uvec4 written = header(box, first);
  write(uploader, island, std::span<const glm::uvec4>(&written, 1));
  if (const auto old = islands_.find(island); old != islands_.end()) {
    free(old->second.tables);
    for (const auto& [key, range] : old->second.chunks) free(range);
  }
  islands_[island] = std::move(made);
  return {};
}

void IndirectStore::end_island(gpu::Uploader& uploader, std::uint32_t island) {
  const auto found = islands_.find(island);
  if (found == islands_.end()) return;
  const glm::uvec4 nowhere(0);
  write(uploader, island, std::span<const glm::uvec4>(&nowhere, 1));
  free(found->second.tables);
  for (const auto& [key, range] : found->second.chunks) free(range);
  islands_.erase(found);
}

void IndirectStore::set_sky(gpu::Uploader& uploader, std::span<const glm::uvec4> irradiance) {
  write(uploader, shared::kIndirectSkies, irradiance);
}

void IndirectStore::collect() {
  arena_.collect(device_->completed_value());
}

}  // namespace skerry::render
