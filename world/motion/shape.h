#pragma once
#include <memory>
#include <span>
#include <vector>

#include "world/motion/solid_grid.h"
#include "world/voxel/motion_state.h"

namespace skerry::world {

/// An island's voxels as physics has them.
class Shape {
 public:
  explicit Shape(SolidGrid grid);

  /// Follows edits. @param voxels that now are, or no longer are, solid.
  void edit(std::span<const IVec3> voxels, bool solid);

  const SolidGrid& grid() const { return grid_; }
  const Mass& mass() const { return mass_; }
  /// Of all voxels about the centre of mass [blocks]; edits may leave it a little too large.
  double radius() const { return radius_; }
  std::size_t surface_bricks() const { return surface_.size(); }
  const std::map<IVec3, BitBrick>& surface() const { return surface_; }

 private:
  void fit_radius();

  SolidGrid grid_;
  std::map<IVec3, BitBrick> surface_;  // solid voxels beside one that is not, by brick
  MassSum sum_;
  Mass mass_;
  double radius_ = 0.0;
};

/// Where two islands touch.
struct Contact {
  glm::dvec3 point{};   ///< from the first island's centre of mass, world axes [blocks]
  glm::dvec3 normal{};  ///< from the second towards the first, unit length
  double depth = 0.0;   ///< blocks
};

struct Touch {
  double overlap = 0.0;           ///< sum of all depths; 0: they do not touch
  std::vector<Contact> contacts;  ///< the deepest, deepest first; at most kMaxContacts
  static constexpr std::size_t kMaxContacts = 12;
};

/// Voxel against voxel: a ball about each surface voxel of the one with fewer of them, against the
/// cubes of the other.
Touch touch_of(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

/// Rotation about the vertical.
struct Turn {
  double cosine = 1.0, sine = 0.0;
  static Turn of(const glm::dquat& q) { return {q.w * q.w - q.y * q.y, 2.0 * q.w * q.y}; }
  glm::dvec3 operator()(const glm::dvec3& v) const {
    return {cosine * v.x + sine * v.z, v.y, cosine * v.z - sine * v.x};
  }
  glm::dvec3 back(const glm::dvec3& v) const {
    return {cosine * v.x - sine * v.z, v.y, cosine * v.z + sine * v.x};
  }
};

}  // namespace skerry::world
