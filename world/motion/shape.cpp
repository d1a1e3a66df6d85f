#include "world/motion/shape.h"

#include <algorithm>
#include <cmath>

namespace skerry::world {
namespace {

constexpr int kEdge = BitBrick::kEdge;
// A little less than half a voxel, so that faces that lie on one another do not touch.
constexpr double kBall = 0.45;

glm::dvec3 middle_of(IVec3 v) {
  return {v.x + 0.5, v.y + 0.5, v.z + 0.5};
}

IVec3 floored(const glm::dvec3& p) {
  return {static_cast<std::int32_t>(std::floor(p.x)), static_cast<std::int32_t>(std::floor(p.y)),
          static_cast<std::int32_t>(std::floor(p.z))};
}

/// The way out for a ball whose middle is inside a voxel: towards where there is air.
glm::dvec3 way_out(const SolidGrid& grid, IVec3 v) {
  glm::dvec3 out{};
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sign : {-1, 1}) {
      IVec3 next = v;
      (axis == 0 ? next.x : axis == 1 ? next.y : next.z) += sign;
      if (!grid.at(next)) out[axis] += sign;
    }
  }
  const double length = std::sqrt(glm::dot(out, out));
  return length > 0.0 ? out / length : glm::dvec3{0.0, 1.0, 0.0};
}

/// The deepest that a ball lies in a lattice's cubes.
void press(const SolidGrid& grid, const glm::dvec3& p, glm::dvec3& normal, double& depth) {
  const IVec3 low = floored(p - kBall), high = floored(p + kBall);
  for (std::int32_t y = low.y; y <= high.y; ++y) {
    for (std::int32_t x = low.x; x <= high.x; ++x) {
      for (std::int32_t z = low.z; z <= high.z; ++z) {
        if (!grid.at({x, y, z})) continue;
        const glm::dvec3 nearest{std::clamp(p.x, double{1} * x, x + 1.0),
                                 std::clamp(p.y, double{1} * y, y + 1.0),
                                 std::clamp(p.z, double{1} * z, z + 1.0)};
        const glm::dvec3 away = p - nearest;
        const double distance = std::sqrt(glm::dot(away, away));
        if (kBall - distance <= depth) continue;
        depth = kBall - distance;
        normal = distance > 0.0 ? away / distance : way_out(grid, {x, y, z});
      }
    }
  }
}

/// Whether a place is within some reach of the ball about an island.
bool within(const glm::dvec3& place, const Shape& island, double reach) {
  const glm::dvec3 away = place - island.mass().centre;
  reach += island.radius();
  return glm::dot(away, away) <= reach * reach;
}

/// Half a brick's diagonal and a ball.
constexpr double kBrickReach = 7.5;

bool any_near(const SolidGrid& grid, const glm::dvec3& middle) {
  const IVec3 low = brick_of(floored(middle - kBrickReach));
  const IVec3 high = brick_of(floored(middle + kBrickReach));
  for (std::int32_t y = low.y; y <= high.y; ++y)
    for (std::int32_t x = low.x; x <= high.x; ++x)
      for (std::int32_t z = low.z; z <= high.z; ++z)
        if (const BitBrick* brick = grid.brick({x, y, z}); brick && brick->any()) return true;
  return false;
}

void keep_deepest(std::vector<Contact>& contacts, const Contact& contact) {
  const auto at = std::find_if(contacts.begin(), contacts.end(),
                               [&](const Contact& c) { return c.depth < contact.depth; });
  if (at == contacts.end() && contacts.size() == Touch::kMaxContacts) return;
  contacts.insert(at, contact);
  if (contacts.size() > Touch::kMaxContacts) contacts.pop_back();
}

/// Balls of a against cubes of b; normals point from b to a.
Touch balls_on_cubes(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const Turn turn_a = Turn::of(pose_a.rotation), turn_b = Turn::of(pose_b.rotation);
  const glm::dvec3 shift = turn_b.back(difference_blocks(pose_a.origin, pose_b.origin));
  const auto to_b = [&](const glm::dvec3& p) { return turn_b.back(turn_a(p)) + shift; };
  Touch touch;
  for (const auto& [at, voxels] : a.surface()) {
    const glm::dvec3 corner{double{kEdge} * at.x, double{kEdge} * at.y, double{kEdge} * at.z};
    const glm::dvec3 middle = to_b(corner + 0.5 * kEdge);
    if (!within(middle, b, kBrickReach) || !any_near(b.grid(), middle)) continue;
    for (int y = 0; y < kEdge; ++y) {
      for (std::uint64_t layer = voxels.layers[y]; layer != 0; layer &= layer - 1) {
        const int bit = std::countr_zero(layer);
        const glm::dvec3 place = corner + middle_of({bit / kEdge, y, bit % kEdge});
        const glm::dvec3 there = to_b(place);
        if (!within(there, b, kBall)) continue;
        glm::dvec3 normal{};
        double depth = 0.0;
        press(b.grid(), there, normal, depth);
        if (depth == 0.0) continue;
        touch.overlap += depth;
        keep_deepest(touch.contacts, {turn_a(place - a.mass().centre), turn_b(normal), depth});
      }
    }
  }
  return touch;
}

}  // namespace

Shape::Shape(SolidGrid grid) : grid_(std::move(grid)) {
  for (const IVec3& at : grid_.solid_bricks()) {
    sum_.add(at, *grid_.brick(at), 1);
    const BitBrick voxels = grid_.surface_of(at);
    if (voxels.any()) surface_.emplace_hint(surface_.end(), at, voxels);
  }
  mass_ = sum_.mass();
  fit_radius();
}

void Shape::fit_radius() {
  double most = 0.0;
  for (const auto& [at, voxels] : surface_) {
    for (int y = 0; y < kEdge; ++y) {
      for (std::uint64_t layer = voxels.layers[y]; layer != 0; layer &= layer - 1) {
        const int bit = std::countr_zero(layer);
        const glm::dvec3 away =
            middle_of({at.x * kEdge + bit / kEdge, at.y * kEdge + y, at.z * kEdge + bit % kEdge}) -
            mass_.centre;
        most = std::max(most, glm::dot(away, away));
      }
    }
  }
  // To the voxel's farthest corner.
  radius_ = std::sqrt(most) + 0.87;
}

void Shape::edit(std::span<const IVec3> voxels, bool solid) {
  std::vector<IVec3> touched;
  for (const IVec3& v : voxels) {
    if (!grid_.set(v, solid)) continue;
    BitBrick one;
    one.set(v.x & 7, v.y & 7, v.z & 7, true);
    sum_.add(brick_of(v), one, solid ? 1 : -1);
    for (int i = 0; i < 7; ++i) {
      IVec3 beside = v;
      if (i < 6) (i < 2 ? beside.x : i < 4 ? beside.y : beside.z) += i % 2 == 0 ? 1 : -1;
      touched.push_back(brick_of(beside));
    }
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const IVec3& at : touched) {
    const BitBrick voxels_now = grid_.surface_of(at);
    if (voxels_now.any()) {
      surface_.insert_or_assign(at, voxels_now);
    } else {
      surface_.erase(at);
    }
  }
  mass_ = sum_.mass();
  if (!touched.empty()) fit_radius();
}

Touch touch_of(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (a.surface_bricks() <= b.surface_bricks()) return balls_on_cubes(a, pose_a, b, pose_b);
  Touch touch = balls_on_cubes(b, pose_b, a, pose_a);
  const glm::dvec3 between = difference_blocks(pose_b.origin, pose_a.origin) +
                             Turn::of(pose_b.rotation)(b.mass().centre) -
                             Turn::of(pose_a.rotation)(a.mass().centre);
  for (Contact& contact : touch.contacts) {
    contact.point += between;
    contact.normal = -contact.normal;
  }
  return touch;
}

}  // namespace skerry::world
