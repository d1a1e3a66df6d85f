#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "tools/reference/scene.h"

namespace skerry::reference {

/// A face that a ray meets, turned towards where the ray comes from.
struct Meeting {
  double t = 0.0;  ///< along the ray
  std::size_t island = 0;
  world::BlockId block = world::kAir;
  int face = 0;          ///< docs/conventions.md
  world::IVec3 voxel;    ///< of the block
  glm::dvec3 lattice{};  ///< the point
};

/// What a ray from the eye meets.
struct Trace {
  std::vector<Meeting> layers;  ///< surfaces of water and glass before `hit`, by t
  std::optional<Meeting> hit;   ///< the first opaque or cut-out surface or plant
};

inline constexpr double kFar = std::numeric_limits<double>::infinity();

/// Rays against all islands of a scene. Safe on any thread.
class Tracer {
 public:
  explicit Tracer(const std::vector<Island>& islands);

  /// What is seen along a ray: faces where a block meets one that does not hide it, from the front;
  /// leaves where their texture is, from the front; plants from both sides.
  /// @param direction unit. @param out replaced.
  void trace(glm::dvec3 origin, glm::dvec3 direction, Trace& out) const;
  /// Whether something stands between two points: what casts shadows, that is all but water and
  /// glass. A leaf casts by the faces that see the light.
  /// @param direction unit, towards the light. @param distance to the light.
  /// @param from_plant the plant that the ray begins on, which does not shade itself.
  /// @param lamp the place of the light: the voxels that it is in hide nothing.
  bool hidden(glm::dvec3 origin, glm::dvec3 direction, double distance = kFar,
              const Meeting* from_plant = nullptr, const glm::dvec3* lamp = nullptr) const;
  /// What is left of a lamp's light between two points: 0 where hidden() says so, else what stained
  /// glass on the way leaves. Parameters as hidden() has them.
  glm::dvec3 left_of_lamp(glm::dvec3 origin, glm::dvec3 direction, double distance,
                          const Meeting* from_plant, const glm::dvec3* lamp) const;

  /// Unit normal of a face in the world; a plant's surfaces count as level.
  glm::dvec3 normal(std::size_t island, int face) const;
  glm::dvec3 lattice_vector(std::size_t island, glm::dvec3 world) const;
  glm::dvec3 lattice_point(std::size_t island, glm::dvec3 world) const;
  world::BlockId block_at(std::size_t island, world::IVec3 voxel) const;
  /// Water or glass that a point of the world lies in.
  struct Medium {
    std::size_t island = 0;
    world::BlockId block = world::kAir;
  };
  std::optional<Medium> medium_at(glm::dvec3 point) const;

 private:
  struct Placed {
    std::shared_ptr<const world::Volume> voxels;
    glm::dmat3 rotation, lattice_from_world;
    glm::dvec3 origin;
    glm::dvec3 centre;  // of the box, world
    double radius2;     // of the sphere about it
  };
  static bool may_meet(const Placed& island, glm::dvec3 origin, glm::dvec3 direction,
                       double distance);
  /// Adds the optical depth of stained glass up to what hides. @return whether anything does.
  bool walk_to_light(glm::dvec3 origin, glm::dvec3 direction, double distance,
                     const Meeting* from_plant, const glm::dvec3* lamp, glm::dvec3& glass) const;
  std::vector<Placed> islands_;
};

}  // namespace skerry::reference
