#include "engine/render/light/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <string_view>

namespace skerry::render {
namespace {

/// Cones whose edge is sharper than this are softened to it [difference of cosines].
constexpr float kSharpestCone = 1e-4f;

struct Field {
  std::string_view name;
  float value, least, most;
};

/// NaN lies within no bounds.
std::optional<Error> outside(const Field& field) {
  if (field.value >= field.least && field.value <= field.most) return std::nullopt;
  return Error{fmt::format("cannot place a light with {} {}: give a number from {} to {}",
                           field.name, field.value, field.least, field.most)};
}

template <std::size_t N>
std::optional<Error> first_outside(const std::array<Field, N>& fields) {
  for (const Field& field : fields)
    if (std::optional<Error> error = outside(field)) return error;
  return std::nullopt;
}

bool has_size(std::uint32_t kind) {
  return kind == shared::kLightTube || kind == shared::kLightSphere;
}

bool has_axis(std::uint32_t kind) {
  return kind == shared::kLightSpot || kind == shared::kLightTube ||
         kind == shared::kLightDirectional;
}

std::optional<Error> check_cone(const shared::Light& light) {
  if (std::optional<Error> error =
          first_outside<2>({{{"cos_inner", light.cos_inner, -1.0f, 1.0f},
                             {"cos_outer", light.cos_outer, -1.0f, 1.0f}}}))
    return error;
  if (light.cos_outer <= light.cos_inner) return std::nullopt;
  return Error{
      fmt::format("cannot place a spot light whose cone is reversed (cosines: inner {}, "
                  "outer {}): the outer angle must not be less than the inner one",
                  light.cos_inner, light.cos_outer)};
}

/// Lengthens the axis to 1. @return whether it had a direction.
bool make_unit(glm::vec3& axis) {
  const glm::dvec3 wide(axis);
  const double length = glm::length(wide);
  if (!(length > 0.0) || !std::isfinite(length)) return false;
  axis = glm::vec3(wide / length);
  return true;
}

std::optional<Error> take_spot(shared::Light& light) {
  if (std::optional<Error> error = check_cone(light)) return error;
  if (light.cos_inner - light.cos_outer >= kSharpestCone) return std::nullopt;
  light.cos_inner = std::min(1.0f, light.cos_outer + kSharpestCone);
  light.cos_outer = light.cos_inner - kSharpestCone;
  return std::nullopt;
}

}  // namespace

Result<shared::Light> checked_light(const shared::Light& asked) {
  shared::Light light = asked;
  const std::uint32_t kind = light.kind & shared::kLightKindMask;
  const std::uint32_t bits = light.kind & ~shared::kLightKindMask;
  if (kind >= shared::kLightKindCount ||
      (bits & ~(kind == shared::kLightSpot ? shared::kLightDualBit : 0u)) != 0)
    return Error{
        fmt::format("cannot place a light of kind {:#x}: there is no such kind", light.kind)};
  if (kind == shared::kLightDirectional) light.position = glm::vec3(0.0f);
  if (!has_size(kind)) light.size = 0.0f;
  // The least range: its fourth power and its inverse must be numbers.
  if (std::optional<Error> error = first_outside<8>(
          {{{"position x", light.position.x, -kMaxLightDistance, kMaxLightDistance},
            {"position y", light.position.y, -kMaxLightDistance, kMaxLightDistance},
            {"position z", light.position.z, -kMaxLightDistance, kMaxLightDistance},
            {"range", light.range, 1e-6f, kMaxLightRange},
            {"red intensity", light.intensity.x, 0.0f, kMaxLightIntensity},
            {"green intensity", light.intensity.y, 0.0f, kMaxLightIntensity},
            {"blue intensity", light.intensity.z, 0.0f, kMaxLightIntensity},
            {"size", light.size, 0.0f, kMaxLightSize}}}))
    return *error;
  if (!has_axis(kind))
    light.axis = glm::vec3(0.0f);
  else if (!make_unit(light.axis))
    return Error{fmt::format("cannot place a light with axis ({}, {}, {}): give a direction",
                             asked.axis.x, asked.axis.y, asked.axis.z)};
  if (kind != shared::kLightSpot)
    light.cos_inner = light.cos_outer = 0.0f;
  else if (std::optional<Error> error = take_spot(light))
    return *error;
  return light;
}

}  // namespace skerry::render
