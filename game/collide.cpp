#include "game/collide.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace skerry::game {
namespace {

/// Longest step along any axis [blocks]: less than a voxel, so that a diagonal path cannot skip a
/// corner.
constexpr double kMaxStep = 0.5;

struct Box {
  glm::dvec3 min, max;
};

Box box_at(const glm::dvec3& feet) {
  return {{feet.x - kPlayerHalfWidth, feet.y, feet.z - kPlayerHalfWidth},
          {feet.x + kPlayerHalfWidth, feet.y + kPlayerHeight, feet.z + kPlayerHalfWidth}};
}

int lower_voxel(double edge) {
  return static_cast<int>(std::floor(edge));
}
/// The last voxel an open interval ending at `edge` reaches into.
int upper_voxel(double edge) {
  return static_cast<int>(std::ceil(edge)) - 1;
}

world::IVec3 voxel_of(const glm::ivec3& v) {
  return {v.x, v.y, v.z};
}

/// Whether any voxel of the layer `at` along `axis` is solid where the box covers the other two
/// axes.
bool layer_blocks(const SolidQuery& solid, const Box& box, int axis, int at) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  glm::ivec3 voxel{0};
  voxel[axis] = at;
  for (voxel[u] = lower_voxel(box.min[u]); voxel[u] <= upper_voxel(box.max[u]); ++voxel[u]) {
    for (voxel[v] = lower_voxel(box.min[v]); voxel[v] <= upper_voxel(box.max[v]); ++voxel[v]) {
      if (solid(voxel_of(voxel))) return true;
    }
  }
  return false;
}

/// Moves along one axis. @return whether a solid stopped it.
bool step_axis(const SolidQuery& solid, glm::dvec3& feet, int axis, double distance) {
  const Box box = box_at(feet);
  if (distance > 0.0) {
    const double front = box.max[axis] + distance + kContactGap;
    for (int layer = upper_voxel(box.max[axis]) + 1; layer <= upper_voxel(front); ++layer) {
      if (!layer_blocks(solid, box, axis, layer)) continue;
      // Written from integers, here and below, so that a box at rest stays at the very same number.
      feet[axis] = layer - kContactGap - (axis == 1 ? kPlayerHeight : kPlayerHalfWidth);
      return true;
    }
  } else if (distance < 0.0) {
    const double front = box.min[axis] + distance - kContactGap;
    for (int layer = lower_voxel(box.min[axis]) - 1; layer >= lower_voxel(front); --layer) {
      if (!layer_blocks(solid, box, axis, layer)) continue;
      feet[axis] = layer + 1 + kContactGap + (axis == 1 ? 0.0 : kPlayerHalfWidth);
      return true;
    }
  }
  feet[axis] += distance;
  return false;
}

}  // namespace

bool box_overlaps(const SolidQuery& solid, const glm::dvec3& feet) {
  const Box box = box_at(feet);
  for (int layer = lower_voxel(box.min.y); layer <= upper_voxel(box.max.y); ++layer) {
    if (layer_blocks(solid, box, 1, layer)) return true;
  }
  return false;
}

SweepResult sweep_box(const SolidQuery& solid, const glm::dvec3& feet, const glm::dvec3& motion) {
  SweepResult result{feet, glm::ivec3(0)};
  const double longest = std::max({std::abs(motion.x), std::abs(motion.y), std::abs(motion.z)});
  const int steps = std::max(1, static_cast<int>(std::ceil(longest / kMaxStep)));
  for (int step = 0; step < steps; ++step) {
    for (const int axis : {1, 0, 2}) {
      if (result.blocked[axis] != 0) continue;
      if (step_axis(solid, result.feet, axis, motion[axis] / steps)) {
        result.blocked[axis] = motion[axis] > 0.0 ? 1 : -1;
      }
    }
  }
  return result;
}

bool push_out(const SolidQuery& solid, glm::dvec3& feet, int max_rise) {
  const Box box = box_at(feet);
  glm::dvec3 best = feet;
  double best_distance = 2.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int beyond = 0; beyond < 2; ++beyond) {
      glm::dvec3 up = feet, down = feet;
      up[axis] += std::floor(box.min[axis]) + 1.0 + beyond + kContactGap - box.min[axis];
      down[axis] += std::ceil(box.max[axis]) - 1.0 - beyond - kContactGap - box.max[axis];
      for (const glm::dvec3& candidate : {up, down}) {
        const double distance = glm::distance(candidate, feet);
        if (distance >= best_distance || box_overlaps(solid, candidate)) continue;
        best = candidate;
        best_distance = distance;
      }
    }
  }
  for (int rise = 2; best_distance == 2.0 && rise <= max_rise; ++rise) {
    const glm::dvec3 candidate{feet.x, std::floor(feet.y) + rise + kContactGap, feet.z};
    if (!box_overlaps(solid, candidate)) {
      best = candidate;
      break;
    }
  }
  const bool found = best != feet;
  feet = best;
  return found;
}

}  // namespace skerry::game
