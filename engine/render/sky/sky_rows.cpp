#include "engine/render/sky/sky_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

namespace skerry::render {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

using Directions = std::array<glm::dvec3, std::size_t{SkyRows::kRows} * SkyRows::kAzimuths>;

std::size_t index_of(int row, int azimuth) {
  return static_cast<std::size_t>(row * SkyRows::kAzimuths + azimuth);
}

Directions make_directions() {
  Directions out;
  for (int row = 0; row < SkyRows::kRows; ++row) {
    const double y = (2.0 * row + 1.0) / SkyRows::kRows - 1.0, flat = std::sqrt(1.0 - y * y);
    for (int azimuth = 0; azimuth < SkyRows::kAzimuths; ++azimuth) {
      const double turn = kTau * azimuth / SkyRows::kAzimuths;
      out[index_of(row, azimuth)] = {flat * std::cos(turn), y, flat * std::sin(turn)};
    }
  }
  return out;
}

}  // namespace

SkyRows::SkyRows(const std::function<glm::dvec3(const glm::dvec3&)>& radiance) {
  for (int row = 0; row < kRows; ++row)
    for (int k = 0; k < kAzimuths; ++k)
      texels_[index_of(row, k)] = glm::vec3(radiance(direction(row, k)));
}

const glm::dvec3& SkyRows::direction(int row, int azimuth) {
  static const Directions kDirections = make_directions();
  return kDirections[index_of(row, azimuth)];
}

glm::vec3 SkyRows::towards(const glm::vec3& d) const {
  const float v = std::clamp(0.5f * kRows * (d.y + 1.0f) - 0.5f, 0.0f, kRows - 1.0f);
  const float turns = std::atan2(d.z, d.x) / static_cast<float>(kTau) * kAzimuths;
  const float below = std::floor(turns);
  const int row = std::min(static_cast<int>(v), kRows - 2);
  const int k = static_cast<int>(below) & (kAzimuths - 1), next = (k + 1) & (kAzimuths - 1);
  const float fu = turns - below, fv = v - static_cast<float>(row);
  return glm::mix(glm::mix(at(row, k), at(row, next), fu),
                  glm::mix(at(row + 1, k), at(row + 1, next), fu), fv);
}

}  // namespace skerry::render
