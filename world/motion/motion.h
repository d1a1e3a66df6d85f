#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "world/islands/world.h"
#include "world/motion/shape.h"
#include "world/voxel/motion_state.h"

namespace skerry::world {

/// Fastest that any voxel of a disturbed island moves [blocks/s]. In a tick that is 0.4 blocks, so
/// that two islands, each at its fastest, cannot pass through one another's thinnest walls unseen.
inline constexpr double kMaxIslandSpeed = 24.0;
/// What a helm gives [blocks/s^2, rad/s^2], and what the air takes of any speed [1/s].
inline constexpr double kThrust = 2.0, kTurnThrust = 0.25, kAirDrag = 0.125;

/// Moves the islands that left their course: steered, broken off or hit. All others follow pose_at.
///
/// Fixed ticks; places in fixed point, the rest in doubles by +, -, *, / and square roots, in an
/// order that depends on ids: equal states move equally on every machine, and a state that was
/// saved goes on as if it had not been. Islands are rigid, float, and turn about the vertical only.
/// One that would come to overlap another deeper than it does stays where it is for a tick, and
/// both exchange impulses, which never add energy: nothing passes through anything.
/// docs/decisions/0017-islands-that-bump.md. One thread at a time; World::pose answers all others.
class IslandMotion {
 public:
  /// Hands over the shape of an island, or none yet: till then it stands still, a ball that nothing
  /// enters.
  using Shapes = std::function<std::unique_ptr<Shape>(std::uint64_t island)>;
  /// @param world outlives this. @param shapes none: they are made at once when needed.
  explicit IslandMotion(World& world, Shapes shapes = {});
  ~IslandMotion();
  IslandMotion(const IslandMotion&) = delete;
  IslandMotion& operator=(const IslandMotion&) = delete;

  /// Sets the clock: ticks are those of the world's time.
  void start(double time_s);
  std::int64_t tick() const { return tick_; }

  /// Takes an island from its course, with the speed it has. @return false: no such island is
  /// known.
  bool disturb(std::uint64_t island);
  /// An island that moves already: broken off, or read from a file. Its tick becomes the clock's.
  /// @param shape of it, if that is known already.
  void add(std::uint64_t island, const MotionState& state, std::unique_ptr<Shape> shape = nullptr);
  /// Engines, until said otherwise. @param thrust in the island's axes, length at most 1 counts.
  /// @param turn -1 .. 1 about +y. @return false: no such island is known.
  bool steer(std::uint64_t island, glm::dvec3 thrust, double turn);
  /// Tells that voxels are, or are no longer, solid. What remains of the island moves on as its
  /// voxels did.
  void edited(std::uint64_t island, std::span<const IVec3> voxels, bool solid);
  /// The same for more than is worth naming: the shape is asked for anew.
  void reshape(std::uint64_t island);

  /// One tick. The world receives all poses.
  void step();
  /// Ticks until the world's poses reach a time, kMaxTicks at most; the clock then jumps. It jumps
  /// back, too, if the time is that far behind it.
  void advance_to(double time_s);
  static constexpr std::int64_t kMaxTicks = 30;

  /// From now on every pose that the world receives, with the motion of that tick, is appended to
  /// `moves`, which outlives this. Whoever applies the same to another world, in this order, has
  /// the same poses there at any time.
  void report_to(std::vector<MovingIsland>* moves) { moves_ = moves; }
  /// States of all disturbed islands, ascending ids.
  std::vector<MovingIsland> states() const;
  /// How a place of an island's lattice moves at this tick, on its course or not. None: no such
  /// island is known, or its centre of mass not yet: the shape is on its way.
  struct PointMotion {
    Pose pose;              ///< of the lattice
    glm::dvec3 velocity{};  ///< of the place [blocks/s]
    double spin = 0.0;      ///< rad/s
  };
  std::optional<PointMotion> motion_at(std::uint64_t island, const glm::dvec3& place) const;

  /// Of the last tick.
  struct Counts {
    std::size_t islands = 0, awake = 0, near = 0, touching = 0, held = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  struct Body;
  struct Pair;
  using Bodies = std::map<std::uint64_t, std::unique_ptr<Body>>;
  Body* find(std::uint64_t island);
  std::unique_ptr<Body> body_on_course(const IslandSpec& spec) const;
  void want_shape(Body& body);
  static void drop_shape(Body& body);
  void to_shelf(Body& body);
  std::unique_ptr<Shape> from_shelf(std::uint64_t island);
  void drive(Body& body) const;
  void meet_courses(Body& body);
  std::vector<Pair> near_pairs();
  void hold(std::vector<Pair>& pairs);
  static void stop_at_balls(const std::vector<Pair>& pairs);
  bool leave_courses(std::vector<Pair>& pairs);
  static void exchange_impulses(std::vector<Pair>& pairs);
  void report(Body& body);
  void report_to_world(Body& body, std::int64_t tick, const Pose& pose);

  World& world_;
  Shapes shapes_;
  std::int64_t tick_ = 0;
  Bodies bodies_;   // off their courses
  Bodies courses_;  // on them, near one that is not
  static constexpr std::size_t kShelf = 8;
  std::deque<std::pair<std::uint64_t, std::unique_ptr<Shape>>> shelf_;  // used last in front
  Counts counts_;
  std::vector<MovingIsland>* moves_ = nullptr;
};

}  // namespace skerry::world
