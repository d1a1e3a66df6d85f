// The voxels around the listener, as sound meets them.
#pragma once
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "game/sound/block_sound.h"
#include "world/voxel/coords.h"

namespace skerry::game {

/// A cube of voxels. Cells are 0 .. kEdge - 1 on each axis, places in blocks from the lowest
/// corner; all outside is air.
class SoundRoom {
 public:
  static constexpr int kEdge = 64;
  static constexpr std::size_t kCells = std::size_t{kEdge} * kEdge * kEdge;

  SoundRoom()
      : blocks_(kCells, world::kAir),
        media_(kCells, SoundMedium::kAir),
        solid_rows_(std::size_t{kEdge} * kEdge, 0) {}

  static bool inside(world::IVec3 cell) {
    return (static_cast<unsigned>(cell.x) < kEdge) & (static_cast<unsigned>(cell.y) < kEdge) &
           (static_cast<unsigned>(cell.z) < kEdge);
  }
  /// z fastest, y slowest. @pre inside.
  static std::size_t index(world::IVec3 cell) {
    return (static_cast<std::size_t>(cell.y) * kEdge + static_cast<std::size_t>(cell.x)) * kEdge +
           static_cast<std::size_t>(cell.z);
  }
  static world::IVec3 cell_of(const glm::dvec3& place) {
    const glm::ivec3 cell(glm::floor(place));
    return {cell.x, cell.y, cell.z};
  }
  static glm::dvec3 middle_of(world::IVec3 cell) {
    return {cell.x + 0.5, cell.y + 0.5, cell.z + 0.5};
  }

  world::BlockId block(world::IVec3 cell) const {
    return inside(cell) ? blocks_[index(cell)] : world::kAir;
  }
  SoundMedium medium(world::IVec3 cell) const {
    return inside(cell) ? media_[index(cell)] : SoundMedium::kAir;
  }
  bool is_solid(world::IVec3 cell) const { return medium(cell) == SoundMedium::kSolid; }
  /// @pre inside.
  void set(world::IVec3 cell, world::BlockId block) {
    blocks_[index(cell)] = block;
    media_[index(cell)] = medium_of(block);
    const std::uint64_t bit = std::uint64_t{1} << cell.z;
    std::uint64_t& row = solid_rows_[index(cell) / kEdge];
    row = is_solid(cell) ? row | bit : row & ~bit;
    ++revision_;
  }
  /// Solids of a row of cells: bit z is the cell at z. Rows outside are solid throughout.
  std::uint64_t solid_row(int x, int y) const {
    const bool there = (static_cast<unsigned>(x) < kEdge) & (static_cast<unsigned>(y) < kEdge);
    return there ? solid_rows_[static_cast<std::size_t>(y * kEdge + x)] : ~std::uint64_t{0};
  }
  /// All air again.
  void clear();
  /// Grows with every change.
  std::uint64_t revision() const { return revision_; }

 private:
  std::vector<world::BlockId> blocks_;
  std::vector<SoundMedium> media_;
  std::vector<std::uint64_t> solid_rows_;  // one for each x, and y slowest
  std::uint64_t revision_ = 1;
};

/// What a straight line meets.
struct StraightWay {
  bool open = true;      ///< no solid is in the way
  double loss_db = 0.0;  ///< of solids, leaves and surfaces of water together
};
/// Along the voxels that the line enters, face by face: what is closed on all sides keeps it out.
/// The voxels of both ends count as open; a solid that is entered at all costs a block of it.
StraightWay straight_way(const SoundRoom& room, const glm::dvec3& from, const glm::dvec3& to);

/// StraightWay::open alone, in less time.
bool in_sight(const SoundRoom& room, const glm::dvec3& from, const glm::dvec3& to);

/// Where a ray from inside the room meets the first solid or water.
struct RayHit {
  bool hit = false;
  double distance = 0.0;  ///< blocks; without a hit, to where the room ends or `reach`
  double cosine = 1.0;    ///< between the ray and the face's normal
  world::BlockId block = world::kAir;
};
RayHit first_hit(const SoundRoom& room, const glm::dvec3& from, const glm::dvec3& direction,
                 double reach);

}  // namespace skerry::game
