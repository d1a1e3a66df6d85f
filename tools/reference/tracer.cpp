#include "tools/reference/tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "tools/reference/textures.h"
#include "world/islands/march.h"

namespace skerry::reference {
namespace {

using world::BlockId;
using world::BlockKind;
using world::IVec3;

/// Face of a block that a ray crosses from outside.
int face_met(int axis, bool positive) {
  return axis * 2 + (positive ? 1 : 0);
}

IVec3 voxel_at(glm::dvec3 lattice) {
  return {world::floor_to_int(lattice.x), world::floor_to_int(lattice.y),
          world::floor_to_int(lattice.z)};
}

struct PlantMeeting {
  double t;
  int face;
  glm::dvec3 point;
};

/// The nearest covered point of a plant's two diagonals with t in (0, t_max).
std::optional<PlantMeeting> meet_plant(glm::dvec3 origin, glm::dvec3 direction, IVec3 voxel,
                                       BlockId id, double t_max) {
  const glm::dvec3 corner(voxel.x, voxel.y, voxel.z);
  const glm::dvec3 o = origin - corner;
  std::optional<PlantMeeting> nearest;
  for (const int face : {6, 7}) {
    // Planes x = z and x = 1 - z of the unit cube.
    const double side = face == 6 ? -1.0 : 1.0, offset = face == 6 ? 0.0 : 1.0;
    const double speed = direction.x + side * direction.z;
    if (speed == 0.0) continue;
    const double t = (offset - (o.x + side * o.z)) / speed;
    if (!(t > 0.0 && t < t_max)) continue;
    const glm::dvec3 p = o + direction * t;
    if (p.x < 0.0 || p.x > 1.0 || p.y < 0.0 || p.y > 1.0) continue;
    if (nearest && nearest->t <= t) continue;
    if (BlockTexels::shared().covers(id, face, p)) nearest = {t, face, p + corner};
  }
  return nearest;
}

/// Meets what is drawn, from the eye.
struct Seeing {
  glm::dvec3 origin, direction;
  double t_max;
  std::size_t island;
  Trace& out;

  Meeting meeting(const world::Crossing& c, BlockId block, IVec3 voxel) const {
    return {c.t, island, block, face_met(c.axis, c.positive), voxel, origin + direction * c.t};
  }
  bool crossed(const world::Crossing& c) {
    const BlockKind from = world::block_kind(c.from), to = world::block_kind(c.to);
    if (from == BlockKind::kOpaque) return false;  // seen from inside: nothing is drawn there
    if (to == BlockKind::kOpaque || to == BlockKind::kCutout) {
      const Meeting met = meeting(c, c.to, c.voxel);
      if (to == BlockKind::kOpaque || BlockTexels::shared().covers(c.to, met.face, met.lattice)) {
        out.hit = met;
        return true;
      }
    }
    // Where water meets glass there is one surface: that of the block entered.
    if (to == BlockKind::kTranslucent) {
      out.layers.push_back(meeting(c, c.to, c.voxel));
    } else if (from == BlockKind::kTranslucent) {
      IVec3 left = c.voxel;
      (c.axis == 0 ? left.x : c.axis == 1 ? left.y : left.z) -= c.positive ? 1 : -1;
      out.layers.push_back(meeting(c, c.from, left));
    }
    return false;
  }
  bool inside(IVec3 voxel, BlockId id, double, double) {
    if (world::block_kind(id) != BlockKind::kPlant) return false;
    const auto met = meet_plant(origin, direction, voxel, id, t_max);
    if (met) out.hit = Meeting{met->t, island, id, met->face, voxel, met->point};
    return met.has_value();
  }
};

/// Meets what casts shadows, walking towards the light.
struct Shadowing {
  glm::dvec3 origin, direction;
  double t_max;
  std::optional<IVec3> own_plant, lamp;
  bool in_lamp = false;
  bool hidden = false;
  glm::dvec3 glass{0.0};  // optical depth of stained glass

  bool crossed(const world::Crossing& c) {
    const BlockKind from = world::block_kind(c.from), to = world::block_kind(c.to);
    hidden = (to == BlockKind::kOpaque && lamp != c.voxel) ||
             (from == BlockKind::kCutout &&
              BlockTexels::shared().covers(c.from, face_met(c.axis, !c.positive),
                                           origin + direction * c.t));
    return hidden;
  }
  bool inside(IVec3 voxel, BlockId id, double enters, double leaves) {
    const BlockKind kind = world::block_kind(id);
    if (world::is_stained_glass(id)) {
      const world::BlockType& type = world::block_types()[id];
      const double length = std::min(leaves, t_max) - enters;
      for (int c = 0; c < 3; ++c)
        glass[c] += length * (static_cast<double>(type.absorption[static_cast<std::size_t>(c)]) +
                              static_cast<double>(type.scattering));
    }
    hidden = kind == BlockKind::kPlant && own_plant != voxel && lamp != voxel &&
             meet_plant(origin, direction, voxel, id, t_max).has_value();
    // Between two blocks of one id nothing is crossed.
    if (kind == BlockKind::kOpaque && in_lamp && lamp != voxel) hidden = true;
    in_lamp = lamp == voxel;
    return hidden;
  }
};

}  // namespace

Tracer::Tracer(const std::vector<Island>& islands) {
  for (const Island& island : islands) {
    const IVec3 low = island.voxels->box_min(), high = island.voxels->box_max();
    const glm::dvec3 a(low.x, low.y, low.z), b(high.x, high.y, high.z);
    const double radius = 0.5 * glm::length(b - a) + 2.0;  // with the voxel of air about it
    islands_.push_back({island.voxels, island.rotation, glm::transpose(island.rotation),
                        island.origin, island.rotation * (0.5 * (a + b)) + island.origin,
                        radius * radius});
  }
}

bool Tracer::may_meet(const Placed& island, glm::dvec3 origin, glm::dvec3 direction,
                      double distance) {
  const glm::dvec3 to = island.centre - origin;
  const double along = glm::dot(to, direction), distance2 = glm::dot(to, to);
  if (distance2 <= island.radius2) return true;
  if (along < 0.0) return false;
  const double half2 = island.radius2 - (distance2 - along * along);
  return half2 >= 0.0 && along - std::sqrt(half2) < distance;
}

void Tracer::trace(glm::dvec3 origin, glm::dvec3 direction, Trace& out) const {
  out.layers.clear();
  std::optional<Meeting> nearest;
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    const Placed& island = islands_[i];
    const double t_max = nearest ? nearest->t : kFar;
    if (!may_meet(island, origin, direction, t_max)) continue;
    out.hit.reset();
    Seeing seeing{lattice_point(i, origin), lattice_vector(i, direction), t_max, i, out};
    world::march(*island.voxels, seeing.origin, seeing.direction, 0.0, t_max, seeing);
    if (out.hit) nearest = out.hit;
  }
  out.hit = nearest;
  if (nearest)
    std::erase_if(out.layers, [&](const Meeting& layer) { return layer.t >= nearest->t; });
  std::stable_sort(out.layers.begin(), out.layers.end(),
                   [](const Meeting& a, const Meeting& b) { return a.t < b.t; });
}

bool Tracer::hidden(glm::dvec3 origin, glm::dvec3 direction, double distance,
                    const Meeting* from_plant, const glm::dvec3* lamp) const {
  glm::dvec3 glass(0.0);
  return walk_to_light(origin, direction, distance, from_plant, lamp, glass);
}

glm::dvec3 Tracer::left_of_lamp(glm::dvec3 origin, glm::dvec3 direction, double distance,
                                const Meeting* from_plant, const glm::dvec3* lamp) const {
  glm::dvec3 glass(0.0);
  if (walk_to_light(origin, direction, distance, from_plant, lamp, glass)) return glm::dvec3(0.0);
  return {std::exp(-glass.x), std::exp(-glass.y), std::exp(-glass.z)};
}

bool Tracer::walk_to_light(glm::dvec3 origin, glm::dvec3 direction, double distance,
                           const Meeting* from_plant, const glm::dvec3* lamp,
                           glm::dvec3& glass) const {
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    if (!may_meet(islands_[i], origin, direction, distance)) continue;
    Shadowing shadowing{lattice_point(i, origin), lattice_vector(i, direction), distance, {}, {}};
    if (from_plant && from_plant->island == i) shadowing.own_plant = from_plant->voxel;
    if (lamp) shadowing.lamp = voxel_at(lattice_point(i, *lamp));
    world::march(*islands_[i].voxels, shadowing.origin, shadowing.direction, 0.0, distance,
                 shadowing);
    if (shadowing.hidden) return true;
    glass += shadowing.glass;
  }
  return false;
}

glm::dvec3 Tracer::normal(std::size_t island, int face) const {
  const int axis = axis_of_face(face);
  if (axis == 3) return islands_[island].rotation[1];
  return islands_[island].rotation[axis] * (face % 2 == 0 ? 1.0 : -1.0);
}

glm::dvec3 Tracer::lattice_vector(std::size_t island, glm::dvec3 world) const {
  return islands_[island].lattice_from_world * world;
}

glm::dvec3 Tracer::lattice_point(std::size_t island, glm::dvec3 world) const {
  return islands_[island].lattice_from_world * (world - islands_[island].origin);
}

world::BlockId Tracer::block_at(std::size_t island, IVec3 voxel) const {
  return islands_[island].voxels->block_at(voxel);
}

std::optional<Tracer::Medium> Tracer::medium_at(glm::dvec3 point) const {
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    const glm::dvec3 from_centre = point - islands_[i].centre;
    if (glm::dot(from_centre, from_centre) > islands_[i].radius2) continue;
    const BlockId block = block_at(i, voxel_at(lattice_point(i, point)));
    if (world::block_kind(block) == BlockKind::kTranslucent) return Medium{i, block};
  }
  return std::nullopt;
}

}  // namespace skerry::reference
