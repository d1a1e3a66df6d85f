#include "engine/render/light/shadow_changes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>

namespace skerry::render {
namespace {

/// Camera-relative ball [blocks].
struct Ball {
  glm::dvec3 middle{};
  double radius = 0.0;
};

glm::dvec3 from_camera(const FixedPos& place, const FixedPos& camera) {
  glm::dvec3 out;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out[i] = static_cast<double>(place[k] - camera[k]) / 65536.0;
  }
  return out;
}

/// Where a box of half extents `half` along `axes` about `middle` can show.
TexelBox texels_of(const Cascade& cascade, const glm::dvec3& middle, const glm::dmat3& axes,
                   const glm::dvec3& half) {
  constexpr double kSpareTexels = 2.0;
  TexelBox box;
  const double size = cascade.key.map_size;
  const double spare =
      kSpareTexels + 1e-5 * glm::length(middle) / static_cast<double>(cascade.texel_blocks);
  for (int i = 0; i < 2; ++i) {
    const glm::dvec4 row = glm::row(glm::dmat4(cascade.clip_from_world), i);
    const glm::dvec3 along(row);
    const double at = 0.5 * size * (glm::dot(along, middle) + row.w + 1.0);
    double reach = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      reach += std::abs(glm::dot(along, axes[axis])) * half[axis];
    reach = 0.5 * size * reach + spare;
    box.low[i] = std::max(0.0, std::floor(at - reach));
    box.high[i] = std::min(size, std::ceil(at + reach));
  }
  return box;
}

/// Whether what lies in a ball may show in a cascade's map. Errs on the side of yes.
bool may_touch(const Ball& ball, const Cascade& cascade) {
  // What rounding and a quarter texel of the island's motion can add.
  const double radius =
      ball.radius + static_cast<double>(cascade.texel_blocks) + 1e-5 * glm::length(ball.middle);
  return std::ranges::all_of(cascade.planes, [&](const glm::vec4& plane) {
    return glm::dot(glm::dvec3(plane), ball.middle) + static_cast<double>(plane.w) >= -radius;
  });
}

Ball ball_of(const IslandPlacement& island, const FixedPos& camera) {
  return {from_camera(island.origin, camera), island.bounding_radius};
}

TexelBox box_of(const IslandPlacement& island, const FixedPos& camera, const Cascade& cascade) {
  const Ball ball = ball_of(island, camera);
  if (!may_touch(ball, cascade)) return {};
  return texels_of(cascade, ball.middle, glm::dmat3(1.0), glm::dvec3(ball.radius));
}

}  // namespace

double movement(const IslandPlacement& a, const IslandPlacement& b) {
  glm::dvec3 shift;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    shift[i] = static_cast<double>(b.origin[k] - a.origin[k]) / 65536.0;
  }
  // A rotation by angle t moves a point at distance r by 2 r sin(t / 2); |q - q'| = 2 sin(t / 4)
  // for the nearer of q' and -q'.
  const glm::dquat same = glm::dot(a.rotation, b.rotation) < 0.0 ? -b.rotation : b.rotation;
  const double quarter = 0.5 * glm::length(a.rotation - same);
  return glm::length(shift) + 4.0 * quarter * std::max(a.bounding_radius, b.bounding_radius);
}

bool may_touch(const IslandPlacement& island, const FixedPos& camera, const Cascade& cascade) {
  return may_touch(ball_of(island, camera), cascade);
}

void TexelBox::add(const TexelBox& other) {
  low = glm::min(low, other.low);
  high = glm::max(high, other.high);
}

VkRect2D TexelBox::rect() const {
  if (empty()) return {};
  const glm::ivec2 first(low), end(high);
  return {
      {first.x, first.y},
      {static_cast<std::uint32_t>(end.x - first.x), static_cast<std::uint32_t>(end.y - first.y)}};
}

TexelBox whole_map(const Cascade& cascade) {
  return {glm::dvec2(0.0), glm::dvec2(cascade.key.map_size)};
}

TexelBox box_of(const shared::Section& section, const IslandPlacement& island,
                const FixedPos& camera, const Cascade& cascade) {
  const auto corner = [&](std::uint32_t packed) {
    const glm::dvec3 voxels(packed & 127, packed >> 7 & 127, packed >> 14 & 127);
    return glm::dvec3(section.origin) +
           std::ldexp(1.0, static_cast<int>(section.voxel_size_log2)) * voxels;
  };
  const glm::dvec3 low = corner(section.bounds_min), high = corner(section.bounds_max);
  const glm::dvec3 half = 0.5 * (high - low);
  const glm::dvec3 middle =
      island.rotation * (0.5 * (low + high)) + from_camera(island.origin, camera);
  if (!may_touch({middle, glm::length(half)}, cascade)) return {};
  return texels_of(cascade, middle, glm::mat3_cast(island.rotation), half);
}

IslandPlacement rebased(IslandPlacement island, const FixedPos& from, const FixedPos& to) {
  for (std::size_t i = 0; i < 3; ++i) island.origin[i] += to[i] - from[i];
  return island;
}

TexelBox moved_islands(DrawnMap& map, const Cascade& cascade, const FrameInput& input,
                       const MovedBy& by) {
  const auto texel = static_cast<double>(cascade.texel_blocks);
  TexelBox box;
  for (std::size_t i = 0; i < input.islands.size(); ++i) {
    const IslandPlacement now = rebased(input.islands[i], input.anchor, map.anchor);
    // What has come of a new island stands among the changes.
    if (i == map.islands.size()) {
      map.islands.push_back(now);
      continue;
    }
    const double moved = movement(map.islands[i], now);
    if (moved <= by.more_than * texel || moved > by.at_most * texel) continue;
    box.add(
        box_of(rebased(map.islands[i], map.anchor, input.anchor), input.camera.position, cascade));
    box.add(box_of(input.islands[i], input.camera.position, cascade));
    map.islands[i] = now;
  }
  return box;
}

std::optional<TexelBox> changed_sections(DrawnMap& map, const Cascade& cascade,
                                         const FrameInput& input, const GeometryChanges& geometry) {
  const auto changed = geometry.since(map.geometry_version);
  if (!changed) return std::nullopt;
  TexelBox box;
  for (const shared::Section& section : *changed) {
    if (section.island >= input.islands.size()) return std::nullopt;
    box.add(box_of(section, input.islands[section.island], input.camera.position, cascade));
  }
  map.geometry_version = geometry.version();
  return box;
}

}  // namespace skerry::render
