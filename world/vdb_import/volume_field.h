#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <unordered_map>
#include <vector>

#include "world/vdb/volume_grid.h"

namespace skerry::world {

/// Look-ups in a VolumeGrid, which must outlive it. Memory follows bricks and tiles. Any thread.
class VolumeField {
 public:
  explicit VolumeField(const VolumeGrid& grid);

  const VolumeGrid& grid() const { return grid_; }
  /// The value of an index.
  float at(IVec3 index) const;
  /// The value of the index nearest to a place in index space.
  float nearest(glm::dvec3 place) const;
  /// Trilinear between the eight samples around a place in index space. Places within 1e-6 of a
  /// sample take its value, so that a transform's rounding never mixes in a neighbour.
  float interpolated(glm::dvec3 place) const;

  struct Range {
    float min, max;
  };
  /// Bounds of all values in an index box, both corners inclusive. They may be wider than need be.
  Range range(IVec3 low, IVec3 high) const;

 private:
  struct Hash {
    std::size_t operator()(const IVec3& key) const;
  };
  template <class T>
  using Map = std::unordered_map<IVec3, T, Hash>;
  struct TileLevel {
    int level;
    Map<float> values;
  };

  const VolumeBrick* brick_at(IVec3 index) const;
  float beside_bricks(IVec3 index) const;
  void widen_above(int level, IVec3 origin, Range range);
  Range node(int level, IVec3 key) const;
  Range range_of_samples(IVec3 low, IVec3 high) const;

  const VolumeGrid& grid_;
  Map<const VolumeBrick*> bricks_;      // by origin / 8
  std::vector<TileLevel> tile_levels_;  // one a tile size; keys are origin / edge
  std::vector<Map<Range>> nodes_;  // [n]: cubes of edge 8 * 2^n that hold parts of smaller ones
};

}  // namespace skerry::world
