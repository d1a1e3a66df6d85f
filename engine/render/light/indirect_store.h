#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/offset_arena.h"
#include "engine/render/scene/memory_budget.h"
#include "engine/render/scene/occupancy_store.h"
#include "shaders/shared/indirect.h"

namespace skerry::gpu {
class Device;
class Uploader;
}  // namespace skerry::gpu

namespace skerry::render {

/// How much of the sky the faces of a chunk see (shaders/shared/indirect.h).
struct ChunkSkyLight {
  glm::ivec3 chunk{};                    ///< at the level its island is shown at
  std::span<const std::uint32_t> table;  ///< kBricksPerChunk: 0, or 1 + which stored brick it is
  /// kIndirectBrickTexels of masks for each stored brick, then records, counted from 0.
  std::span<const glm::uvec4> texels;
  bool changed = true;  ///< since it was last put
  bool tinted = false;  ///< records have a tint
  bool keyed = false;   ///< and light from key directions
};

/// How much surfaces see of the sky, on the GPU: one buffer of texels. Writes go through the
/// uploader's queue, records before the tables that name them.
class IndirectStore {
 public:
  /// @param budget must outlive the store.
  static Result<std::unique_ptr<IndirectStore>> create(gpu::Device& device, MemoryBudget& budget);
  ~IndirectStore();

  /// Begins to replace what is known of an island: begin(), then put() for each of its chunks, over
  /// as many frames as it takes, then finish(). With the grid that the island has, chunks are
  /// replaced where they are; with another one, the old grid is shown until the new one is whole.
  /// To begin once more drops nothing of a grid that stays the same. @param island index into the
  /// island table. Errors: the budget is spent or the device has no more.
  Result<void> begin(gpu::Uploader& uploader, std::uint32_t island, const IslandChunks& box);
  /// Writes a chunk of the box, unless it is there and has not changed. Errors: as begin().
  Result<void> put(gpu::Uploader& uploader, std::uint32_t island, const ChunkSkyLight& chunk);
  /// Drops the chunks that were not put since begin(), and shows the island with the others.
  void finish(gpu::Uploader& uploader, std::uint32_t island);
  /// All faces of an island see all of their sky from now on. @pre it has no light of the sky.
  void open_island(gpu::Uploader& uploader, std::uint32_t island);
  /// The island has no light of the sky from now on. An island without is no error.
  void end_island(gpu::Uploader& uploader, std::uint32_t island);
  /// Once a frame, before recording: reclaims what the GPU has finished with.
  void collect();

  gpu::Buffer& texels() { return texels_; }
  /// In use, or still to be read by the GPU.
  std::uint64_t bytes_in_use() const { return bytes_of(arena_.used()) + bytes_waiting(); }
  /// Freed, still to be read by the GPU.
  std::uint64_t bytes_waiting() const { return bytes_of(arena_.waiting()); }
  /// What more can be put, apart from fragmentation.
  std::uint64_t bytes_left() const;
  /// What the chunks of a box take.
  static std::uint64_t bytes_for(const IslandChunks& box, std::span<const ChunkSkyLight> chunks);

 private:
  using Key = std::array<int, 3>;
  struct Chunk {
    gpu::ArenaRange range;
    bool put = true;  ///< since begin()
  };
  struct Grid {
    IslandChunks box{};
    gpu::ArenaRange tables;
    std::map<Key, Chunk> chunks;
  };
  struct Island {
    std::optional<Grid> shown, made;  ///< made: not yet whole
    Grid& target() { return made ? *made : *shown; }
  };
  IndirectStore(gpu::Device& device, MemoryBudget& budget, std::uint32_t texels);
  Result<gpu::ArenaRange> allocate(gpu::Uploader& uploader, std::uint32_t texels);
  void free(gpu::ArenaRange range);
  void free(std::optional<Grid>& grid);
  void write(gpu::Uploader& uploader, std::uint32_t texel, std::span<const glm::uvec4> values);
  static std::uint64_t bytes_of(std::uint64_t texels) { return texels * sizeof(glm::uvec4); }

  gpu::Device* device_;
  MemoryBudget* budget_;
  gpu::OffsetArena arena_;  ///< of texels
  gpu::Buffer texels_;
  std::map<std::uint32_t, Island> islands_;
};

}  // namespace skerry::render
