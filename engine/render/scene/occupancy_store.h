#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/offset_arena.h"
#include "engine/render/scene/memory_budget.h"
#include "shaders/shared/occupancy.h"

namespace skerry::gpu {
class Device;
class Uploader;
}  // namespace skerry::gpu

namespace skerry::render {

/// Chunks that an island is expected to have, at the level of detail it is shown at: a box.
struct IslandChunks {
  glm::ivec3 low{};   ///< chunk coordinate at its level
  glm::ivec3 size{};  ///< chunks, each > 0
  std::uint32_t voxel_size_log2 = 0;
};

/// Which voxels of a chunk are opaque (shaders/shared/occupancy.h).
struct OccupancyBits {
  bool full = false;                     ///< all of them; then there is nothing else
  std::span<const std::uint32_t> table;  ///< kBricksPerChunk entries, bricks numbered from 0
  std::span<const std::uint32_t> words;  ///< kBrickWords for each stored brick
};

/// The opaque voxels of all resident chunks on the GPU: a grid an island, a table of bricks for
/// each chunk of the grid, the bricks' bits. Writes go through the uploader's queue, bits before
/// the table that names them, so the GPU never sees a table whose bits are missing.
class OccupancyStore {
 public:
  /// @param budget must outlive the store.
  static Result<std::unique_ptr<OccupancyStore>> create(gpu::Device& device, MemoryBudget& budget);
  ~OccupancyStore();

  /// An island whose chunks come next; all of them are empty. @param island index into the island
  /// table, not in the store. Errors, with nothing changed: the device or the budget allows no more
  /// tables, and what to lower.
  Result<void> begin_island(gpu::Uploader& uploader, std::uint32_t island,
                            const IslandChunks& expected);
  /// Queues a chunk of an island that has begun, in place of what was there. Chunks outside those
  /// expected are taken, too; but one too far from the others for a grid to hold both
  /// (kMaxGridEdge, kLowestGridChunk) is left out and counts as empty. Errors: as above; then the
  /// chunk is empty.
  Result<void> add(gpu::Uploader& uploader, std::uint32_t island, glm::ivec3 chunk,
                   const OccupancyBits& bits);
  /// Empties a chunk. What it took may be overwritten once the GPU has finished everything
  /// submitted so far. A chunk that is empty is no error.
  void remove(gpu::Uploader& uploader, std::uint32_t island, glm::ivec3 chunk);
  /// Removes an island and all its chunks.
  void end_island(gpu::Uploader& uploader, std::uint32_t island);
  /// Once a frame, before recording: reclaims what the GPU has finished with.
  void collect();

  gpu::Buffer& grids() { return grids_; }                       ///< OccupancyGrid[kMaxIslands]
  gpu::Buffer& tables() { return tables_; }                     ///< uint[table][kBricksPerChunk]
  gpu::Buffer& words() { return words_; }                       ///< uint[brick][kBrickWords]
  std::uint32_t bricks() const { return brick_arena_.used(); }  ///< stored
  /// Of tables and bricks that are in use or that the GPU may still read.
  std::uint64_t bytes_in_use() const;

 private:
  struct Chunk {
    gpu::ArenaRange bricks;
    std::vector<std::uint32_t> table;  // as uploaded
  };
  struct Grid {
    IslandChunks box;
    gpu::ArenaRange tables;
    std::map<std::array<int, 3>, Chunk> chunks;  // that are not empty
    std::uint32_t table_of(glm::ivec3 chunk) const;
  };
  OccupancyStore(gpu::Device& device, MemoryBudget& budget);
  Result<void> place(gpu::Uploader& uploader, std::uint32_t island, Grid& grid,
                     const IslandChunks& box);
  void write_table(gpu::Uploader& uploader, std::uint32_t table,
                   std::span<const std::uint32_t> entries);

  gpu::Device* device_;
  MemoryBudget* budget_;
  gpu::OffsetArena table_arena_, brick_arena_;
  gpu::Buffer grids_, tables_, words_;
  std::map<std::uint32_t, Grid> islands_;
};

}  // namespace skerry::render
