#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "world/voxel/chunk.h"
#include "world/voxel/coords.h"

namespace skerry::world {

class World;

/// A bit for each of 8^3 voxels: bit z + 8 x of layer y.
struct BitBrick {
  static constexpr int kEdge = 8;
  std::array<std::uint64_t, kEdge> layers{};

  bool at(int x, int y, int z) const { return (layers[y] >> (z + kEdge * x) & 1) != 0; }
  void set(int x, int y, int z, bool value) {
    const std::uint64_t bit = std::uint64_t{1} << (z + kEdge * x);
    layers[y] = value ? layers[y] | bit : layers[y] & ~bit;
  }
  bool any() const {
    std::uint64_t all = 0;
    for (const std::uint64_t layer : layers) all |= layer;
    return all != 0;
  }
  int count() const {
    int sum = 0;
    for (const std::uint64_t layer : layers) sum += std::popcount(layer);
    return sum;
  }
  bool operator==(const BitBrick&) const = default;
};

/// Number of a brick in its chunk, and of the brick that holds a voxel.
constexpr IVec3 brick_of(IVec3 voxel) {
  return {voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
}

struct IVec3Hash {
  std::size_t operator()(const IVec3& v) const;
};

/// What weighs something: solid voxels of an island. Blocks weigh one each.
struct Mass {
  std::uint64_t blocks = 0;
  glm::dvec3 centre{};   ///< lattice [blocks]
  double inertia = 0.0;  ///< about the vertical through the centre [blocks^3]
};

/// Which voxels of an island carry weight (is_solid): what holds it together and what others bump
/// into. Chunks are looked at when first asked for. One thread at a time.
class SolidGrid {
 public:
  /// Fills a chunk's ids, in voxel_index order. @return false: all air.
  using Fill = std::function<bool(IVec3 chunk, std::span<BlockId> out)>;
  /// @param chunks all that may hold anything.
  SolidGrid(std::vector<IVec3> chunks, Fill fill);
  /// As the island is now; chunks not yet looked at as they are then. Builds the island's plan if
  /// need be. @param world outlives the grid. @param stopped outlives it, too; once true, nobody
  /// wants the grid any more, and chunks not yet looked at count as empty.
  static SolidGrid of_island(World& world, std::uint64_t island,
                             const std::atomic<bool>* stopped = nullptr);

  bool at(IVec3 voxel) const;
  /// An edit. @return whether it changed anything.
  bool set(IVec3 voxel, bool solid);
  /// Takes away voxels of a brick.
  void clear(IVec3 at, const BitBrick& voxels);
  /// The voxels of a brick; nullptr: none of them is solid.
  const BitBrick* brick(IVec3 at) const;
  /// Looks at all chunks that were not yet.
  void complete();
  /// Bricks with anything solid in them, ascending. Completes the grid.
  std::vector<IVec3> solid_bricks();
  /// Solid voxels of a brick that lie beside one that is not.
  BitBrick surface_of(IVec3 at) const;

 private:
  static constexpr int kBricks = kChunkEdge / BitBrick::kEdge;
  struct ChunkBits {
    std::array<BitBrick, static_cast<std::size_t>(kBricks) * kBricks * kBricks> bricks{};
  };
  struct Slot {
    bool looked_at = false;
    std::unique_ptr<ChunkBits> bits;  // none: nothing solid
  };
  static std::size_t brick_index(IVec3 at) {
    return static_cast<std::size_t>((at.z & 7) + kBricks * ((at.x & 7) + kBricks * (at.y & 7)));
  }
  const ChunkBits* bits(IVec3 chunk) const;
  void look_at(IVec3 chunk, Slot& slot) const;

  Fill fill_;
  mutable std::unordered_map<IVec3, Slot, IVec3Hash> slots_;
};

/// Mass of some bricks of voxels.
class MassSum {
 public:
  /// @param sign -1 takes them away again.
  void add(IVec3 brick, const BitBrick& voxels, int sign);
  Mass mass() const;

 private:
  // Sums over the voxels' lowest corners. Integers: what was added and taken away leaves nothing.
  // 2^20 blocks from the middle, 2^22 of them fit.
  std::int64_t count_ = 0, x_ = 0, y_ = 0, z_ = 0, xx_zz_ = 0;
};

}  // namespace skerry::world
