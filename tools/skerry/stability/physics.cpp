// A player at time steps, speeds and times that nobody should need.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/core/jobs.h"
#include "game/player/player.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/place_to_play.h"

namespace skerry::tools::stability {
namespace {

using game::Intent;
using game::kTickSeconds;
using game::MoveMode;
using game::Player;
using world::IVec3;

constexpr double kUnitBlocks = 1.0 / static_cast<double>(world::kUnitsPerBlock);
constexpr std::array kTimeSteps{1e-4, 1e-3, 1.0 / 144.0, 1.0 / 60.0, 0.1, 1.0};
constexpr std::array kSpeeds{1.0, 10.0, 100.0, 1e3, 1e4};
constexpr int kShell = 24;  // inner half width of the room below [blocks]

world::BlockId solid_if(bool solid) {
  return solid ? world::block::kStone : world::block::kAirBlock;
}

/// A closed room whose walls are one block thick.
world::BlockId shell(IVec3 v) {
  const int reach = std::max({std::abs(2 * v.x + 1), std::abs(2 * v.y + 1), std::abs(2 * v.z + 1)});
  return solid_if(reach / 2 == kShell);
}

/// The room with pillars and steps in it, decided by a hash of the voxel.
world::BlockId furnished(IVec3 v) {
  std::uint32_t h = 77;
  for (const int c : {v.x, v.y, v.z})
    h = (h ^ static_cast<std::uint32_t>(c + 1000)) * 2654435761u, h ^= h >> 15;
  const bool inside = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) < kShell;
  return inside ? solid_if(h % 100 < 12) : shell(v);
}

world::BlockId ground(IVec3 v) {
  return solid_if(v.y < 0);
}

double outside_shell(const glm::dvec3& feet) {
  return std::max({std::abs(feet.x), std::abs(feet.y), std::abs(feet.z)}) - kShell;
}

/// Every direction to a face, edge and corner of a cube, as yaw and what to press.
std::vector<std::pair<double, Intent>> directions() {
  std::vector<std::pair<double, Intent>> out;
  for (const double rise : {-1.0, 0.0, 1.0}) {
    for (double yaw = 0.0; yaw < 360.0; yaw += 45.0)
      out.push_back({yaw, {{0.0, 1.0}, rise, false, true}});
    if (rise != 0.0) out.push_back({0.0, {{}, rise, false, true}});
  }
  return out;
}

struct Flights {
  double escaped = 0.0, volume = 0.0;
  double nearest = 1e9;  ///< to a wall that a flight ended [blocks]
};

/// Flies at the walls from the middle for two seconds, in every direction at every speed.
void fly_at_walls(const PlaceToPlay& room, double dt, Flights& found) {
  for (const double speed : kSpeeds) {
    for (const auto& [yaw, intent] : directions()) {
      Player player(room.pose(0, 0.0)->origin, yaw, 0.0, 0.0);
      player.set_mode(MoveMode::kFly);
      player.set_fly_speed(speed);
      for (double t = 0.0; t < 2.0; t += dt) player.advance(dt, intent, room);
      const glm::dvec3 feet = room.lattice(player.feet(), player.tick_time_s());
      found.escaped += outside_shell(feet) > 0.0;
      found.volume = std::max(found.volume, volume_in_solids(room, feet));
      found.nearest = std::min(found.nearest, std::abs(outside_shell(feet)));
    }
  }
}

Result<Rows> tunnelling() {
  Rows rows;
  for (const auto& [spin, drift, name] : {std::tuple{0.0, 0.0, "a resting"},
                                          {0.5, 0.0, "a turning"},
                                          {0.3, 0.7, "a turning, drifting"}}) {
    const PlaceToPlay room({moving(spin, drift), shell});
    Flights found;
    for (const double dt : kTimeSteps) fly_at_walls(room, dt, found);
    const std::string where = std::string(name) + " room, 1-1e4 blocks/s, dt 1e-4-1 s";
    const bool reached = found.nearest < 0.5;
    rows.push_back(
        {"flights through one-block walls, " + where, 0.0, if_shown(reached, found.escaped)});
    rows.push_back(
        {"blocks^3 of players in walls, " + where, 0.0, if_shown(reached, found.volume)});
  }
  return rows;
}

/// Bounces about a furnished room, walking and flying, and looks where that ends after every frame.
Result<Rows> clutter() {
  double volume = 0.0, escaped = 0.0, way = 0.0;
  for (const double spin : {0.0, 0.4}) {
    const PlaceToPlay room({moving(spin, spin), furnished});
    for (const double dt : {1.0 / 144.0, 0.05, 1.0}) {
      Player player(room.pose(0, 0.0)->origin, 0.0, 0.0, 0.0);
      player.advance(2.0 * kTickSeconds, {}, room);  // whoever starts in a pillar is let out of it
      const glm::dvec3 start = room.lattice(player.feet(), player.tick_time_s());
      for (int frame = 0; frame < 600; ++frame) {
        player.set_mode(frame / 60 % 2 == 0 ? MoveMode::kFly : MoveMode::kWalk);
        player.set_fly_speed(kSpeeds[static_cast<std::size_t>(frame / 7) % kSpeeds.size()]);
        player.turn(37.0, 11.0);
        const double rise = frame % 3 - 1;
        player.advance(dt, {{0.3, 1.0}, rise, frame % 5 == 0, frame % 2 == 0}, room);
        const glm::dvec3 feet = room.lattice(player.feet(), player.tick_time_s());
        volume = std::max(volume, volume_in_solids(room, feet));
        escaped += outside_shell(feet) > 0.0;
        way = std::max(way, glm::distance(feet, start));
      }
    }
  }
  const bool moved = way > 4.0;
  return Rows{
      {"volume of a player in solids, random motion in clutter, blocks^3", 0.0,
       if_shown(moved, volume)},
      {"frames outside the closed room, random motion in clutter", 0.0, if_shown(moved, escaped)}};
}

/// Stands for `seconds` and says how far the lattice place moved, and any speed.
struct Rest {
  double moved = 0.0, speed = 0.0, sunk = 0.0;
  bool stood = true;  ///< on ground all the time, which passed
};
Rest stand(double spin, double drift, double seconds) {
  const PlaceToPlay island({moving(spin, drift), ground});
  const world::Pose pose = island.pose(0, 0.0).value();
  const glm::dvec3 place{17.3, 0.4, 1.7};
  Player player(world::moved(pose.origin, pose.rotation * place), 0.0, 0.0, 0.0);
  player.advance(3.0, {}, island);
  const glm::dvec3 before = island.lattice(player.feet(), player.tick_time_s());
  Rest rest;
  for (double t = 0.0; t < seconds; t += 60.0) {
    player.advance(60.0, {}, island);
    const glm::dvec3 now = island.lattice(player.feet(), player.tick_time_s());
    rest.moved = std::max(rest.moved, glm::distance(now, before));
    rest.speed = std::max(rest.speed, glm::length(player.velocity()));
    rest.sunk = std::max(rest.sunk, before.y - now.y);
    rest.stood = rest.stood && player.on_ground() && player.tick_time_s() > t;
  }
  return rest;
}

Result<Rows> standing() {
  constexpr double kWeek = 7.0 * 86400.0;
  // Both places are rounded to whole units on each axis: sqrt(3) half units each.
  const double rounding = std::sqrt(3.0) * kUnitBlocks;
  std::array<Rest, 2> rests;
  Jobs jobs;
  jobs.parallel_for(2, [&rests](int moves) {
    rests[static_cast<std::size_t>(moves)] =
        moves != 0 ? stand(0.01, 0.02, kWeek) : stand(0.0, 0.0, kWeek);
  });
  const auto& [resting, on_moving] = rests;
  return Rows{{"blocks moved, a week (72,576,000 ticks) on a resting island", 0.0,
               if_shown(resting.stood, resting.moved)},
              {"blocks/s after standing a week", 0.0, if_shown(resting.stood, resting.speed)},
              {"blocks moved, a week (72,576,000 ticks) on a turning, drifting island", rounding,
               if_shown(on_moving.stood, on_moving.moved)},
              {"blocks/s after standing on it", 0.0, if_shown(on_moving.stood, on_moving.speed)},
              {"blocks sunk, standing on it", 0.0, if_shown(on_moving.stood, on_moving.sunk)}};
}

/// Kinetic and potential energy a mass in an island's frame [blocks^2/s^2].
double energy(const Player& player, const PlaceToPlay& around) {
  const glm::dvec3 feet = around.lattice(player.feet(), player.tick_time_s());
  return 0.5 * glm::dot(player.velocity(), player.velocity()) + game::kGravity * feet.y;
}

/// Thrown into a furnished room at flying speed, then left alone: sliding, falling and bumping must
/// cost energy or keep it.
Result<Rows> energy_of_the_thrown() {
  const PlaceToPlay room({moving(0.0, 0.0), furnished});
  double gain = 0.0, unrest = 0.0, loss = 0.0;
  for (const double speed : kSpeeds) {
    for (const auto& [yaw, intent] : directions()) {
      Player player(room.pose(0, 0.0)->origin, yaw + 9.0, 0.0, 0.0);
      player.set_mode(MoveMode::kFly);
      player.set_fly_speed(speed);
      player.advance(0.05, intent, room);
      player.set_mode(MoveMode::kWalk);
      double last = energy(player, room);
      for (int tick = 0; tick < 1200; ++tick) {
        player.advance(kTickSeconds, {}, room);
        const double now = energy(player, room);
        gain = std::max(gain, now - last);
        loss = std::max(loss, last - now);
        last = now;
      }
      unrest = std::max(unrest, glm::length(player.velocity()));
    }
  }
  return Rows{
      {"energy gained in a tick by one who was thrown, blocks^2/s^2", 0.0,
       if_shown(loss > 0.0, gain)},
      {"blocks/s ten seconds after being thrown into a room", 0.0, if_shown(loss > 0.0, unrest)}};
}

/// Highest of the feet seen at frames' ends in a jump.
double jump_height(double dt) {
  const PlaceToPlay island({moving(0.0, 0.0), ground});
  Player player(world::moved(island.pose(0, 0.0)->origin, {0.5, 0.1, 0.5}), 0.0, 0.0, 0.0);
  player.advance(1.0, {}, island);
  const double floor_y = island.lattice(player.feet(), 0.0).y;
  double highest = 0.0;
  for (double t = 0.0; t < 0.6; t += dt) {
    player.advance(dt, {{}, 0.0, true, false}, island);
    highest = std::max(highest, island.lattice(player.feet(), 0.0).y - floor_y);
  }
  return highest;
}

Result<Rows> jumps() {
  // From the closed form v^2 / 2g a tick's Euler step takes at most v * tick / 2 + g tick^2 / 8,
  // and frames that do not look at the top miss at most g (dt / 2)^2 / 2 of it, plus a tick's
  // grain.
  constexpr double kExact = game::kJumpSpeed * game::kJumpSpeed / (2.0 * game::kGravity);
  const auto bound = [](double dt) {
    const double grain = dt + kTickSeconds;
    return 0.5 * game::kJumpSpeed * kTickSeconds + game::kGravity * grain * grain / 8.0;
  };
  double above = 0.0, ratio = 0.0;
  for (const double dt : {1e-4, 1e-3, 1.0 / 500.0, 1.0 / 144.0, 1.0 / 60.0, 1.0 / 30.0, 0.1}) {
    const double height = jump_height(dt);
    above = std::max(above, height - kExact);
    ratio = std::max(ratio, (kExact - height) / bound(dt));
  }
  return Rows{
      {"blocks a jump rises above the closed form, dt 1e-4 to 0.1 s", 0.0,
       if_shown(ratio <= 1.0, above)},
      {"lost height of a jump over what ticks and frames may lose, dt 1e-4 to 0.1 s", 1.0, ratio}};
}

/// Stairs of one block each along +z, then a plain.
world::BlockId stairs(IVec3 v) {
  return solid_if(v.y < std::clamp((v.z + 12) / 3, 0, 8));
}

/// Walks up stairs, turning and not, at every time step: where it ends, and what on the way was
/// inside of a step or lifted the eye at a jolt.
Result<Rows> climbing() {
  double missing = 0.0, volume = 0.0, jolt = 0.0;
  for (const double spin : {0.0, 0.3}) {
    for (const double dt : kTimeSteps) {
      const PlaceToPlay island({moving(spin, 0.0), stairs});
      Player player(world::moved(island.pose(0, 0.0)->origin, {0.5, 0.1, -13.5}), 0.0, 0.0, 0.0);
      double eye_y = 0.0;
      for (double t = 0.0; t < 12.0; t += dt) {
        player.advance(dt, {{0.0, t > 1.0 ? 1.0 : 0.0}, 0.0, false, false}, island);
        const glm::dvec3 feet = island.lattice(player.feet(), player.tick_time_s());
        volume = std::max(volume, volume_in_solids(island, feet));
        const double now_y = island.lattice(player.eye(island).position, player.tick_time_s()).y;
        if (dt < 0.01 && t > 1.0) jolt = std::max(jolt, now_y - eye_y);
        eye_y = now_y;
      }
      const double top = island.lattice(player.feet(), player.tick_time_s()).y;
      missing = std::max(missing, 8.0 - top);
    }
  }
  // The eye comes to its height at 14 a second; a whole tick may pass in one short frame, and in it
  // a step of one block is on the way.
  return Rows{
      {"blocks of stairs not climbed in 11 s, dt 1e-4 to 1 s", 0.0, missing},
      {"blocks^3 of a player in stairs, dt 1e-4 to 1 s", 0.0, if_shown(missing <= 0.0, volume)},
      {"blocks the eye jolts upwards in a frame of 1/144 s at most", 14.0 / 60.0,
       if_shown(missing <= 0.0, jolt)}};
}

/// A table of 7 x 7 blocks in the air.
world::BlockId table(IVec3 v) {
  return solid_if(v.y == -1 && std::max(std::abs(v.x), std::abs(v.z)) <= 3);
}

/// Crouches about a table in the air at every time step, as fast as it goes; then falls off, and
/// comes back.
Result<Rows> edges() {
  double falls = 0.0, not_back = 0.0, off_ground = 0.0, way = 0.0;
  for (const double spin : {0.0, 0.5}) {
    for (const double dt : kTimeSteps) {
      const PlaceToPlay island({moving(spin, 0.2), table, 8.0});
      Player player(world::moved(island.pose(0, 0.0)->origin, {0.5, 0.1, 0.5}), 0.0, 0.0, 0.0);
      player.advance(1.0, {}, island);
      Intent crouch{{0.0, 1.0}, 0.0, false, true};
      crouch.crouch = true;
      for (double t = 0.0, turned = 0.0; t < 60.0; t += dt) {
        if (t - turned > 2.5) player.turn(77.0, 0.0), turned = t;
        player.advance(dt, crouch, island);
        falls += !player.on_ground();
        const glm::dvec3 feet = island.lattice(player.feet(), player.tick_time_s());
        way = std::max(way, std::max(std::abs(feet.x), std::abs(feet.z)));
      }
      for (double t = 0.0; t < 30.0 && player.returns() == 0; t += dt)
        player.advance(dt, {{0.0, 1.0}, 0.0, false, true}, island);
      not_back += player.returns() == 0;
      player.advance(2.0, {}, island);
      off_ground += !player.on_ground();
    }
  }
  return Rows{{"frames in the air, crouching about a table for a minute, dt 1e-4 to 1 s", 0.0,
               if_shown(way > 3.0, falls)},
              {"falls off the world that last more than 30 s", 0.0, not_back},
              {"players in the air two seconds after they came back", 0.0,
               if_shown(not_back == 0.0, off_ground)}};
}

/// An island turns under a player by more than a turn a tick; nothing can be right then, but
/// everything must stay finite, and players must not end inside blocks.
Result<Rows> whirl() {
  double non_finite = 0.0, volume = 0.0, way = 0.0;
  for (const double spin : {10.0, 100.0, 1000.0}) {
    const PlaceToPlay island({moving(spin, 1.0), furnished});
    Player player(island.pose(0, 0.0)->origin, 0.0, 0.0, 0.0);
    const world::WorldPos start = player.feet();
    for (int frame = 0; frame < 600; ++frame) {
      player.advance(1.0 / 60.0, {{0.0, 1.0}, 0.0, frame % 40 == 0, false}, island);
      const game::CameraPlace eye = player.eye(island);
      const double sum = glm::length(player.velocity()) + eye.yaw_deg + eye.pitch_deg;
      non_finite += !std::isfinite(sum);
      volume = std::max(
          volume, volume_in_solids(island, island.lattice(player.feet(), player.tick_time_s())));
      way = std::max(way, glm::length(world::difference_blocks(player.feet(), start)));
    }
  }
  return Rows{{"frames with a player that is not finite, island at up to 1000 rad/s", 0.0,
               if_shown(way > 1.0, non_finite)},
              {"volume of a player in solids, island at up to 1000 rad/s, blocks^3", 0.0,
               if_shown(way > 1.0, volume)}};
}

constexpr Case kPhysicsCases[] = {
    {"physics.tunnelling", tunnelling}, {"physics.clutter", clutter},
    {"physics.standing", standing},     {"physics.energy", energy_of_the_thrown},
    {"physics.jumps", jumps},           {"physics.climbing", climbing},
    {"physics.edges", edges},           {"physics.whirl", whirl}};

}  // namespace

std::span<const Case> physics_cases() {
  return kPhysicsCases;
}

}  // namespace skerry::tools::stability
