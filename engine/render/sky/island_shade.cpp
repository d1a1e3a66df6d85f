#include "engine/render/sky/island_shade.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace skerry::render {
namespace {

/// Sizes as radius over distance, between which an island comes to count.
constexpr float kUnseenSize = 0.06f, kSeenSize = 0.12f;
/// The same of islands that are shaded, from the eye.
constexpr float kUnshadedSize = 0.03f, kShadedSize = 0.06f;
/// Squares of how far a ray passes the middle of a ball of radius 1: all and nothing is hidden.
constexpr float kInnerEdge = 0.75f, kOuterEdge = 1.25f;
/// Squares of distances from the middle: places within an ellipsoid are not hidden by it.
constexpr float kWithin = 1.0f, kOutside = 1.4f;

/// Places of an island's land: one in each octant, where the ellipsoid's surface is.
glm::vec3 place_of(const IslandLand& land, std::size_t octant) {
  const glm::vec3 side(octant & 1 ? -1.0f : 1.0f, octant & 2 ? -1.0f : 1.0f,
                       octant & 4 ? -1.0f : 1.0f);
  return land.centre + land.half * side * glm::vec3(0.5f, 0.707f, 0.5f);
}

glm::vec3 difference_blocks(const FixedPos& to, const FixedPos& from) {
  glm::vec3 out;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out[i] = static_cast<float>(static_cast<double>(to[k] - from[k]) / 65536.0);
  }
  return out;
}

float longest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// Of IslandShade::Near.
std::uint32_t bit_of(std::size_t hiding) {
  return 1u << std::min(hiding, std::size_t{31});
}

bool has_land(const IslandPlacement& island) {
  return !island.far && island.land.half != glm::vec3(0.0f);
}

}  // namespace

std::vector<HidingIsland> islands_that_hide(std::span<const IslandPlacement> islands) {
  std::vector<HidingIsland> out;
  for (std::size_t i = 0; i < islands.size(); ++i)
    if (const IslandLand& land = islands[i].land; has_land(islands[i]))
      out.push_back({i, longest(land.half) / kUnseenSize + glm::length(land.centre)});
  return out;
}

float share_of_shade(const IslandPlacement& island, const FixedPos& eye) {
  if (!has_land(island)) return 0.0f;
  const float radius = longest(island.land.half),
              distance = glm::length(difference_blocks(island.origin, eye));
  return glm::smoothstep(kUnshadedSize, kShadedSize, radius / std::max(distance, radius));
}

IslandShade::IslandShade(std::span<const IslandPlacement> islands,
                         std::span<const HidingIsland> hiding, std::size_t island, float share) {
  const IslandPlacement& here = islands[island];
  if (!has_land(here) || share == 0.0f) return;
  const glm::mat3 rotation(glm::mat3_cast(here.rotation));
  const float own_radius = longest(here.land.half), own_offset = glm::length(here.land.centre);
  const glm::vec3 own_middle = rotation * here.land.centre;
  for (const auto& [i, reach] : hiding) {
    if (i == island) continue;
    const IslandPlacement& other = islands[i];
    const glm::vec3 between(difference_blocks(other.origin, here.origin));
    // Most are too far off, however they are turned.
    const float most = reach + own_offset;
    if (glm::dot(between, between) > most * most) continue;
    const glm::mat3 other_rotation(glm::mat3_cast(other.rotation));
    const glm::vec3 way = between + other_rotation * other.land.centre - own_middle;
    const float distance = glm::length(way), radius = longest(other.land.half);
    const float size =
        share * glm::smoothstep(kUnseenSize, kSeenSize, radius / std::max(distance, radius));
    if (size == 0.0f) continue;
    Hiding& h = hiding_.emplace_back();
    const glm::mat3 scale(1.0f / other.land.half.x, 0, 0, 0, 1.0f / other.land.half.y, 0, 0, 0,
                          1.0f / other.land.half.z);
    h.ball_from_world = scale * glm::transpose(other_rotation);
    for (std::size_t p = 0; p < kPlaces; ++p) {
      const glm::vec3 place = h.ball_from_world * (rotation * place_of(here.land, p) - between) -
                              scale * other.land.centre;
      h.x[p] = place.x, h.y[p] = place.y, h.z[p] = place.z;
      h.distance2[p] = glm::dot(place, place);
      h.weight[p] = size * glm::smoothstep(kWithin, kOutside, h.distance2[p]);
    }
    h.to_middle = way / std::max(distance, 1e-6f);
    // Seen from any place of this island.
    const float sine = (radius * std::sqrt(kOuterEdge) + own_radius) / std::max(distance, 1e-6f);
    h.cosine = sine < 1.0f ? std::sqrt(1.0f - sine * sine) : -1.0f;
  }
}

IslandShade::Near IslandShade::near(const Directions& d) const {
  Near out{};
  for (std::size_t k = 0; k < hiding_.size(); ++k) {
    const Hiding& h = hiding_[k];
    const std::uint32_t bit = bit_of(k);
    for (std::size_t i = 0; i < kDirections; ++i) {
      const float cosine = d.x[i] * h.to_middle.x + d.y[i] * h.to_middle.y + d.z[i] * h.to_middle.z;
      out[i] |= cosine < h.cosine ? 0u : bit;
    }
  }
  return out;
}

// Places side by side, without branches, for vectors of them.
std::optional<IslandShade::Open> IslandShade::towards(const glm::vec3& direction,
                                                      std::uint32_t near) const {
  std::array<float, kPlaces> open;
  open.fill(1.0f);
  bool some = false;
  for (std::size_t k = 0; k < hiding_.size(); ++k) {
    const Hiding& h = hiding_[k];
    if ((near & bit_of(k)) == 0 || glm::dot(direction, h.to_middle) < h.cosine) continue;
    some = true;
    const glm::vec3 ray = h.ball_from_world * direction;
    const float per_length2 = 1.0f / glm::dot(ray, ray);
    for (std::size_t p = 0; p < kPlaces; ++p) {
      const float along = std::max(0.0f, -(h.x[p] * ray.x + h.y[p] * ray.y + h.z[p] * ray.z));
      const float beside2 = h.distance2[p] - along * along * per_length2;
      const float out = std::clamp((beside2 - kInnerEdge) / (kOuterEdge - kInnerEdge), 0.0f, 1.0f);
      const float hidden = along > 0.0f ? 1.0f - out * out * (3.0f - 2.0f * out) : 0.0f;
      open[p] *= 1.0f - h.weight[p] * hidden;
    }
  }
  if (!some) return std::nullopt;
  Open out;
  out.face.fill(0.0f);
  out.all = 0.0f;
  for (std::size_t p = 0; p < kPlaces; ++p) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      out.face[2 * axis + (p >> axis & 1)] += open[p] / 4.0f;
    out.all += open[p] / 8.0f;
  }
  if (out.all == 1.0f) return std::nullopt;
  return out;
}

}  // namespace skerry::render
