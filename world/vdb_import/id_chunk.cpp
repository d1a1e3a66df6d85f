#include "world/vdb_import/id_chunk.h"

#include <cmath>
#include <optional>
#include <vector>

#include "world/vdb_import/solid.h"
#include "world/voxel/edits.h"

namespace skerry::world {
namespace {

/// Whether this program has a block of that id, which is above air's.
bool is_known(float id) {
  return id < static_cast<float>(block::kBuiltInCount) - 0.5f;
}

BlockId block_of(float id) {
  return is_known(id) ? static_cast<BlockId>(std::floor(id + 0.5f)) : BlockId{block::kStone};
}

class ChunkOfIds {
 public:
  ChunkOfIds(const VolumeField& field, const SolidRule& rule, const Placement& placement)
      : field_(field), rule_(rule), placement_(placement) {}

  IdChunk run(IVec3 chunk) {
    const IVec3 origin{chunk.x * kChunkEdge, chunk.y * kChunkEdge, chunk.z * kChunkEdge};
    if (const std::optional<float> id = id_of_all(origin, kChunkEdge)) {
      out_.unknown = is_known(*id) ? 0 : kChunkVoxels;
      out_.chunk = Chunk(block_of(*id));
    } else {
      voxels_.assign(kChunkVoxels, kAir);
      fill(origin, kChunkEdge);
      out_.chunk = Chunk::from_voxels(voxels_);
    }
    return std::move(out_);
  }

 private:
  /// The id of all voxels of a cube where bounds of the values decide it, 0 for air.
  std::optional<float> id_of_all(IVec3 low, int edge) {
    out_.looks += kBoundsLooks;
    const VolumeField::Range seen =
        values_in_cube(field_, placement_, glm::dvec3{low.x, low.y, low.z}, edge);
    if (seen.min != seen.max) return std::nullopt;
    return rule_(seen.min) ? seen.min : 0.0f;
  }

  void fill(IVec3 low, int edge) {
    constexpr int kLeastCube = 4;
    const std::optional<float> all = id_of_all(low, edge);
    if (all == 0.0f) return;
    if (all || edge <= kLeastCube) return copy(low, edge, all);
    const int half = edge / 2;
    for (int part = 0; part < 8; ++part)
      fill({low.x + half * (part & 1), low.y + half * (part >> 1 & 1), low.z + half * (part >> 2)},
           half);
  }

  /// @param all the id of the whole cube; none: each voxel is looked up.
  void copy(IVec3 low, int edge, std::optional<float> all) {
    if (!all) out_.looks += static_cast<std::uint64_t>(edge * edge * edge);
    for (int y = low.y; y < low.y + edge; ++y) {
      for (int x = low.x; x < low.x + edge; ++x) {
        for (int z = low.z; z < low.z + edge; ++z) {
          const glm::dvec3 centre = glm::dvec3{x, y, z} + 0.5;
          const float id = all ? *all : field_.nearest(placement_.index_from_lattice(centre));
          if (!rule_(id)) continue;
          out_.unknown += is_known(id) ? 0 : 1;
          voxels_[index_in_chunk({x, y, z})] = block_of(id);
        }
      }
    }
  }

  const VolumeField& field_;
  const SolidRule& rule_;
  const Placement& placement_;
  IdChunk out_;
  std::vector<BlockId> voxels_;
};

}  // namespace

IdChunk id_chunk(const VolumeField& field, const SolidRule& rule, const Placement& placement,
                 IVec3 chunk) {
  return ChunkOfIds(field, rule, placement).run(chunk);
}

}  // namespace skerry::world
