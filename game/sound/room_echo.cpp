#include "game/sound/room_echo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skerry::game {
namespace {

constexpr double kLeastDecay = 0.1, kMostDecay = 6.0;  // seconds
constexpr double kLeastCosine = 0.05;  // a grazed wall does not make a room boundless

/// Evenly over the sphere (spherical Fibonacci points).
glm::dvec3 ray(int i) {
  constexpr double kGoldenTurn = std::numbers::pi * (3.0 - 2.23606797749978969641);
  const double y = 1.0 - (2.0 * i + 1.0) / kEchoRays;
  const double radius = std::sqrt(1.0 - y * y);
  return {radius * std::cos(kGoldenTurn * i), y, radius * std::sin(kGoldenTurn * i)};
}

}  // namespace

RoomEcho room_echo(const SoundRoom& room, const glm::dvec3& listener) {
  // A ray stands for 4 pi / n of the directions: it sees d^3 / 3 of the volume and d^2 / cos of the
  // surface.
  constexpr double kShare = 4.0 * std::numbers::pi / kEchoRays;
  RoomEcho echo;
  double swallowed = 0.0, sky = 0.0;
  for (int i = 0; i < kEchoRays; ++i) {
    const RayHit hit = first_hit(room, listener, ray(i), kEchoReach);
    const double d = hit.distance;
    const double area = kShare * d * d / std::max(kLeastCosine, hit.cosine);
    echo.volume += kShare * d * d * d / 3.0;
    echo.surface += area;
    swallowed += area * (hit.hit ? absorption_of(hit.block) : 1.0);
    if (!hit.hit) sky += area;
  }
  if (echo.surface <= 0.0) return {};
  echo.open = sky / echo.surface;
  echo.absorption = std::clamp(swallowed / echo.surface, 0.01, 0.99);
  // Eyring: C. F. Eyring, Reverberation Time in "Dead" Rooms, JASA 1930.
  echo.decay_s = std::clamp(0.161 * echo.volume / (-echo.surface * std::log(1.0 - echo.absorption)),
                            kLeastDecay, kMostDecay);
  // The reverberant field of a source of amplitude 1 at a block's distance, 4 sqrt(pi / A), scaled
  // down so that the smallest rooms end at 1.
  const double room_constant = swallowed / (1.0 - echo.absorption);
  echo.level =
      std::min(1.0, 0.35 * 4.0 * std::sqrt(std::numbers::pi / std::max(1.0, room_constant)) *
                        (1.0 - echo.open) * (1.0 - echo.open));
  return echo;
}

}  // namespace skerry::game
