#pragma once
#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <limits>

#include "world/islands/volume.h"

namespace skerry::world {

/// A place where a ray goes from one block to another.
struct Crossing {
  double t;
  BlockId from, to;
  int axis;       ///< of the plane it crosses
  bool positive;  ///< whether it goes towards greater coordinates
  IVec3 voxel;    ///< the one it enters
};

inline int floor_to_int(double x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < truncated ? 1 : 0);
}

/// A ray's way through a box, from where it comes in to where it leaves.
struct RayInBox {
  std::array<double, 3> inverse{};  ///< of the direction
  std::array<bool, 3> positive{};
  double t = 0.0, t_max = 0.0;  ///< it is outside if t >= t_max
  int entered = -1;             ///< axis of the plane it comes in by; -1: it begins inside
};

inline RayInBox ray_in_box(glm::dvec3 origin, glm::dvec3 direction, double t_min, double t_max,
                           const std::array<int, 3>& low, const std::array<int, 3>& high) {
  RayInBox ray;
  ray.t = t_min;
  ray.t_max = t_max;
  for (int a = 0; a < 3; ++a) {
    ray.positive[a] = direction[a] >= 0.0;
    if (direction[a] == 0.0) {
      ray.inverse[a] = std::numeric_limits<double>::infinity();
      if (origin[a] < low[a] || origin[a] >= high[a]) ray.t_max = ray.t;
      continue;
    }
    ray.inverse[a] = 1.0 / direction[a];
    const double first = ((ray.positive[a] ? low[a] : high[a]) - origin[a]) * ray.inverse[a];
    if (first > ray.t) {
      ray.t = first;
      ray.entered = a;
    }
    const double last = ((ray.positive[a] ? high[a] : low[a]) - origin[a]) * ray.inverse[a];
    ray.t_max = std::min(ray.t_max, last);
  }
  return ray;
}

/// Walks a ray through a lattice voxel by voxel (J. Amanatides and A. Woo, A Fast Voxel Traversal
/// Algorithm for Ray Tracing, Eurographics 1987), over empty bricks and chunks at one step. A step
/// goes to a plane of the lattice, so coordinates on the axis it crosses are integers and exact.
/// @param voxels has box_min(), box_max() and cell_at(voxel) -> MarchCell: a Volume, or any other.
/// @param origin, direction in lattice coordinates, any length.
/// @param visit crossed(Crossing) and inside(voxel, id, enters, leaves) for plants, in the ray's
///   order; either returns true to stop. A ray that begins in a block crosses nothing there.
template <class Voxels, class Visitor>
void march(const Voxels& voxels, glm::dvec3 origin, glm::dvec3 direction, double t_min,
           double t_max, Visitor&& visit) {
  // One voxel of air about the box, so that what lies at its walls is entered and left.
  const std::array<int, 3> low{voxels.box_min().x - 1, voxels.box_min().y - 1,
                               voxels.box_min().z - 1};
  const std::array<int, 3> high{voxels.box_max().x + 1, voxels.box_max().y + 1,
                                voxels.box_max().z + 1};
  const RayInBox ray = ray_in_box(origin, direction, t_min, t_max, low, high);
  const auto& [inverse, positive, t_in, t_out, entered_box] = ray;
  double t = t_in;
  int entered = entered_box;  // axis of the plane crossed last
  t_max = t_out;
  if (!(t < t_max)) return;
  std::array<int, 3> v;
  for (int a = 0; a < 3; ++a)
    v[a] = std::clamp(floor_to_int(origin[a] + direction[a] * t), low[a], high[a] - 1);
  if (entered >= 0) v[entered] = positive[entered] ? low[entered] : high[entered] - 1;

  BlockId previous = entered >= 0 ? kAir : voxels.cell_at({v[0], v[1], v[2]}).id;
  while (true) {
    const IVec3 voxel{v[0], v[1], v[2]};
    const auto [size, id] = voxels.cell_at(voxel);
    if (id != previous && visit.crossed({t, previous, id, entered, positive[entered], voxel}))
      return;
    previous = id;

    double next = std::numeric_limits<double>::infinity();
    int axis = 0;
    for (int a = 0; a < 3; ++a) {
      const int cell = v[a] & ~(size - 1);
      const double at = ((positive[a] ? cell + size : cell) - origin[a]) * inverse[a];
      if (at < next) {
        next = at;
        axis = a;
      }
    }
    if (id != kAir && visit.inside(voxel, id, t, next)) return;
    if (next >= t_max) return;
    t = next;
    entered = axis;
    for (int a = 0; a < 3; ++a) {
      const int cell = v[a] & ~(size - 1);
      if (a == axis) {
        v[a] = positive[a] ? cell + size : cell - 1;
      } else if (size > 1) {
        v[a] = std::clamp(floor_to_int(origin[a] + direction[a] * t), cell, cell + size - 1);
      }
    }
  }
}

}  // namespace skerry::world
