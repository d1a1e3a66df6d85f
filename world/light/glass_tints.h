#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/ext/vector_int3_sized.hpp>
#include <glm/vec3.hpp>
#include <unordered_map>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/lattice_lines.h"
#include "world/light/voxel_index.h"

namespace skerry::world {

/// What stained glass leaves of the light that comes along lattice lines, by Beer's law over their
/// length in glass up to where they end. Of voxels whose view is kept, and only of lines that pass
/// glass.
///
/// Lengths are summed as integers: the sum is the same whatever part of a line is known first.
class GlassTints {
 public:
  /// One line of a voxel.
  struct Tint {
    std::uint8_t pattern = 0;
    glm::vec3 left{1.0f};  ///< share of the light, 0..1
  };
  using Tints = std::vector<Tint>;  ///< of a fan, ascending by pattern
  /// Optical depth, RGB, in 2^-20.
  using Depth = glm::i64vec3;

  /// All must outlive this.
  GlassTints(const AirVolume& air, const LatticeLines& lines, const VoxelIndex& wanted);

  /// Whether there is any glass.
  bool any() const { return !air_.stained.empty(); }
  /// Looks along a fan's lines. Fans may be looked along at once, each by one thread.
  void look(std::size_t fan);
  /// Null: none of a voxel's lines of a fan passes glass.
  const Tints* find(std::size_t number, std::size_t fan) const;
  /// Whether a line of a voxel's passes glass.
  bool has(std::size_t number) const;
  std::size_t bytes() const;

  // --- Edits ---

  /// Of a line from a voxel on, up to its end.
  Depth depth_from(IVec3 from, std::size_t way) const;
  /// Of a line's part once along its vector, up to what stops it there.
  Depth depth_of_step(IVec3 from, std::size_t way) const;
  /// @param depth depth_from() the voxel. @return whether that is other than it was.
  bool set(IVec3 voxel, std::size_t way, const Depth& depth);
  /// A voxel's number becomes another that has no lines here.
  void move(std::size_t from, std::size_t to);
  /// The voxel with that number is gone.
  void forget(std::size_t number);

 private:
  struct Fan {
    std::vector<std::uint64_t> has;  // a bit a number: it has lines here
    std::unordered_map<std::size_t, Tints> lines;
    bool holds(std::size_t number) const {
      return number / 64 < has.size() && (has[number / 64] >> number % 64 & 1u) != 0;
    }
  };
  void look_along(std::size_t way, VoxelBits& visited);
  const Depth& per_eighth(BlockId block, std::size_t way) const {
    return per_eighth_[block * shared::kSkyPatternCount + way % shared::kSkyPatternCount];
  }
  void add(Depth& depth, IVec3 voxel, int eighths, std::size_t way) const;

  const AirVolume& air_;
  const LatticeLines& lines_;
  const VoxelIndex& wanted_;
  std::vector<Depth> per_eighth_;  // by block and pattern; empty without glass
  std::array<Fan, kFans> fans_;
};

/// What is left of light after a way through stained glass or water. @param blocks its length.
glm::vec3 left_by_glass(BlockId block, float blocks);

}  // namespace skerry::world
