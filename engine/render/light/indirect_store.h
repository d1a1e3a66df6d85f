#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/quad_arena.h"
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
  bool changed = true;  ///< since it was last handed over, to an island that has kept its grid
};

/// The light of the sky on surfaces, on the GPU: one buffer of texels. Writes go
/// through the uploader's queue, records before the tables that name them.
class IndirectStore {
 public:
  /// @param budget must outlive the store.
  static Result<std::unique_ptr<IndirectStore>> create(gpu::Device& device, MemoryBudget& budget);
  ~IndirectStore();

  /// Replaces all that is known of an island. @param island index into the island table. @param
  /// chunks ascending; those that were there and are no more are dropped. Errors: the budget is
  /// spent or the device has no more; then the island has no light of the sky.
  Result<void> set_island(gpu::Uploader& uploader, std::uint32_t island, const IslandChunks& box,
                          std::span<const ChunkSkyLight> chunks);
  /// An island without is no error.
  void end_island(gpu::Uploader& uploader, std::uint32_t island);
  /// What the sky sends to the faces of the first islands of the table now (sky_irradiance()).
  void set_sky(gpu::Uploader& uploader, std::span<const glm::uvec4> irradiance);
  /// Once a frame, before recording: reclaims what the GPU has finished with.
  void collect();

  gpu::Buffer& texels() { return texels_; }
  /// In use, or still to be read by the GPU.
  std::uint64_t bytes_in_use() const {
    return (std::uint64_t{arena_.used()} + arena_.waiting()) * sizeof(glm::uvec4);
  }

 private:
  using Key = std::array<int, 3>;
  struct Island {
    IslandChunks box{};
    gpu::ArenaRange tables;
    std::map<Key, gpu::ArenaRange> chunks;
  };
  IndirectStore(gpu::Device& device, MemoryBudget& budget);
  Result<gpu::ArenaRange> allocate(std::uint32_t texels);
  void free(gpu::ArenaRange range);
  Result<void> put_chunks(gpu::Uploader& uploader, Island& island,
                          std::span<const ChunkSkyLight> chunks, bool all);
  void write(gpu::Uploader& uploader, std::uint32_t texel, std::span<const glm::uvec4> values);

  gpu::Device* device_;
  MemoryBudget* budget_;
  gpu::OffsetArena arena_;
  gpu::Buffer texels_;
  std::map<std::uint32_t, Island> islands_;
};

}  // namespace skerry::render
