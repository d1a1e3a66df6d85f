#include "tools/reference/lights.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "tools/reference/brdf.h"

namespace skerry::reference {
namespace {

constexpr double kCellEdge = 8.0;    // blocks
constexpr double kMaxInCells = 128;  // range of a light that is kept by cells [blocks]

/// Takes light back to 0 at the range, smoothly (B. Karis, Real Shading in Unreal Engine 4, 2013).
double window(double distance, double range) {
  if (!(distance < range)) return 0.0;
  const double share = distance / range, rest = 1.0 - share * share * share * share;
  return rest * rest;
}

/// Share of a spot's intensity that leaves at an angle to its axis: 1 within the inner cone, 0
/// beyond the outer one, between them a smooth step of the cosine.
double cone(const Light& light, glm::dvec3 to_light) {
  const double along = -glm::dot(to_light, light.axis);
  const double cosine = light.dual ? std::abs(along) : along;
  const double t =
      std::clamp((cosine - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// From outside the sphere is a cone of even radiance intensity / (pi r^2); from inside it is all
/// around.
std::optional<LightRay> sample_sphere(const Light& light, glm::dvec3 to_middle, double distance,
                                      Sampler& sampler) {
  const glm::dvec2 pair = sampler.next();
  const double sine = std::min(1.0, light.size / distance);
  const bool inside = distance <= light.size;
  const double spread = inside ? 2.0 : sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
  LightRay ray;
  ray.to_light = Frame(to_middle / distance).world(in_cone(pair, spread));
  const double along = glm::dot(to_middle, ray.to_light);
  const double half2 = light.size * light.size - (distance * distance - along * along);
  ray.distance = inside ? 0.0 : along - std::sqrt(std::max(0.0, half2));
  ray.irradiance = light.intensity * (2.0 * spread / (light.size * light.size));
  return ray;
}

/// The light of one point, which is what a tube's points and other kinds are.
std::optional<LightRay> from_point(const Light& light, glm::dvec3 to_point) {
  const double distance = glm::length(to_point);
  if (distance == 0.0) return std::nullopt;
  return LightRay{to_point / distance, distance, light.intensity / (distance * distance)};
}

}  // namespace

Light light_from(const shared::Light& light) {
  Light out;
  out.kind = light.kind & shared::kLightKindMask;
  out.position = light.position;
  out.intensity = light.intensity;
  out.size = light.size;
  out.range = light.range;
  out.axis = light.axis;
  out.cos_inner = light.cos_inner;
  out.cos_outer = light.cos_outer;
  out.dual = (light.kind & shared::kLightDualBit) != 0;
  return out;
}

std::optional<LightRay> sample_light(const Light& light, glm::dvec3 point, Sampler& sampler) {
  if (light.kind == shared::kLightDirectional)
    return LightRay{-light.axis, light.range, light.intensity};
  const glm::dvec3 to_middle = light.position - point;
  const double distance = glm::length(to_middle), windowed = window(distance, light.range);
  if (windowed == 0.0) return std::nullopt;
  std::optional<LightRay> ray;
  if (light.kind == shared::kLightTube) {
    const double at = (2.0 * sampler.next().x - 1.0) * light.size;
    ray = from_point(light, to_middle + light.axis * at);
  } else if (light.kind == shared::kLightSphere && light.size > 0.0 && distance > 0.0) {
    ray = sample_sphere(light, to_middle, distance, sampler);
  } else {
    ray = from_point(light, to_middle);
  }
  if (!ray) return std::nullopt;
  ray->irradiance *= windowed;
  if (light.kind == shared::kLightSpot) ray->irradiance *= cone(light, ray->to_light);
  return ray->irradiance == glm::dvec3(0.0) ? std::nullopt : ray;
}

LightGrid::LightGrid(std::span<const Light> lights) : lights_(lights) {
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    if (light.kind == shared::kLightDirectional || !(light.range <= kMaxInCells)) {
      everywhere_.push_back(i);
      continue;
    }
    const glm::ivec3 first = cell_of(light.position - light.range),
                     last = cell_of(light.position + light.range);
    for (glm::ivec3 c{0, first.y, 0}; c.y <= last.y; ++c.y) {
      for (c.x = first.x; c.x <= last.x; ++c.x) {
        for (c.z = first.z; c.z <= last.z; ++c.z) {
          const glm::dvec3 low = glm::dvec3(c) * kCellEdge;
          const glm::dvec3 away = light.position - glm::clamp(light.position, low, low + kCellEdge);
          if (glm::dot(away, away) < light.range * light.range) cells_[key_of(c)].push_back(i);
        }
      }
    }
  }
}

glm::ivec3 LightGrid::cell_of(glm::dvec3 point) {
  constexpr double kMost = 1 << 20;  // what is farther shares the outermost cells
  return glm::ivec3(glm::clamp(glm::floor(point / kCellEdge), -kMost, kMost - 1.0));
}

std::uint64_t LightGrid::key_of(glm::ivec3 cell) {
  const auto part = [](int c) { return std::uint64_t{static_cast<std::uint32_t>(c) & 0x1fffff}; };
  return part(cell.x) << 42 | part(cell.y) << 21 | part(cell.z);
}

}  // namespace skerry::reference
