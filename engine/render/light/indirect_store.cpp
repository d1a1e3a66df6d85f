#include "engine/render/light/indirect_store.h"

#include <algorithm>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/scene/grow_buffer.h"
#include "shaders/shared/frame.h"

namespace skerry::render {
namespace {

static_assert(shared::kIndirectOpenRecord == shared::kMaxIslands);
static_assert(shared::kIndirectFirst ==
              shared::kIndirectOpenRecord + shared::kIndirectRecordTexels);

constexpr std::uint64_t kTexelBytes = sizeof(glm::uvec4);
// 56 MiB: of six seeds five take less than 32, at 1,000 blocks and at 16 km, and one at 16 km more;
// what replaces a grid is made beside it.
constexpr std::uint32_t kUsualTexels = (56u << 20) / kTexelBytes;
constexpr std::uint32_t kLeastTexels = shared::kIndirectFirst + (1u << 14);
constexpr std::uint64_t kShareOfBudget = 2;  // most of it that light takes

std::uint64_t most_texels(const gpu::Device& device, const MemoryBudget& budget) {
  return std::min(device.limits().max_texels, budget.limit() / kShareOfBudget / kTexelBytes);
}

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
          first, shared::kIndirectFaces};
}

}  // namespace

IndirectStore::IndirectStore(gpu::Device& device, MemoryBudget& budget, std::uint32_t texels)
    : device_(&device), budget_(&budget), arena_(texels) {}

IndirectStore::~IndirectStore() {
  budget_->give_back(texels_.size_bytes());
}

Result<std::unique_ptr<IndirectStore>> IndirectStore::create(gpu::Device& device,
                                                             MemoryBudget& budget) {
  const std::uint32_t texels = budget.first_elements(kTexelBytes, kLeastTexels, kUsualTexels);
  std::unique_ptr<IndirectStore> store(new IndirectStore(device, budget, texels));
  Result<gpu::Buffer> made =
      make_table(device, budget, "light of the sky", texels * kTexelBytes, true);
  if (!made) return made.error();
  store->texels_ = *std::move(made);
  const Result<gpu::ArenaRange> head = store->arena_.allocate(shared::kIndirectFirst);
  SKERRY_ASSERT(head && head->first == 0);
  device.run_now([&](VkCommandBuffer commands) {
    const auto fill = [&](std::uint64_t first, std::uint64_t end, std::uint32_t word) {
      vkCmdFillBuffer(commands, store->texels_.handle(), bytes_of(first), bytes_of(end - first),
                      word);
    };
    // Corners that see everything, and no light of lamps or of other faces.
    constexpr std::uint64_t kOpen = shared::kIndirectOpenRecord;
    fill(0, kOpen, 0);
    fill(kOpen, kOpen + 2, 0xffffffffu);
    fill(kOpen + 2, head->count, 0);
  });
  return store;
}

Result<gpu::ArenaRange> IndirectStore::allocate(gpu::Uploader& uploader, std::uint32_t texels) {
  if (texels == 0) return gpu::ArenaRange{};
  return render::allocate(*device_, *budget_, uploader,
                          {arena_, texels_, kTexelBytes, most_texels(*device_, *budget_)}, texels);
}

void IndirectStore::free(gpu::ArenaRange range) {
  if (range.count != 0) arena_.free(range, device_->next_value());
}

void IndirectStore::free(std::optional<Grid>& grid) {
  if (!grid) return;
  free(grid->tables);
  for (const auto& [key, chunk] : grid->chunks) free(chunk.range);
  grid.reset();
}

std::uint64_t IndirectStore::bytes_left() const {
  const std::uint64_t affordable = arena_.capacity() + budget_->left() / kTexelBytes;
  const std::uint64_t most = std::min(most_texels(*device_, *budget_), affordable);
  const std::uint64_t taken = std::uint64_t{arena_.used()} + arena_.waiting();
  return bytes_of(most - std::min(most, taken));
}

std::uint64_t IndirectStore::bytes_for(const IslandChunks& box,
                                       std::span<const ChunkSkyLight> chunks) {
  std::uint64_t texels = volume(box.size) * std::uint64_t{shared::kIndirectTableTexels};
  for (const ChunkSkyLight& chunk : chunks) texels += chunk.texels.size();
  return bytes_of(texels);
}

void IndirectStore::write(gpu::Uploader& uploader, std::uint32_t texel,
                          std::span<const glm::uvec4> values) {
  if (!values.empty()) uploader.write(texels_, texel * kTexelBytes, values);
}

Result<void> IndirectStore::begin(gpu::Uploader& uploader, std::uint32_t island,
                                  const IslandChunks& box) {
  SKERRY_ASSERT(island < shared::kMaxIslands);
  Island& entry = islands_[island];
  if (entry.shown && same_grid(entry.shown->box, box)) {
    free(entry.made);
  } else if (!entry.made || !same_grid(entry.made->box, box)) {
    free(entry.made);
    const Result<gpu::ArenaRange> tables =
        allocate(uploader, volume(box.size) * shared::kIndirectTableTexels);
    if (!tables) return tables.error();
    uploader.fill(texels_, tables->first * kTexelBytes, tables->count * kTexelBytes, 0);
    entry.made = Grid{box, *tables, {}};
  }
  for (auto& [key, chunk] : entry.target().chunks) chunk.put = false;
  return {};
}

Result<void> IndirectStore::put(gpu::Uploader& uploader, std::uint32_t island,
                                const ChunkSkyLight& chunk) {
  Grid& grid = islands_.at(island).target();
  SKERRY_ASSERT(fits(grid.box, chunk.chunk));
  SKERRY_ASSERT(chunk.table.size() == shared::kIndirectTableTexels * 4);
  const Key key{chunk.chunk.x, chunk.chunk.y, chunk.chunk.z};
  const auto old = grid.chunks.find(key);
  if (old != grid.chunks.end()) {
    old->second.put = true;
    if (!chunk.changed) return {};
  }
  const Result<gpu::ArenaRange> range =
      allocate(uploader, static_cast<std::uint32_t>(chunk.texels.size()));
  if (!range) return range.error();
  if (old != grid.chunks.end()) free(old->second.range);
  grid.chunks[key] = {*range};
  const std::span texels =
      uploader.place<glm::uvec4>(texels_, range->first * kTexelBytes, chunk.texels.size());
  std::ranges::copy(chunk.texels, texels.begin());
  const std::span table = uploader.place<glm::uvec4>(
      texels_, table_texel(grid.box, grid.tables.first, chunk.chunk) * kTexelBytes,
      shared::kIndirectTableTexels);
  std::uint32_t bricks = 0;
  for (std::size_t i = 0; i < chunk.table.size(); ++i) {
    const std::uint32_t brick = chunk.table[i];
    bricks = std::max(bricks, brick);
    table[i / 4][static_cast<int>(i % 4)] =
        brick == 0 ? 0
                   : (range->first + (brick - 1) * shared::kIndirectBrickTexels) |
                         (chunk.tinted ? shared::kIndirectTinted : 0u) |
                         (chunk.keyed ? shared::kIndirectKeyed : 0u);
  }
  SKERRY_ASSERT(std::size_t{bricks} * shared::kIndirectBrickTexels <= texels.size());
  for (std::size_t i = 0; i < bricks * shared::kIndirectBrickTexels; ++i)
    texels[i].z += range->first, texels[i].w += range->first;
  return {};
}

void IndirectStore::finish(gpu::Uploader& uploader, std::uint32_t island) {
  Island& entry = islands_.at(island);
  Grid& grid = entry.target();
  const std::vector<glm::uvec4> empty(shared::kIndirectTableTexels, glm::uvec4(0));
  std::erase_if(grid.chunks, [&](const auto& at) {
    const auto& [key, chunk] = at;
    if (chunk.put) return false;
    free(chunk.range);
    write(uploader, table_texel(grid.box, grid.tables.first, {key[0], key[1], key[2]}), empty);
    return true;
  });
  if (!entry.made) return;
  const glm::uvec4 head = header(grid.box, grid.tables.first);
  write(uploader, island, std::span<const glm::uvec4>(&head, 1));
  free(entry.shown);
  entry.shown = std::exchange(entry.made, std::nullopt);
}

void IndirectStore::open_island(gpu::Uploader& uploader, std::uint32_t island) {
  SKERRY_ASSERT(island < shared::kMaxIslands && !islands_.contains(island));
  const glm::uvec4 open(0, 0, 0, shared::kIndirectOpen);
  write(uploader, island, std::span<const glm::uvec4>(&open, 1));
  islands_[island];
}

void IndirectStore::end_island(gpu::Uploader& uploader, std::uint32_t island) {
  const auto found = islands_.find(island);
  if (found == islands_.end()) return;
  const glm::uvec4 nowhere(0);
  write(uploader, island, std::span<const glm::uvec4>(&nowhere, 1));
  free(found->second.shown);
  free(found->second.made);
  islands_.erase(found);
}

void IndirectStore::collect() {
  arena_.collect(device_->completed_value());
}

}  // namespace skerry::render
