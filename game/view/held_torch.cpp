#include "game/view/held_torch.h"

#include <cmath>
#include <glm/trigonometric.hpp>

#include "world/voxel/hash.h"

namespace skerry::game {
namespace {

constexpr double kSlowRate = 5.0, kFastRate = 11.0;  // changes a second
constexpr double kSlowShare = 2.0 / 3.0;             // of the amplitude

constexpr double kRight = 0.2, kDown = 0.35, kForward = 0.18;  // of the hand from the eye [blocks]

/// Value noise: -1 .. 1 at whole numbers, smooth between.
double noise(std::uint64_t seed, double x) {
  const double cell = std::floor(x);
  const auto at = [seed](std::int64_t i) {
    const std::uint64_t hash = world::mix64(seed ^ static_cast<std::uint64_t>(i));
    return static_cast<double>(hash >> 11) * 0x1p-52 - 1.0;
  };
  const double t = x - cell, blend = t * t * (3.0 - 2.0 * t);
  const auto i = static_cast<std::int64_t>(cell);
  return (1.0 - blend) * at(i) + blend * at(i + 1);
}

}  // namespace

double torch_flicker(double time_s) {
  const double slow = noise(0x9e3779b97f4a7c15u, time_s * kSlowRate);
  const double fast = noise(0xd1b54a32d192ed03u, time_s * kFastRate);
  return 1.0 + kTorchFlicker * (kSlowShare * slow + (1.0 - kSlowShare) * fast);
}

shared::Light held_torch(const BlockEmission& torch, double yaw_deg, double time_s) {
  const double yaw = glm::radians(yaw_deg);
  const glm::dvec3 forward{std::sin(yaw), 0.0, std::cos(yaw)}, right{-forward.z, 0.0, forward.x};
  shared::Light light{};
  light.kind = shared::kLightPoint;
  light.position = right * kRight + forward * kForward - glm::dvec3(0.0, kDown, 0.0);
  light.range = light_range(torch.face_intensity);
  light.intensity = torch.face_intensity * static_cast<float>(torch_flicker(time_s));
  return light;
}

}  // namespace skerry::game
