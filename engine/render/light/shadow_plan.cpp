#include "engine/render/light/shadow_plan.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/render/frame/frame_choices.h"

namespace skerry::render {
namespace {

/// How far a point of the island can have moved against the anchor between two placements [blocks],
/// at most.
double movement(const IslandPlacement& a, const FixedPos& anchor_a, const IslandPlacement& b,
                const FixedPos& anchor_b) {
  glm::dvec3 shift;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    shift[i] =
        static_cast<double>((b.origin[k] - anchor_b[k]) - (a.origin[k] - anchor_a[k])) / 65536.0;
  }
  // A rotation by angle t moves a point at distance r by 2 r sin(t / 2); |q - q'| = 2 sin(t / 4)
  // for the nearer of q' and -q'.
  const glm::dquat same = glm::dot(a.rotation, b.rotation) < 0.0 ? -b.rotation : b.rotation;
  const double quarter = 0.5 * glm::length(a.rotation - same);
  return glm::length(shift) + 4.0 * quarter * std::max(a.bounding_radius, b.bounding_radius);
}

/// Whether a section may show in a cascade's map. Errs on the side of yes.
bool may_touch(const shared::Section& section, const IslandPlacement& island,
               const FixedPos& camera, const Cascade& cascade) {
  const auto corner = [&](std::uint32_t packed) {
    const glm::dvec3 voxels(packed & 127, packed >> 7 & 127, packed >> 14 & 127);
    return glm::dvec3(section.origin) +
           std::ldexp(1.0, static_cast<int>(section.voxel_size_log2)) * voxels;
  };
  const glm::dvec3 low = corner(section.bounds_min), high = corner(section.bounds_max);
  glm::dvec3 middle = island.rotation * (0.5 * (low + high));
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    middle[i] += static_cast<double>(island.origin[k] - camera[k]) / 65536.0;
  }
  // What rounding and a quarter texel of the island's motion can add.
  const double slack = static_cast<double>(cascade.texel_blocks) + 1e-5 * glm::length(middle);
  const double radius = 0.5 * glm::length(high - low) + slack;
  return std::ranges::all_of(cascade.planes, [&](const glm::vec4& plane) {
    return glm::dot(glm::dvec3(plane), middle) + static_cast<double>(plane.w) >= -radius;
  });
}

/// Casters further than this above a cascade are flattened onto the map's near side by depth
/// clamping, so nothing is lost.
double caster_reach(const FrameInput& input) {
  return 2.0 * input.reach_blocks + 512.0;
}

/// Whether a kept map shows what `cascade` asks for. Notes, in `kept`, changes that do not touch
/// it.
bool still_right(ShadowHistory::Kept& kept, const Cascade& cascade, const FrameInput& input,
                 const GeometryChanges& geometry) {
  if (!kept.valid || kept.key != cascade.key || kept.islands.size() != input.islands.size())
    return false;
  for (std::size_t i = 0; i < input.islands.size(); ++i)
    if (movement(kept.islands[i], kept.anchor, input.islands[i], input.anchor) >
        0.25 * static_cast<double>(cascade.texel_blocks))
      return false;
  const auto changed = geometry.since(kept.geometry_version);
  if (!changed) return false;
  for (const shared::Section& section : *changed)
    if (section.island >= input.islands.size() ||
        may_touch(section, input.islands[section.island], input.camera.position, cascade))
      return false;
  kept.geometry_version = geometry.version();
  return true;
}

CascadeInput cascade_input(const FrameInput& input, const RenderSettings& settings, int body) {
  CascadeInput in;
  in.to_light = body == 0 ? input.sky.to_sun : input.sky.to_moon;
  in.camera = input.camera.position;
  in.anchor = input.anchor;
  in.near_blocks = 1.0;
  in.far_blocks = input.reach_blocks;
  in.caster_reach_blocks = caster_reach(input);
  in.filter_blocks = 2.0 * static_cast<double>(shadow_blur(input, settings)) +
                     8.0 * input.reach_blocks / settings.shadow_size;
  in.map_size = settings.shadow_size;
  in.count = settings.shadow_cascades;
  in.split = settings.shadow_split;
  return in;
}

ShadowLayout layout_of(const FrameInput& input, const RenderSettings& settings) {
  ShadowLayout out;
  out.casting = {settings.shadow_enabled && input.sky.sun_casts,
                 settings.shadow_enabled && input.sky.moon_casts};
  const auto bodies = static_cast<std::uint32_t>(out.casting[0]) + (out.casting[1] ? 1u : 0u);
  out.layers = bodies * static_cast<std::uint32_t>(settings.shadow_cascades);
  if (out.layers != 0) out.edge = static_cast<std::uint32_t>(settings.shadow_size);
  return out;
}

}  // namespace

ShadowPlan plan_shadows(const FrameInput& input, const RenderSettings& settings,
                        const GeometryChanges& geometry, const ShadowHistory& history,
                        std::uint64_t generation) {
  ShadowPlan plan;
  plan.layout = layout_of(input, settings);
  plan.next.layout = plan.layout;
  // Maps of another array, or of one that has been made anew since, show nothing of use.
  if (history.layout == plan.layout && history.generation == generation)
    plan.next.kept = history.kept;
  std::uint32_t layer = 0;
  for (int body = 0; body < 2; ++body) {
    if (!plan.layout.casting[static_cast<std::size_t>(body)]) continue;
    int index = 0;
    for (const Cascade& cascade : make_cascades(cascade_input(input, settings, body))) {
      ShadowHistory::Kept& kept = plan.next.kept[layer];
      const bool redraw = !still_right(kept, cascade, input, geometry);
      if (redraw)
        kept = {true,
                cascade.key,
                geometry.version(),
                {input.islands.begin(), input.islands.end()},
                input.anchor};
      plan.cascades.push_back({body, index++, layer++, redraw, cascade});
    }
  }
  return plan;
}

}  // namespace skerry::render
