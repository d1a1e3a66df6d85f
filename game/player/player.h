#pragma once
#include <cstdint>
#include <deque>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "game/player/camera_place.h"
#include "game/player/collide.h"
#include "game/player/player_state.h"
#include "world/voxel/blocks.h"
#include "world/voxel/coords.h"
#include "world/voxel/island.h"

namespace skerry::game {

/// What a player can stand on and bump into. All answers must depend on the arguments alone while a
/// tick runs.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// Ids of the islands whose bounding spheres come within `radius_blocks` of a place at a time, in
  /// ascending order. `out` is replaced.
  virtual void islands_near(world::WorldPos place, double radius_blocks, double time_s,
                            std::vector<std::uint64_t>& out) const = 0;
  /// None: there is no such island any more.
  virtual std::optional<world::Pose> pose(std::uint64_t island, double time_s) const = 0;
  /// None: not generated yet. Someone walking is held there, someone flying is not.
  virtual std::optional<world::BlockId> block(std::uint64_t island, world::IVec3 voxel) const = 0;
};

/// What the person wants during a tick.
struct Intent {
  glm::dvec2 move{};    ///< x to the right, y forward; length at most 1 counts
  double rise = 0.0;    ///< flying: -1 down .. 1 up
  bool jump = false;    ///< walking: jump; in water: swim up
  bool fast = false;    ///< sprint, or five times the flying speed
  bool crouch = false;  ///< walking: slow, and never over an edge
};

enum class MoveMode : std::uint8_t {
  kWalk,
  kFly,
  kNoclip,  ///< flying that no solid stops
};

/// Ticks a second; every length of frame runs the same ticks, so motion does not depend on the
/// frame rate.
inline constexpr int kTicksPerSecond = 120;
inline constexpr double kTickSeconds = 1.0 / kTicksPerSecond;
inline constexpr double kGravity = 25.0;  ///< blocks/s^2; brisker than nature's, as jumps want
/// Blocks/s at take-off: rises to kJumpSpeed^2 / (2 kGravity) = 1.25 blocks.
inline constexpr double kJumpSpeed = 7.9;
inline constexpr double kEyeHeight = 1.62;   ///< blocks above the feet
inline constexpr double kCrouchDepth = 0.3;  ///< blocks that the eye of someone who crouches lowers
inline constexpr double kMinFlySpeed = 1.0, kMaxFlySpeed = 10000.0;  ///< blocks/s

/// Whoever walks off the world comes back to firm ground after falling so far with nothing near
/// [blocks], or after falling so far whatever is near.
inline constexpr double kLostDepth = 96.0, kDeepestFall = 512.0;
inline constexpr double kRescueRadius = 64.0;  ///< blocks; what counts as near then
inline constexpr double kReturnFade = 0.8;     ///< seconds in which the view comes back

/// A walking, swimming or flying person. Someone who touched an island stays in its frame (turning
/// and drifting with it) until touching another or leaving its neighbourhood; the place is then
/// kept in lattice units, else in exact world units. Whoever walks steps up ledges of one block;
/// the eye follows smoothly. Whoever falls off the world comes back to ground that held them.
class Player {
 public:
  /// @param feet where the middle of the soles is. @param time_s the world's time at which that
  /// holds.
  Player(world::WorldPos feet, double yaw_deg, double pitch_deg, double time_s);

  /// As it was saved, at the world's time of then.
  Player(const PlayerState& state, double time_s);
  /// After the last tick.
  PlayerState state() const;
  /// Where they come back to if no ground that they stood on is left.
  void set_home(const Footing& home) { home_ = home; }
  /// Comes to rest on ground, walking. @return false: nothing carries them there; they stay.
  bool stand_on(const Footing& ground, const Surroundings& around);
  /// Comes to rest in the air, flying.
  void fly_to(world::WorldPos feet, const Surroundings& around);

  /// Turns the head at once. Pitch stays within +-90.
  void turn(double yaw_deg, double pitch_deg);
  void set_mode(MoveMode mode) { mode_ = mode; }
  MoveMode mode() const { return mode_; }
  /// Flying speed [blocks/s], clamped to kMinFlySpeed .. kMaxFlySpeed.
  void set_fly_speed(double speed);
  double fly_speed() const { return fly_speed_; }

  /// Advances by `seconds` of frame time: as many whole ticks as are due, the rest is kept for the
  /// next call.
  void advance(double seconds, const Intent& intent, const Surroundings& around);

  /// Place and view between the last two ticks, at the time world_time_s(). That lags by up to a
  /// tick, and so never has to guess.
  CameraPlace eye(const Surroundings& around) const;
  /// Time of the world to draw together with eye().
  double world_time_s() const;

  world::WorldPos feet() const { return now_.feet; }  ///< after the last tick
  double tick_time_s() const { return time_of(ticks_); }
  bool on_ground() const { return on_ground_; }
  bool in_water() const { return in_water_; }
  bool crouching() const { return crouching_; }
  std::optional<std::uint64_t> frame_island() const { return now_.island; }
  /// How often they fell off the world and came back so far.
  int returns() const { return returns_; }
  /// How much of the view is still hidden after the last return: 1 at that moment, soon 0.
  double return_fade() const;
  /// Relative to the frame's island, in its lattice axes; without one, in world axes [blocks/s].
  glm::dvec3 velocity() const { return velocity_; }

 private:
  /// A place in a frame. With an island, `lattice` and the yaw relative to it are what counts, and
  /// `feet` follows from the island's pose.
  struct Place {
    world::WorldPos feet;
    std::optional<std::uint64_t> island;
    LatticePos lattice{0};
    double yaw_deg = 0.0;
    double eye_lag = 0.0;  // blocks that the eye is below its height, after a step or crouching
  };
  /// An island during one tick.
  struct Mover {
    std::uint64_t island = 0;
    world::Pose from, to;
    /// How fast the island carries a point of its lattice along, in the world [blocks/s].
    glm::dvec3 carry(const LatticePos& lattice) const;
  };

  double time_of(std::uint64_t ticks) const {
    return start_s_ + static_cast<double>(ticks) * kTickSeconds;
  }
  void tick(const Intent& intent, const Surroundings& around);
  void find_movers(const Surroundings& around);
  const Mover* mover_of(std::optional<std::uint64_t> island) const;
  void leave_lost_frame(const Surroundings& around);
  void leave_solids(const Surroundings& around);
  void update_velocity(const Intent& intent);
  Place wanted_place(const Surroundings& around);
  void collide_all(const Surroundings& around, Place& target);
  /// Stops `target` at the mover's voxels. @return whether anything was in the way.
  bool collide(const Surroundings& around, const Mover& mover, Place& target, bool only_if_inside);
  SolidQuery solid_query(const Surroundings& around, std::uint64_t island,
                         bool hold_at_unknown) const;
  void look_for_water(const Surroundings& around);
  void lower_eye();
  void note_safe_ground(const Surroundings& around);
  bool is_lost(const Surroundings& around) const;
  bool stand_on(const Footing& ground, const Surroundings& around, Place& place) const;
  Place away_from_frame(const Surroundings& around) const;
  void come_to_rest(const Place& place);
  void come_back(const Surroundings& around);

  Place before_, now_;
  glm::dvec3 velocity_{};
  double pitch_deg_ = 0.0;
  double fly_speed_ = 12.0;
  MoveMode mode_ = MoveMode::kWalk;
  bool on_ground_ = false;
  bool in_water_ = false;
  bool crouching_ = false;
  // During a tick: whether they step up what is in the way, and how far that lifted them [blocks].
  bool climbing_ = false;
  double risen_ = 0.0;
  world::WorldPos start_feet_;
  std::optional<Footing> home_;
  std::deque<Footing> safe_;      // newest last
  std::int64_t fall_from_y_ = 0;  // of the feet in the world, when they last had a hold
  std::uint64_t returned_tick_ = 0;
  int returns_ = 0;
  double start_s_ = 0.0;
  std::uint64_t ticks_ = 0;
  double owed_s_ = 0.0;  // frame time not yet turned into ticks, 0 .. kTickSeconds
  std::vector<std::uint64_t> near_;
  std::vector<Mover> movers_;
};

}  // namespace skerry::game
