#include "world/voxel/island.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

/// Fraction of a period that has passed, in (-1, 1). fmod is exact, so a long time costs no
/// accuracy beyond its own.
double turns(double time_s, double period_s) {
  return std::fmod(time_s, period_s) / period_s;
}

}  // namespace

bool include(IslandSpec& spec, IVec3 voxel) {
  const IVec3 low = spec.box_min, high = spec.box_max;
  spec.box_min = {std::min(low.x, voxel.x), std::min(low.y, voxel.y), std::min(low.z, voxel.z)};
  spec.box_max = {std::max(high.x, voxel.x + 1), std::max(high.y, voxel.y + 1),
                  std::max(high.z, voxel.z + 1)};
  return spec.box_min != low || spec.box_max != high;
}

double radius_of(const IslandSpec& spec) {
  const auto reach = [](double low, double high) {
    return std::max(std::abs(low), std::abs(high));
  };
  const glm::dvec3 corner{reach(spec.box_min.x, spec.box_max.x),
                          reach(spec.box_min.y, spec.box_max.y),
                          reach(spec.box_min.z, spec.box_max.z)};
  return std::sqrt(glm::dot(corner, corner));
}

Pose pose_at(const IslandSpec& spec, double time_s) {
  double yaw = spec.yaw_rad;
  if (spec.spin_rad_per_s != 0.0) yaw += kTau * turns(time_s, kTau / spec.spin_rad_per_s);
  const double phase = spec.drift_phase_rad + kTau * turns(time_s, spec.drift_period_s);
  // An ellipse seen from above, with a slower bob at twice the rate: closed, smooth, and within the
  // amplitude box.
  const glm::dvec3 drift =
      spec.drift_amplitude * glm::dvec3{std::cos(phase), std::sin(2.0 * phase), std::sin(phase)};
  return {moved(spec.origin, drift),
          glm::dquat{std::cos(0.5 * yaw), 0.0, std::sin(0.5 * yaw), 0.0}};
}

std::uint64_t seed_from_text(std::string_view text) {
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc{} && stop == end && !text.empty()) return number;
  std::uint64_t hash =
      0xcbf29ce484222325u;  // FNV-1a, then a finaliser because short texts leave its high bits poor
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return mix64(hash);
}

}  // namespace skerry::world
