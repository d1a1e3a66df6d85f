#include "engine/render/light/shadow_plan.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <limits>
#include <optional>

#include "engine/render/frame/frame_choices.h"

namespace skerry::render {
namespace {

constexpr double kMovedTexels = 0.25;  // of what a kept map shows, at most

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

/// Texels of a map, [low, high) along each axis.
struct TexelBox {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x < high.x && low.y < high.y); }
  /// Adds where a box of half extents `half` along `axes` about `middle` can show. Errs on the side
  /// of more: by what rounding, the growth of edges and a quarter texel of motion come to.
  void add(const Cascade& cascade, const glm::dvec3& middle, const glm::dmat3& axes,
           const glm::dvec3& half) {
    constexpr double kSpareTexels = 2.0;
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
      low[i] = std::min(low[i], std::max(0.0, std::floor(at - reach)));
      high[i] = std::max(high[i], std::min(size, std::ceil(at + reach)));
    }
  }
};

/// Whether what lies in a ball may show in a cascade's map. Errs on the side of yes.
bool may_touch(const Ball& ball, const Cascade& cascade) {
  // What rounding and a quarter texel of the island's motion can add.
  const double radius =
      ball.radius + static_cast<double>(cascade.texel_blocks) + 1e-5 * glm::length(ball.middle);
  return std::ranges::all_of(cascade.planes, [&](const glm::vec4& plane) {
    return glm::dot(glm::dvec3(plane), ball.middle) + static_cast<double>(plane.w) >= -radius;
  });
}

/// Adds the texels that a section may show in.
void add_section(TexelBox& box, const shared::Section& section, const IslandPlacement& island,
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
  if (may_touch({middle, glm::length(half)}, cascade))
    box.add(cascade, middle, glm::mat3_cast(island.rotation), half);
}

/// Adds the texels that an island may show in.
void add_island(TexelBox& box, const IslandPlacement& island, const FixedPos& camera,
                const Cascade& cascade) {
  const Ball ball{from_camera(island.origin, camera), island.bounding_radius};
  if (may_touch(ball, cascade))
    box.add(cascade, ball.middle, glm::dmat3(1.0), glm::dvec3(ball.radius));
}

/// Casters further than this above a cascade are flattened onto the map's near side by depth
/// clamping, so nothing is lost.
double caster_reach(const FrameInput& input) {
  return 2.0 * input.reach_blocks + 512.0;
}

/// The texels in which a kept map does not show what `cascade` asks for; none if it is of no use.
/// Notes in `kept` what it shows once these have been drawn.
std::optional<TexelBox> outdated(ShadowHistory::Kept& kept, const Cascade& cascade,
                                 const FrameInput& input, const GeometryChanges& geometry) {
  if (!kept.valid || kept.key != cascade.key || kept.islands.size() > input.islands.size())
    return std::nullopt;
  const auto changed = geometry.since(kept.geometry_version);
  if (!changed) return std::nullopt;
  const FixedPos& camera = input.camera.position;
  // To places from the anchor that the map was drawn with.
  const auto rebased = [](IslandPlacement island, const FixedPos& from, const FixedPos& to) {
    for (std::size_t i = 0; i < 3; ++i) island.origin[i] += to[i] - from[i];
    return island;
  };
  TexelBox box;
  for (std::size_t i = 0; i < input.islands.size(); ++i) {
    const IslandPlacement& now = input.islands[i];
    // What has come of a new island stands among the changes.
    if (i == kept.islands.size()) {
      kept.islands.push_back(rebased(now, input.anchor, kept.anchor));
      continue;
    }
    if (movement(kept.islands[i], kept.anchor, now, input.anchor) <=
        kMovedTexels * static_cast<double>(cascade.texel_blocks))
      continue;
    add_island(box, rebased(kept.islands[i], kept.anchor, input.anchor), camera, cascade);
    add_island(box, now, camera, cascade);
    kept.islands[i] = rebased(now, input.anchor, kept.anchor);
  }
  for (const shared::Section& section : *changed) {
    if (section.island >= input.islands.size()) return std::nullopt;
    add_section(box, section, input.islands[section.island], camera, cascade);
  }
  kept.geometry_version = geometry.version();
  return box;
}

VkRect2D rect_of(const TexelBox& box) {
  const glm::ivec2 low(box.low), high(box.high);
  return {{low.x, low.y},
          {static_cast<std::uint32_t>(high.x - low.x), static_cast<std::uint32_t>(high.y - low.y)}};
}

/// Whether a map drawn by another light's direction shows shadows where they belong, or as good as.
bool good_enough(const glm::dvec3& drawn_by, const glm::dvec3& to_light, const Cascade& cascade) {
  const double moved = kShadowBlocks * glm::length(glm::cross(drawn_by, to_light));
  return glm::dot(drawn_by, to_light) > 0.0 &&
         moved <= kMovedTexels * static_cast<double>(cascade.texel_blocks);
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
    CascadeInput in = cascade_input(input, settings, body);
    const glm::dvec3 to_light = in.to_light;
    int index = 0;
    for (Cascade& cascade : make_cascades(in)) {
      ShadowHistory::Kept& kept = plan.next.kept[layer];
      std::optional<TexelBox> box = outdated(kept, cascade, input, geometry);
      if (!box && kept.valid && input.parts == 1 && good_enough(kept.to_light, to_light, cascade)) {
        in.to_light = kept.to_light;
        const Cascade before = make_cascades(in)[static_cast<std::size_t>(index)];
        box = outdated(kept, before, input, geometry);
        if (box) cascade = before;
      }
      if (box) {
        const VkRect2D area = box->empty() ? VkRect2D{} : rect_of(*box);
        plan.cascades.push_back(
            {body, index++, layer++, !box->empty(), area, kept.to_light, cascade});
        continue;
      }
      kept = {true,
              cascade.key,
              to_light,
              geometry.version(),
              {input.islands.begin(), input.islands.end()},
              input.anchor};
      const VkRect2D whole{{0, 0}, {plan.layout.edge, plan.layout.edge}};
      plan.cascades.push_back({body, index++, layer++, true, whole, to_light, cascade});
    }
  }
  return plan;
}

}  // namespace skerry::render
