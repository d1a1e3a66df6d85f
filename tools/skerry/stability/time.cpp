// Clocks after longer play than anyone's.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "engine/render/frame/celestial.h"
#include "game/input/controls.h"
#include "tools/skerry/stability/case.h"
#include "world/voxel/island.h"

namespace skerry::tools::stability {
namespace {

using render::Celestial;
using render::celestial_at;

constexpr std::int64_t kDay = 86400;

double difference(const Celestial& a, const Celestial& b) {
  return std::max({glm::distance(a.to_sun, b.to_sun), glm::distance(a.to_moon, b.to_moon),
                   static_cast<double>(glm::distance(a.sun_irradiance, b.sun_irradiance)),
                   static_cast<double>(glm::distance(a.moon_irradiance, b.moon_irradiance)),
                   a.sun_casts != b.sun_casts ? 1.0 : 0.0});
}

/// Seconds of play in 1/4096: a double holds 1e12 of them exactly, and integers their remainder.
Result<Rows> sky_after_long_play() {
  constexpr std::int64_t kFraction = 4096;
  double most = 0.0;
  // A quarter of a day turns the sky by a right angle.
  const bool turns = difference(celestial_at(0.0, 0.3), celestial_at(kDay / 4.0, 0.3)) > 1.0;
  for (std::int64_t i = 0; i < 20000; ++i) {
    const std::int64_t ticks = 1'000'000'000'000 * kFraction + i * 17'716'121;
    for (const std::int64_t time : {ticks, -ticks}) {
      const std::int64_t rest = (time % (kDay * kFraction) + kDay * kFraction) % (kDay * kFraction);
      const auto seconds = [](std::int64_t t) { return static_cast<double>(t) / kFraction; };
      most = std::max(
          most, difference(celestial_at(seconds(time), 0.3), celestial_at(seconds(rest), 0.3)));
    }
  }
  return Rows{
      {"sky after +-1e12 s against the sky at the exact remainder", 0.0, if_shown(turns, most)}};
}

/// The clock that play turns, whole seconds a frame: exact integers tell where it must be.
Result<Rows> clock_after_long_play() {
  double most = 0.0;
  for (const std::int64_t step : {std::int64_t{86399}, std::int64_t{1'000'000'007}}) {
    game::DayClock clock(0);
    std::int64_t exact = 0;
    for (std::int64_t total = 0; total < 1'000'000'000'000; total += step * 5000) {
      for (int i = 0; i < 1000; ++i) {
        clock.turn(static_cast<double>(step));
        exact = (exact + step) % kDay;
        const double off = std::abs(static_cast<double>(clock.time_of_day_s() - exact));
        most = std::max(most, std::min(off, static_cast<double>(kDay) - off));
      }
    }
  }
  // The clock shows whole seconds, and whole seconds are turned.
  return Rows{{"seconds the clock shows wrongly while 1e12 s are turned", 0.0, most}};
}

world::IslandSpec island_that_moves() {
  world::IslandSpec spec;
  spec.origin = {1 << 20, 0, -(1 << 20)};
  spec.yaw_rad = 1.0;
  spec.spin_rad_per_s = 0.01;
  spec.drift_amplitude = {16.0, 4.0, 16.0};
  spec.drift_period_s = 900.0;
  return spec;
}

/// Of two rotations [rad]; a quaternion and its negative are the same rotation.
double angle_between(const glm::dquat& a, const glm::dquat& b) {
  const double apart = std::min(glm::length(a - b), glm::length(a + b));
  return 4.0 * std::asin(0.5 * apart);
}

Result<Rows> islands_after_long_play() {
  // What a step of 1/64 s moves at most: the drift's speed, tau / period on each axis (twice that
  // for the bob), and the turn; then rounding to units, twice.
  constexpr double kStep = 1.0 / 64.0, kTau = 6.283185307179586;
  const world::IslandSpec spec = island_that_moves();
  const double most_drift =
      kTau / spec.drift_period_s * kStep * glm::length(glm::dvec3(16.0, 8.0, 16.0)) +
      2.0 / static_cast<double>(world::kUnitsPerBlock);
  double jump = 0.0, turn = 0.0, length = 0.0;
  for (const double start : {0.0, 1e9, -1e9, 1e12, -1e12}) {
    world::Pose last = world::pose_at(spec, start);
    for (int i = 1; i <= 20000; ++i) {
      const world::Pose now = world::pose_at(spec, start + i * kStep);
      jump = std::max(jump, glm::length(world::difference_blocks(now.origin, last.origin)));
      turn = std::max(turn, angle_between(now.rotation, last.rotation));
      length = std::max(length, std::abs(glm::length(now.rotation) - 1.0));
      last = now;
    }
  }
  return Rows{{"blocks an island jumps in 1/64 s, times up to +-1e12 s", most_drift,
               if_shown(jump > 0.0, jump)},
              // fmod is exact; what remains is the rounding of 1e12 periods, 2^-52 of the angle.
              {"radians an island turns in 1/64 s, at 0.01 rad/s, times up to +-1e12 s",
               0.01 * kStep + 1e-9, if_shown(turn > 0.0, turn)},
              {"error of a rotation's length", std::ldexp(1.0, -51), if_shown(turn > 0.0, length)}};
}

constexpr Case kTimeCases[] = {{"time.sky", sky_after_long_play},
                               {"time.clock", clock_after_long_play},
                               {"time.islands", islands_after_long_play}};

}  // namespace

std::span<const Case> time_cases() {
  return kTimeCases;
}

}  // namespace skerry::tools::stability
