#include "world/vdb/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <span>
#include <string>

#include "world/mesh/mesh.h"

namespace skerry::world {
namespace {

using Voxels = std::span<const BlockId>;

/// A box about a moving lattice.
class Frame {
 public:
  Frame(const BlockBox& box, const Pose& pose) : pose_(pose) {
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = static_cast<double>(box.low[axis]);
      high_[axis] = static_cast<double>(box.high[axis]);
    }
    origin_ = difference_blocks(pose.origin, {});
  }

  /// Whether the centre of a voxel lies in the box.
  bool holds(IVec3 voxel) const {
    const glm::dvec3 p = centre_of(voxel);
    return glm::all(glm::greaterThanEqual(p, low_)) && glm::all(glm::lessThan(p, high_));
  }

  enum class Part : std::uint8_t { kNone, kSome, kAll };
  /// How many voxels of a chunk lie in the box. A few that have none may be counted as having some.
  Part part_of(IVec3 origin) const {
    constexpr int kLast = kChunkEdge - 1;
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    bool all = true;
    for (int corner = 0; corner < 8; ++corner) {
      const IVec3 voxel{origin.x + kLast * (corner & 1), origin.y + kLast * (corner >> 1 & 1),
                        origin.z + kLast * (corner >> 2)};
      const glm::dvec3 p = centre_of(voxel);
      low = glm::min(low, p);
      high = glm::max(high, p);
      all = all && holds(voxel);
    }
    if (all) return Part::kAll;  // both are convex
    const bool apart =
        glm::any(glm::lessThan(high, low_)) || glm::any(glm::greaterThanEqual(low, high_));
    return apart ? Part::kNone : Part::kSome;
  }

  glm::dmat4 world_from_index() const {
    const glm::dmat3 turn = glm::mat3_cast(pose_.rotation);
    glm::dmat4 out(turn);
    out[3] = glm::dvec4(origin_ + turn * glm::dvec3(0.5), 1.0);
    return out;
  }

 private:
  glm::dvec3 centre_of(IVec3 voxel) const {
    return origin_ + pose_.rotation * (glm::dvec3{voxel.x, voxel.y, voxel.z} + 0.5);
  }

  Pose pose_;
  glm::dvec3 low_{}, high_{}, origin_{};
};

/// Collects one value a voxel into bricks and tiles.
class Collector {
 public:
  Collector(std::string name, VolumeKind kind, const Frame& frame) {
    grid_.name = std::move(name);
    grid_.kind = kind;
    grid_.world_from_index = frame.world_from_index();
  }

  void add_tile(IVec3 origin, std::int32_t edge, float value) {
    if (value != 0.0f) grid_.tiles.push_back({origin, edge, value});
  }

  /// @param value of an index in the brick, in OpenVDB's order.
  template <class Value>
  void add_brick(IVec3 origin, Value&& value) {
    VolumeBrick brick{origin, {}};
    for (std::size_t i = 0; i < brick.values.size(); ++i) brick.values[i] = value(i);
    const float first = brick.values[0];
    const bool even = std::all_of(brick.values.begin(), brick.values.end(),
                                  [first](float v) { return v == first; });
    if (even) {
      add_tile(origin, kBrickEdge, first);
    } else {
      grid_.bricks.push_back(brick);
    }
  }

  std::size_t parts() const { return grid_.bricks.size() + grid_.tiles.size(); }

  /// Sorted, with active voxels counted.
  VolumeGrid finish() {
    const auto by_origin = [](const auto& a, const auto& b) { return a.origin < b.origin; };
    std::sort(grid_.bricks.begin(), grid_.bricks.end(), by_origin);
    std::sort(grid_.tiles.begin(), grid_.tiles.end(), by_origin);
    for (const VolumeTile& tile : grid_.tiles) {
      const auto edge = static_cast<std::uint64_t>(tile.edge);
      count(tile.origin, tile.edge, edge * edge * edge);
    }
    for (const VolumeBrick& brick : grid_.bricks) {
      const auto zeros = std::count(brick.values.begin(), brick.values.end(), 0.0f);
      count(brick.origin, kBrickEdge, 512u - static_cast<std::uint64_t>(zeros));
    }
    return std::move(grid_);
  }

 private:
  void count(IVec3 low, std::int32_t edge, std::uint64_t active) {
    VolumeBox& box = grid_.active_box;
    const IVec3 high{low.x + edge - 1, low.y + edge - 1, low.z + edge - 1};
    const bool first = grid_.active_voxels == 0;
    grid_.active_voxels += active;
    box.min = first ? low
                    : IVec3{std::min(box.min.x, low.x), std::min(box.min.y, low.y),
                            std::min(box.min.z, low.z)};
    box.max = first ? high
                    : IVec3{std::max(box.max.x, high.x), std::max(box.max.y, high.y),
                            std::max(box.max.z, high.z)};
  }

  VolumeGrid grid_;
};

float density_of(BlockId id) {
  return is_solid(id) ? 1.0f : 0.0f;
}

class IslandExport {
 public:
  IslandExport(World& world, const IslandSpec& spec, const BlockBox& box, const std::string& suffix)
      : world_(world),
        spec_(spec),
        frame_(box, *world.pose(spec.id, 0.0)),
        ids_("block_id" + suffix, VolumeKind::kIds, frame_),
        density_("density" + suffix, VolumeKind::kFog, frame_) {}

  void add(IVec3 chunk) {
    const IVec3 origin{chunk.x * kChunkEdge, chunk.y * kChunkEdge, chunk.z * kChunkEdge};
    const Frame::Part part = frame_.part_of(origin);
    if (part == Frame::Part::kNone) return;
    std::vector<BlockId> padded(kPaddedVoxels);
    if (!world_.generate_padded(spec_.id, chunk, 0, padded)) return;
    const Chunk made = chunk_from_padded(padded);
    if (made.is_uniform() && part == Frame::Part::kAll) {
      add_tile(origin, made.at(std::size_t{0}));
      return;
    }
    std::vector<BlockId> voxels(kChunkVoxels);
    made.unpack(voxels);
    if (part == Frame::Part::kSome) cut(voxels, origin);
    const bool even =
        std::all_of(voxels.begin(), voxels.end(), [&](BlockId id) { return id == voxels[0]; });
    even ? add_tile(origin, voxels[0]) : add_bricks(voxels, origin);
  }

  std::size_t parts() const { return ids_.parts() + density_.parts(); }
  bool empty() const { return ids_.parts() == 0; }
  void finish(std::vector<VolumeGrid>& out) {
    out.push_back(ids_.finish());
    out.push_back(density_.finish());
  }

 private:
  void add_tile(IVec3 origin, BlockId id) {
    ids_.add_tile(origin, kChunkEdge, id);
    density_.add_tile(origin, kChunkEdge, density_of(id));
  }

  /// Makes everything outside the box air.
  void cut(std::vector<BlockId>& voxels, IVec3 origin) const {
    for (int y = 0; y < kChunkEdge; ++y) {
      for (int x = 0; x < kChunkEdge; ++x) {
        for (int z = 0; z < kChunkEdge; ++z) {
          BlockId& id = voxels[voxel_index(x, y, z)];
          if (id != kAir && !frame_.holds({origin.x + x, origin.y + y, origin.z + z})) id = kAir;
        }
      }
    }
  }

  void add_bricks(Voxels voxels, IVec3 origin) {
    for (int x = 0; x < kChunkEdge; x += kBrickEdge) {
      for (int y = 0; y < kChunkEdge; y += kBrickEdge) {
        for (int z = 0; z < kChunkEdge; z += kBrickEdge) {
          const IVec3 at{origin.x + x, origin.y + y, origin.z + z};
          const auto id = [&](std::size_t i) {
            const int k = static_cast<int>(i);
            return voxels[voxel_index(x + (k >> 6), y + (k >> 3 & 7), z + (k & 7))];
          };
          ids_.add_brick(at, [&](std::size_t i) { return static_cast<float>(id(i)); });
          density_.add_brick(at, [&](std::size_t i) { return density_of(id(i)); });
        }
      }
    }
  }

  World& world_;
  const IslandSpec& spec_;
  Frame frame_;
  Collector ids_, density_;
};

std::vector<IslandSpec> islands_in(World& world, const BlockBox& box) {
  WorldPos centre;
  glm::dvec3 half;
  const auto middle = [&](int axis) {
    half[axis] = 0.5 * static_cast<double>(box.high[axis] - box.low[axis]);
    return (box.low[axis] + (box.high[axis] - box.low[axis]) / 2) * kUnitsPerBlock;
  };
  centre = {middle(0), middle(1), middle(2)};
  std::vector<IslandSpec> islands = world.islands_near(centre, glm::length(half) + 1.0, 0.0);
  // The ball around the box reaches much further than the box.
  std::erase_if(islands, [&](const IslandSpec& spec) {
    const glm::dvec3 away =
        glm::abs(difference_blocks(world.pose(spec.id, 0.0)->origin, centre)) - half;
    return glm::length(glm::max(away, 0.0)) > spec.bounding_radius + 1.0;
  });
  return islands;
}

/// Whether a box is small enough to look for all islands that a seed makes in it.
bool can_be_searched(const World& world, const BlockBox& box) {
  if (!world.desc().generated) return true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (box.high[axis] - box.low[axis] > kMaxSeedBoxBlocks) return false;
  return true;
}

}  // namespace

Result<std::vector<VolumeGrid>> volumes_of(World& world, const BlockBox& box,
                                           const ReadProgress& progress) {
  if (!can_be_searched(world, box))
    return Error{fmt::format("its box is more than {} blocks long; give a smaller --box",
                             kMaxSeedBoxBlocks)};
  const std::vector<IslandSpec> islands = islands_in(world, box);
  std::vector<VolumeGrid> grids;
  std::size_t parts = 0;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const std::string suffix = islands.size() > 1 ? fmt::format("_{}", i) : "";
    IslandExport island(world, islands[i], box, suffix);
    const std::vector<IVec3> chunks = world.chunks(islands[i].id, 0);
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      island.add(chunks[c]);
      if (parts + island.parts() > kMaxExportParts)
        return Error{fmt::format("it holds more than {} bricks of 8^3 voxels; give a smaller --box",
                                 kMaxExportParts)};
      const double done = static_cast<double>(c + 1) / static_cast<double>(chunks.size());
      if (progress) progress((static_cast<double>(i) + done) / static_cast<double>(islands.size()));
    }
    parts += island.parts();
    if (!island.empty()) island.finish(grids);
    world.release_plan(islands[i].id);
  }
  if (grids.empty()) return Error{"there is no block in the box; give another --box"};
  return grids;
}

}  // namespace skerry::world
