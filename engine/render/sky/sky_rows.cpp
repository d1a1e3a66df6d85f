#include "engine/render/sky/sky_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

namespace skerry::render {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

using Directions = std::array<SkyRows::Row, SkyRows::kRows>;

Directions make_directions() {
  Directions out;
  for (int row = 0; row < SkyRows::kRows; ++row) {
    const double y = (2.0 * row + 1.0) / SkyRows::kRows - 1.0, flat = std::sqrt(1.0 - y * y);
    for (int azimuth = 0; azimuth < SkyRows::kAzimuths; ++azimuth) {
      const double turn = kTau * azimuth / SkyRows::kAzimuths;
      out[static_cast<std::size_t>(row)][static_cast<std::size_t>(azimuth)] = {
          flat * std::cos(turn), y, flat * std::sin(turn)};
    }
  }
  return out;
}

}  // namespace

SkyRows::SkyRows(const std::function<Row(const Row&)>& radiance) {
  glm::vec3* texel = texels_.data();
  for (int row = 0; row < kRows; ++row)
    for (const glm::dvec3& one : radiance(directions(row))) *texel++ = glm::vec3(one);
}

const SkyRows::Row& SkyRows::directions(int row) {
  static const Directions kDirections = make_directions();
  return kDirections[static_cast<std::size_t>(row)];
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
