// What IslandMotion keeps of an island. Private to world/motion*.cpp.
#pragma once
#include <cmath>
#include <optional>
#include <vector>

#include "world/motion/motion.h"

namespace skerry::world {

struct IslandMotion::Body {
  std::uint64_t id = 0;
  MotionState now;               // at the clock's tick
  Pose next;                     // where it goes unless it is held
  std::unique_ptr<Shape> shape;  // none yet: a ball
  double ball_radius = 0.0;      // blocks, about the lattice's origin
  glm::dvec3 thrust{};           // island's axes
  double turn = 0.0;
  bool on_course = false;  // follows pose_at: never held, weighs without end
  bool held = false;
  bool waits = false;              // MovingIsland::waits, of this tick
  bool wanted = false;             // of courses: near a disturbed island in this tick
  bool reported = false;           // the world has its pose of the last tick
  std::int64_t reported_tick = 0;  // when it was reported last, and what
  bool reported_waits = false;
  glm::dvec3 reported_velocity{};
  double reported_spin = 0.0;
  std::optional<WorldPos> looked_from;        // where islands near by were last looked for
  std::vector<std::uint64_t> course_islands;  // found then

  bool driven() const { return thrust != glm::dvec3{} || turn != 0.0; }
  bool awake() const { return driven() || now.velocity != glm::dvec3{} || now.spin != 0.0; }
  glm::dvec3 centre() const { return shape ? shape->mass().centre : glm::dvec3{}; }
  double radius() const { return shape ? shape->radius() : ball_radius; }
  /// Of the centre of mass.
  WorldPos place(const Pose& pose) const {
    return moved(pose.origin, Turn::of(pose.rotation)(centre()));
  }
  const Pose& pose() const { return held ? now.pose : next; }
  double inverse_mass() const {
    return on_course || !shape || shape->mass().blocks == 0
               ? 0.0
               : 1.0 / static_cast<double>(shape->mass().blocks);
  }
  double inverse_inertia() const {
    return on_course || !shape || shape->mass().blocks == 0 ? 0.0 : 1.0 / shape->mass().inertia;
  }
};

/// Two islands that may touch.
struct IslandMotion::Pair {
  Body *a, *b;           // ascending ids
  Touch touch;           // what bars their way, or is left of an older overlap
  glm::dvec3 between{};  // from b's centre of mass to a's, where they touch so
  double before = -1.0;  // overlap at the last tick; negative: not known
  int state = -1;        // which of the two were held when last looked at
};

/// A pose after a time in which the centre of mass moves straight and the island turns evenly.
Pose moved_pose(const Pose& from, const glm::dvec3& centre, const glm::dvec3& velocity, double spin,
                double seconds);

}  // namespace skerry::world
