#include "engine/render/light/shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/gpu/device.h"

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
double caster_reach(const RenderSettings& settings) {
  return 2.0 * settings.view_distance_blocks + 512.0;
}

}  // namespace

Result<std::span<const ActiveCascade>> ShadowMaps::update(const FrameInput& input,
                                                          const RenderSettings& settings,
                                                          const GeometryChanges& geometry) {
  const std::array<bool, 2> casting{settings.shadows && input.sky.sun_casts,
                                    settings.shadows && input.sky.moon_casts};
  active_.clear();
  if (!casting[0] && !casting[1]) {
    maps_ = {};
    casting_ = casting;
    forget();
    return std::span<const ActiveCascade>{};
  }
  const auto cascades = static_cast<std::uint32_t>(settings.shadow_cascades);
  const std::uint32_t layers = cascades * ((casting[0] ? 1u : 0u) + (casting[1] ? 1u : 0u));
  if (casting != casting_ || !maps_ || map_size_ != settings.shadow_map_size ||
      maps_.desc().layers != layers) {
    maps_ = {};
    const auto edge = static_cast<std::uint32_t>(settings.shadow_map_size);
    Result<gpu::Image> image = device_->create_image(
        {.name = "shadow maps",
         .format = VK_FORMAT_D32_SFLOAT,
         .extent = {edge, edge},
         .layers = layers,
         .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
         .array = true});
    if (!image) return image.error();
    maps_ = *std::move(image);
    casting_ = casting;
    map_size_ = settings.shadow_map_size;
    forget();
  }
  std::uint32_t layer = 0;
  for (int body = 0; body < 2; ++body) {
    if (!casting[static_cast<std::size_t>(body)]) continue;
    int index = 0;
    CascadeInput in;
    in.to_light = body == 0 ? input.sky.to_sun : input.sky.to_moon;
    in.camera = input.camera.position;
    in.anchor = input.anchor;
    in.near_blocks = 1.0;
    in.far_blocks = settings.view_distance_blocks;
    in.caster_reach_blocks = caster_reach(settings);
    in.filter_blocks = 2.0 * static_cast<double>(settings.shadow_penumbra_blocks) +
                       8.0 * settings.view_distance_blocks / settings.shadow_map_size;
    in.map_size = settings.shadow_map_size;
    in.count = settings.shadow_cascades;
    in.split = settings.shadow_split;
    for (const Cascade& cascade : make_cascades(in)) {
      ActiveCascade active{body, index++, layer, true, cascade};
      Kept& kept = kept_[layer];
      active.redraw = !still_right(kept, active.cascade, input, geometry);
      if (active.redraw)
        kept = {true,
                active.cascade.key,
                geometry.version(),
                {input.islands.begin(), input.islands.end()},
                input.anchor};
      active_.push_back(active);
      ++layer;
    }
  }
  return std::span<const ActiveCascade>(active_);
}

bool ShadowMaps::still_right(Kept& kept, const Cascade& cascade, const FrameInput& input,
                             const GeometryChanges& geometry) const {
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

void ShadowMaps::forget() {
  for (Kept& kept : kept_) kept = {};
}

}  // namespace skerry::render
