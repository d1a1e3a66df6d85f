#pragma once
#include <bit>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "shaders/shared/geometry.h"
#include "world/mesh/occupancy.h"
#include "world/voxel/chunk.h"
#include "world/voxel/coords.h"

namespace skerry::world {

struct FaceChanges;

/// Lowest voxel of a chunk.
constexpr IVec3 corner_of(IVec3 chunk) {
  return {chunk.x * kChunkEdge, chunk.y * kChunkEdge, chunk.z * kChunkEdge};
}

inline glm::ivec3 vector_of(IVec3 v) {
  return {v.x, v.y, v.z};
}

/// A lamp that is weak enough to be kept with the light of faces.
struct WeakLamp {
  glm::vec3 place{};      ///< from the chunk's lowest corner [voxels]
  glm::vec3 intensity{};  ///< irradiance of what faces it at a distance of one voxel
  float range = 0.0f;     ///< voxels; the light ends there smoothly, as shaders/shared/light.h says
};

/// A lamp that is not kept with faces, as far as what they reflect of it needs it.
struct StrongLamp {
  glm::vec3 place{};      ///< from the chunk's lowest corner [voxels]
  float range = 0.0f;     ///< voxels
  glm::vec3 intensity{};  ///< as WeakLamp has it
};

/// One chunk as light sees it. Immutable once shared.
struct LightChunk {
  ChunkOccupancy opaque;
  ChunkOccupancy leaves;            ///< cut-out blocks
  std::vector<shared::Quad> quads;  ///< all that is drawn of the chunk
  std::vector<WeakLamp> lamps{};
  std::vector<StrongLamp> strong{};     ///< all other lamps
  std::vector<StainedVoxel> stained{};  ///< stained glass
  float voxel_blocks = 1.0f;            ///< edge of a voxel at the chunk's level
};
using LightChunks = std::map<IVec3, std::shared_ptr<const LightChunk>>;  ///< by chunk at its level

/// One bit a voxel for a box of an island's voxels, in rows along z. All voxels outside are air.
class VoxelBits {
 public:
  VoxelBits() = default;
  /// @param low, size voxels; low.z and size.z are multiples of 64.
  VoxelBits(IVec3 low, IVec3 size, bool value);

  IVec3 low() const { return low_; }
  IVec3 size() const { return size_; }
  int row_words() const { return size_.z / 64; }
  bool inside(IVec3 voxel) const {
    const auto within = [](int from_low, int size) {
      return static_cast<unsigned>(from_low) < static_cast<unsigned>(size);
    };
    return within(voxel.x - low_.x, size_.x) && within(voxel.y - low_.y, size_.y) &&
           within(voxel.z - low_.z, size_.z);
  }
  /// False outside.
  bool at(IVec3 voxel) const { return inside(voxel) && bit(bit_at(voxel)); }
  void set(IVec3 voxel, bool value = true);  ///< @pre inside
  /// Words of a row, with one more of `outside` readable before and after. @param x, y from low.
  std::uint64_t* row(int x, int y) { return words_.data() + index(x, y); }
  const std::uint64_t* row(int x, int y) const { return words_.data() + index(x, y); }
  /// Words from a row to that of the next x.
  std::ptrdiff_t row_step() const { return row_words() + 2; }
  std::size_t bytes() const { return words_.capacity() * sizeof(std::uint64_t); }
  bool has_row(int x, int y) const { return x >= 0 && x < size_.x && y >= 0 && y < size_.y; }

  /// Number of a voxel's bit; of a voxel a vector further, bit_at() + bit_step(). Holds for z up to
  /// 64 outside. @param voxel its row must be inside.
  std::ptrdiff_t bit_at(IVec3 voxel) const {
    return static_cast<std::ptrdiff_t>(index(voxel.x - low_.x, voxel.y - low_.y) * 64) +
           (voxel.z - low_.z);
  }
  std::ptrdiff_t bit_step(IVec3 vector) const {
    return (std::ptrdiff_t{vector.y} * size_.x + vector.x) * (row_words() + 2) * 64 + vector.z;
  }
  bool bit(std::ptrdiff_t number) const {
    return words_[static_cast<std::size_t>(number / 64)] >> (number & 63) & 1u;
  }

 private:
  std::size_t index(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(row_words() + 2) +
           1;
  }
  IVec3 low_{}, size_{};
  std::vector<std::uint64_t> words_;
};

/// Calls fn(voxel) for each that is chosen.
template <class Fn>
void for_each_voxel(const VoxelBits& bits, const Fn& fn) {
  const IVec3 low = bits.low(), size = bits.size();
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int w = 0; w < bits.row_words(); ++w)
        for (std::uint64_t left = bits.row(x, y)[w]; left != 0; left &= left - 1)
          fn(IVec3{low.x + x, low.y + y, low.z + 64 * w + std::countr_zero(left)});
}

/// Stained glass in a box of voxels. Lines pass it; light that passes it takes its colour.
class StainedGlass {
 public:
  StainedGlass() = default;
  /// @param low, size as VoxelBits has them. @param voxel_blocks edge of a voxel.
  StainedGlass(IVec3 low, IVec3 size, float voxel_blocks)
      : voxels_(low, size, false), voxel_blocks_(voxel_blocks) {}
  bool empty() const { return blocks_.empty(); }
  const VoxelBits& voxels() const { return voxels_; }
  float voxel_blocks() const { return voxel_blocks_; }
  /// kAir: none is there.
  BlockId at(IVec3 voxel) const { return voxels_.at(voxel) ? block(voxels_.bit_at(voxel)) : kAir; }
  /// @param bit number of a bit of voxels() that is set.
  BlockId block(std::ptrdiff_t bit) const { return blocks_.at(bit); }
  /// @param block kAir: no glass. @pre the voxel is inside.
  void set(IVec3 voxel, BlockId block);

 private:
  VoxelBits voxels_;
  std::unordered_map<std::ptrdiff_t, BlockId> blocks_;  // by bit
  float voxel_blocks_ = 1.0f;
};

/// Opaque voxels of an island, its leaves and its plants, in a box larger than they are.
struct AirVolume {
  VoxelBits opaque, leaves, plants;
  bool has_leaves = false;  ///< or plants; else the bits of both are empty
  StainedGlass stained;     ///< without a box if the island has none
};
/// @param margin that the box is larger by, at each side [voxels]
AirVolume air_volume_of(const LightChunks& chunks, int margin = 2);

/// The opaque voxels alone, of a box. @param low, high its voxels, both included; along z it may be
/// made larger.
VoxelBits opaque_within(const LightChunks& chunks, IVec3 low, IVec3 high);

/// Takes the voxels of a chunk that has changed into a volume that was made with it.
/// @param before the chunk as it is in there. @param faces what of its faces has changed.
/// @return those that have changed; none, and nothing is taken in: the volume has no room for them,
/// or knew no leaves or no stained glass.
std::optional<std::vector<IVec3>> take_chunk(AirVolume& air, IVec3 at, const LightChunk& before,
                                             const LightChunk& now, const FaceChanges& faces);

}  // namespace skerry::world
