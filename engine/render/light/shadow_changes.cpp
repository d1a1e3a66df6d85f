#include "engine/render/light/shadow_changes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <iterator>
#include <utility>

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
/// @param spare texels: a quarter of one for the island's motion, and more.
bool may_touch(const Ball& ball, const Cascade& cascade, double spare = 1.0) {
  // What rounding can add, too.
  const double radius = ball.radius + spare * static_cast<double>(cascade.texel_blocks) +
                        1e-5 * glm::length(ball.middle);
  return std::ranges::all_of(cascade.planes, [&](const glm::vec4& plane) {
    return glm::dot(glm::dvec3(plane), ball.middle) + static_cast<double>(plane.w) >= -radius;
  });
}

Ball ball_of(const IslandPlacement& island, const FixedPos& camera) {
  return {from_camera(island.origin, camera), island.bounding_radius};
}

TexelBox box_of(const Ball& ball, const Cascade& cascade) {
  if (!may_touch(ball, cascade)) return {};
  return texels_of(cascade, ball.middle, glm::dmat3(1.0), glm::dvec3(ball.radius));
}

DrawnIsland drawn(std::size_t index, const IslandPlacement& island) {
  return {static_cast<std::uint32_t>(index), island.origin, island.rotation,
          island.bounding_radius};
}

/// Whether an island is to be listed in a map (DrawnMap::islands).
bool is_listed(const IslandPlacement& island, const FixedPos& camera, const Cascade& cascade) {
  constexpr double kSpareTexels = 2.0;
  return may_touch(ball_of(island, camera), cascade, kSpareTexels);
}

/// Whether another island has come in the place of the last frame's.
bool is_other(const ShadowHistory& last, std::size_t index, const DrawnIsland& now,
              const FixedPos& anchor, double at_most) {
  if (!last.islands || index >= last.islands->size()) return true;
  IslandPlacement before = (*last.islands)[index];
  before.origin = rebased(before.origin, last.anchor, anchor);
  return movement(before, now) > at_most;
}

}  // namespace

std::shared_ptr<const std::vector<DrawnIsland>> islands_in(const Cascade& cascade,
                                                           const FrameInput& input) {
  std::vector<DrawnIsland> out;
  for (std::size_t i = 0; i < input.islands.size(); ++i)
    if (is_listed(input.islands[i], input.camera.position, cascade))
      out.push_back(drawn(i, input.islands[i]));
  return std::make_shared<const std::vector<DrawnIsland>>(std::move(out));
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

FixedPos rebased(FixedPos origin, const FixedPos& from, const FixedPos& to) {
  for (std::size_t i = 0; i < 3; ++i) origin[i] += to[i] - from[i];
  return origin;
}

TexelBox moved_islands(DrawnMap& map, const Cascade& cascade, const FrameInput& input,
                       const ShadowHistory& last, const MovedBy& by) {
  const auto texel = static_cast<double>(cascade.texel_blocks);
  const FixedPos& camera = input.camera.position;
  TexelBox box;
  std::vector<DrawnIsland> noted;  // ascending
  auto listed = map.islands->begin();
  for (std::size_t i = 0; i < input.islands.size(); ++i) {
    const IslandPlacement& island = input.islands[i];
    const bool known = listed != map.islands->end() && listed->index == i;
    if (!known && !is_listed(island, camera, cascade)) continue;
    DrawnIsland now = drawn(i, island);
    now.origin = rebased(now.origin, input.anchor, map.anchor);
    if (!known) {
      // What has come of a new island stands among the changes.
      const bool is_new =
          i >= map.island_count || is_other(last, i, now, map.anchor, by.at_most * texel);
      if (!is_new) box.add(box_of(ball_of(island, camera), cascade));
      noted.push_back(now);
      continue;
    }
    const DrawnIsland& then = *listed++;
    const double moved = movement(then, now);
    if (moved <= by.more_than * texel || moved > by.at_most * texel) continue;
    const FixedPos from = rebased(then.origin, map.anchor, input.anchor);
    box.add(box_of({from_camera(from, camera), then.bounding_radius}, cascade));
    box.add(box_of(ball_of(island, camera), cascade));
    noted.push_back(now);
  }
  map.island_count = static_cast<std::uint32_t>(input.islands.size());
  if (noted.empty()) return box;
  // Of what both list, that of the first.
  std::vector<DrawnIsland> all;
  all.reserve(map.islands->size() + noted.size());
  std::ranges::set_union(noted, *map.islands, std::back_inserter(all), {}, &DrawnIsland::index,
                         &DrawnIsland::index);
  map.islands = std::make_shared<const std::vector<DrawnIsland>>(std::move(all));
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
