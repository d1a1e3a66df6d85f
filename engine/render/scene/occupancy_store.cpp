#include "engine/render/scene/occupancy_store.h"

#include <algorithm>
#include <glm/common.hpp>
#include <optional>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/scene/grow_buffer.h"
#include "shaders/shared/frame.h"

namespace skerry::render {
namespace {

constexpr std::uint32_t kLeastTables = 256, kUsualTables = 2048;       // 8 MiB
constexpr std::uint32_t kLeastBricks = 8192, kUsualBricks = 1u << 16;  // 4 MiB
constexpr std::uint64_t kMostTables = 1u << 21;
constexpr std::uint64_t kTableBytes = shared::kBricksPerChunk * sizeof(std::uint32_t);
constexpr std::uint64_t kBrickBytes = shared::kBrickWords * sizeof(std::uint32_t);
constexpr std::uint32_t kBrickMask = shared::kMaxBricks;  // of a table's entry

std::array<int, 3> key(glm::ivec3 chunk) {
  return {chunk.x, chunk.y, chunk.z};
}

std::uint32_t volume(glm::ivec3 size) {
  return static_cast<std::uint32_t>(size.x * size.y * size.z);
}

bool is_stored(std::uint32_t entry) {
  return entry != shared::kBrickEmpty && entry != shared::kBrickFull;
}

/// The box with a chunk in it, if a grid can be as large.
std::optional<IslandChunks> with_chunk(IslandChunks box, glm::ivec3 chunk) {
  const glm::ivec3 low = glm::min(box.low, chunk), end = glm::max(box.low + box.size, chunk + 1);
  box.low = low;
  box.size = end - low;
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] < shared::kLowestGridChunk || end[axis] - 1 > shared::kHighestGridChunk ||
        box.size[axis] > static_cast<int>(shared::kMaxGridEdge))
      return std::nullopt;
  }
  return box;
}

shared::OccupancyGrid record(const IslandChunks& box, std::uint32_t first) {
  const auto part = [](int value, std::uint32_t mask) {
    return static_cast<std::uint32_t>(value) & mask;
  };
  return {part(box.low.x, 1023) | part(box.low.y, 1023) << 10 | part(box.low.z, 1023) << 20,
          part(box.size.x, 255) | part(box.size.y, 255) << 8 | part(box.size.z, 255) << 16 |
              box.voxel_size_log2 << 24,
          first};
}

}  // namespace

std::uint32_t OccupancyStore::Grid::table_of(glm::ivec3 chunk) const {
  const glm::ivec3 at = chunk - box.low;
  return tables.first + static_cast<std::uint32_t>((at.y * box.size.x + at.x) * box.size.z + at.z);
}

OccupancyStore::OccupancyStore(gpu::Device& device, MemoryBudget& budget)
    : device_(&device),
      budget_(&budget),
      table_arena_(budget.first_elements(kTableBytes, kLeastTables, kUsualTables)),
      brick_arena_(budget.first_elements(kBrickBytes, kLeastBricks, kUsualBricks)) {}

Result<std::unique_ptr<OccupancyStore>> OccupancyStore::create(gpu::Device& device,
                                                               MemoryBudget& budget) {
  std::unique_ptr<OccupancyStore> store(new OccupancyStore(device, budget));
  const std::array<std::tuple<gpu::Buffer*, const char*, std::uint64_t>, 3> wanted{{
      {&store->grids_, "occupancy grids", shared::kMaxIslands * sizeof(shared::OccupancyGrid)},
      {&store->tables_, "occupancy tables", store->table_arena_.capacity() * kTableBytes},
      {&store->words_, "occupancy bricks", store->brick_arena_.capacity() * kBrickBytes},
  }};
  for (const auto& [buffer, name, bytes] : wanted) {
    Result<gpu::Buffer> made = make_table(device, budget, name, bytes);
    if (!made) return made.error();
    *buffer = *std::move(made);
  }
  device.run_now([&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, store->grids_.handle(), 0, VK_WHOLE_SIZE, 0);
  });
  return store;
}

OccupancyStore::~OccupancyStore() {
  for (const gpu::Buffer* buffer : {&grids_, &tables_, &words_})
    budget_->give_back(buffer->size_bytes());
}

std::uint64_t OccupancyStore::bytes_in_use() const {
  return (std::uint64_t{table_arena_.used()} + table_arena_.waiting()) * kTableBytes +
         (std::uint64_t{brick_arena_.used()} + brick_arena_.waiting()) * kBrickBytes;
}

Result<void> OccupancyStore::begin_island(gpu::Uploader& uploader, std::uint32_t island,
                                          const IslandChunks& expected) {
  SKERRY_ASSERT(island < shared::kMaxIslands && !islands_.contains(island));
  SKERRY_ASSERT(with_chunk(expected, expected.low).has_value());
  Grid grid;
  if (Result<void> placed = place(uploader, island, grid, expected); !placed) return placed;
  islands_.emplace(island, std::move(grid));
  return {};
}

/// Gives a grid a new box of tables, with what its chunks have.
Result<void> OccupancyStore::place(gpu::Uploader& uploader, std::uint32_t island, Grid& grid,
                                   const IslandChunks& box) {
  Result<gpu::ArenaRange> tables =
      allocate(*device_, *budget_, uploader, {table_arena_, tables_, kTableBytes, kMostTables},
               volume(box.size));
  if (!tables) return tables.error();
  table_arena_.free(grid.tables, device_->next_value());
  grid.box = box;
  grid.tables = *tables;
  // The box of a giant has megabytes of them.
  uploader.fill(tables_, tables->first * kTableBytes, tables->count * kTableBytes,
                shared::kChunkEmpty);
  for (const auto& [at, chunk] : grid.chunks)
    write_table(uploader, grid.table_of({at[0], at[1], at[2]}), chunk.table);
  const shared::OccupancyGrid written = record(box, tables->first);
  uploader.write(grids_, std::uint64_t{island} * sizeof(written),
                 std::span<const shared::OccupancyGrid>(&written, 1));
  return {};
}

Result<void> OccupancyStore::add(gpu::Uploader& uploader, std::uint32_t island, glm::ivec3 chunk,
                                 const OccupancyBits& bits) {
  const auto found = islands_.find(island);
  SKERRY_ASSERT(found != islands_.end());
  SKERRY_ASSERT(bits.full ? bits.table.empty() : bits.table.size() == shared::kBricksPerChunk);
  SKERRY_ASSERT(bits.words.size() % shared::kBrickWords == 0);
  remove(uploader, island, chunk);
  Grid& grid = found->second;
  const std::optional<IslandChunks> box = with_chunk(grid.box, chunk);
  if (!box) return {};
  const auto count = static_cast<std::uint32_t>(bits.words.size() / shared::kBrickWords);
  if (box->size != grid.box.size)
    if (Result<void> placed = place(uploader, island, grid, *box); !placed) return placed;
  const Result<gpu::ArenaRange> bricks = allocate(
      *device_, *budget_, uploader, {brick_arena_, words_, kBrickBytes, shared::kMaxBricks}, count);
  if (!bricks) return bricks.error();
  Chunk made{*bricks, {bits.table.begin(), bits.table.end()}};
  if (bits.full) made.table.assign(shared::kBricksPerChunk, shared::kBrickFull);
  for (std::uint32_t& entry : made.table) {
    if (!is_stored(entry)) continue;
    SKERRY_ASSERT((entry & kBrickMask) < count);
    entry += bricks->first;
  }
  uploader.write(words_, bricks->first * kBrickBytes, bits.words);
  const Chunk& kept = grid.chunks.insert_or_assign(key(chunk), std::move(made)).first->second;
  write_table(uploader, grid.table_of(chunk), kept.table);
  return {};
}

void OccupancyStore::remove(gpu::Uploader& uploader, std::uint32_t island, glm::ivec3 chunk) {
  const auto grid = islands_.find(island);
  SKERRY_ASSERT(grid != islands_.end());
  const auto found = grid->second.chunks.find(key(chunk));
  if (found == grid->second.chunks.end()) return;
  brick_arena_.free(found->second.bricks, device_->next_value());
  grid->second.chunks.erase(found);
  const std::vector<std::uint32_t> empty(shared::kBricksPerChunk, shared::kChunkEmpty);
  write_table(uploader, grid->second.table_of(chunk), empty);
}

void OccupancyStore::end_island(gpu::Uploader& uploader, std::uint32_t island) {
  const auto found = islands_.find(island);
  SKERRY_ASSERT(found != islands_.end());
  for (const auto& [at, chunk] : found->second.chunks)
    brick_arena_.free(chunk.bricks, device_->next_value());
  table_arena_.free(found->second.tables, device_->next_value());
  islands_.erase(found);
  const shared::OccupancyGrid nowhere{};
  uploader.write(grids_, std::uint64_t{island} * sizeof(nowhere),
                 std::span<const shared::OccupancyGrid>(&nowhere, 1));
}

void OccupancyStore::write_table(gpu::Uploader& uploader, std::uint32_t table,
                                 std::span<const std::uint32_t> entries) {
  uploader.write(tables_, table * kTableBytes, entries);
}

void OccupancyStore::collect() {
  table_arena_.collect(device_->completed_value());
  brick_arena_.collect(device_->completed_value());
}

}  // namespace skerry::render
