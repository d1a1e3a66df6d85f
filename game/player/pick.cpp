#include "game/player/pick.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <vector>

#include "world/islands/march.h"

namespace skerry::game {
namespace {

using world::BlockId;
using world::IVec3;

/// What a voxel that is not loaded counts as: a ray ends there and picks nothing.
constexpr BlockId kUnknown = std::numeric_limits<BlockId>::max();

bool pickable(BlockId block) {
  return block != world::kAir && block != world::block::kWater;
}

IVec3 floored(const glm::dvec3& p) {
  return {world::floor_to_int(p.x), world::floor_to_int(p.y), world::floor_to_int(p.z)};
}

/// An island's voxels about an eye, edits included, for world::march.
class NearVoxels {
 public:
  NearVoxels(const Surroundings& around, std::uint64_t island, const glm::dvec3& eye, double reach)
      : around_(around),
        island_(island),
        min_(floored(eye - reach)),
        max_(floored(eye + (reach + 1.0))) {}
  IVec3 box_min() const { return min_; }
  IVec3 box_max() const { return max_; }
  world::MarchCell cell_at(IVec3 voxel) const {
    return {1, around_.block(island_, voxel).value_or(kUnknown)};
  }

 private:
  const Surroundings& around_;
  std::uint64_t island_;
  IVec3 min_, max_;
};

struct Hit {
  double t;
  int face;
};

/// Where a ray from outside enters a box. Slabs: A. Williams et al., An Efficient and Robust
/// Ray-Box Intersection Algorithm, 2005.
std::optional<Hit> enter_box(const glm::dvec3& origin, const glm::dvec3& direction,
                             const glm::dvec3& min, const glm::dvec3& max) {
  Hit hit{-std::numeric_limits<double>::infinity(), 0};
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (origin[axis] <= min[axis] || origin[axis] >= max[axis]) return std::nullopt;
      continue;
    }
    const bool positive = direction[axis] > 0.0;
    const double near = ((positive ? min : max)[axis] - origin[axis]) / direction[axis];
    leave = std::min(leave, ((positive ? max : min)[axis] - origin[axis]) / direction[axis]);
    if (near > hit.t) hit = {near, axis * 2 + (positive ? 1 : 0)};
  }
  if (hit.t < 0.0 || hit.t >= leave) return std::nullopt;
  return hit;
}

/// The first block on a ray's way through one lattice.
struct Finder {
  const glm::dvec3& origin;
  const glm::dvec3& direction;
  double reach;
  std::optional<Pick> found = {};

  bool crossed(const world::Crossing& at) {
    if (at.to == kUnknown) return true;
    if (!pickable(at.to) || world::block_kind(at.to) == world::BlockKind::kPlant) return false;
    found = Pick{0, at.voxel, at.to, at.axis * 2 + (at.positive ? 1 : 0), at.t};
    return true;
  }
  bool inside(IVec3 voxel, BlockId block, double, double) {
    if (block == kUnknown) return true;
    if (world::block_kind(block) != world::BlockKind::kPlant) return false;
    const VoxelBox box = pick_box(block);
    const glm::dvec3 corner{voxel.x, voxel.y, voxel.z};
    const std::optional<Hit> hit = enter_box(origin, direction, corner + box.min, corner + box.max);
    if (!hit || hit->t > reach) return false;
    found = Pick{0, voxel, block, hit->face, hit->t};
    return true;
  }
};

}  // namespace

VoxelBox pick_box(BlockId block) {
  if (block == world::block::kTorch) return {{0.375, 0.0, 0.375}, {0.625, 0.75, 0.625}};
  if (world::block_kind(block) == world::BlockKind::kPlant)
    return {{0.125, 0.0, 0.125}, {0.875, 0.875, 0.875}};
  return {};
}

glm::dvec3 view_direction(double yaw_deg, double pitch_deg) {
  const double yaw = glm::radians(yaw_deg), pitch = glm::radians(pitch_deg);
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

IVec3 beyond_face(IVec3 voxel, int face) {
  const int step = face % 2 == 0 ? 1 : -1;
  (face / 2 == 0 ? voxel.x : face / 2 == 1 ? voxel.y : voxel.z) += step;
  return voxel;
}

std::optional<Pick> pick_block(const Surroundings& around, world::WorldPos eye,
                               const glm::dvec3& direction, double reach, double time_s) {
  std::vector<std::uint64_t> islands;
  around.islands_near(eye, reach, time_s, islands);
  std::optional<Pick> nearest;
  for (const std::uint64_t island : islands) {
    const std::optional<world::Pose> pose = around.pose(island, time_s);
    if (!pose) continue;
    const glm::dquat lattice_from_world = glm::conjugate(pose->rotation);
    const glm::dvec3 origin = lattice_from_world * world::difference_blocks(eye, pose->origin);
    const glm::dvec3 local = lattice_from_world * direction;
    // Later islands need to be nearer; of equals, the one with the lowest id stays.
    const double limit = nearest ? nearest->distance : reach;
    Finder finder{origin, local, limit};
    world::march(NearVoxels(around, island, origin, reach), origin, local, 0.0, limit, finder);
    if (!finder.found || (nearest && finder.found->distance >= nearest->distance)) continue;
    nearest = finder.found;
    nearest->island = island;
  }
  return nearest;
}

}  // namespace skerry::game
