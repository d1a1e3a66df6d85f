// Lights besides sun and moon, by their definitions: docs/lights.md.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "shaders/shared/light.h"
#include "tools/reference/sampler.h"

namespace skerry::reference {

/// A light that is not seen itself and casts no shadow. Lengths in blocks, relative to the camera.
struct Light {
  std::uint32_t kind = shared::kLightPoint;  ///< shared::kLight...
  glm::dvec3 position{0.0};
  glm::dvec3 intensity{0.0};  ///< irradiance at distance d, facing it, is intensity / d^2
  double size = 0.0;          ///< radius of a sphere, half the length of a tube
  double range = std::numeric_limits<double>::infinity();  ///< from `position` on: no light
  glm::dvec3 axis{0.0, -1.0, 0.0};                         ///< unit
  double cos_inner = 1.0, cos_outer = 0.0;                 ///< of a spot's cone
  bool dual = false;                                       ///< a spot, to both sides
};

Light light_from(const shared::Light& light);

/// Light that comes from one point of a light.
struct LightRay {
  glm::dvec3 to_light;    ///< unit
  double distance = 0.0;  ///< blocks; of a directional light, how far it may be blocked
  glm::dvec3 irradiance;  ///< of a surface facing that point
};

/// What arrives at `point` if nothing stands between, by one point of the light chosen at random,
/// so that the mean over samples is the light's. None: nothing arrives. Tubes and spheres draw one
/// pair, others none.
std::optional<LightRay> sample_light(const Light& light, glm::dvec3 point, Sampler& sampler);

/// Finds the lights that may reach a point: those whose range touches its cell of space.
class LightGrid {
 public:
  explicit LightGrid(std::span<const Light> lights);
  /// Calls take(light) for each, in an order that depends on the cell alone.
  template <class Take>
  void reaching(glm::dvec3 point, Take&& take) const {
    for (const std::uint32_t i : everywhere_) take(lights_[i]);
    const auto cell = cells_.find(key_of(cell_of(point)));
    if (cell == cells_.end()) return;
    for (const std::uint32_t i : cell->second) take(lights_[i]);
  }

 private:
  static glm::ivec3 cell_of(glm::dvec3 point);
  static std::uint64_t key_of(glm::ivec3 cell);

  std::span<const Light> lights_;
  std::vector<std::uint32_t> everywhere_;  // without a range, or with too long a one
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace skerry::reference
