#include "engine/render/plan/frame_tables.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/render/frame/display.h"
#include "engine/render/frame/frame_choices.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/light.h"
#include "shaders/shared/sky.h"

namespace skerry::render {
namespace {

shared::Cascade shader_cascade(const ActiveCascade& active, int map_size) {
  const glm::mat4& m = active.cascade.clip_from_world;
  const float half = 0.5f * static_cast<float>(map_size);
  const auto row = [&](int r) { return glm::vec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
  shared::Cascade out{};
  out.map_from_world_x = row(0) * half + glm::vec4(0, 0, 0, half);
  out.map_from_world_y = row(1) * half + glm::vec4(0, 0, 0, half);
  out.map_from_world_z = row(2);
  out.radius = active.cascade.radius;
  out.texel_blocks = active.cascade.texel_blocks;
  out.depth_per_block = 1.0f / active.cascade.depth_blocks;
  out.layer = active.layer;
  return out;
}

shared::Body shader_body(glm::dvec3 to_light, glm::vec3 irradiance, int body,
                         std::span<const ActiveCascade> cascades) {
  shared::Body out{};
  out.to_light = glm::vec3(to_light);
  out.irradiance = irradiance;
  for (const ActiveCascade& c : cascades)
    if (c.body == body && out.cascade_count++ == 0) out.first_cascade = c.slot;
  return out;
}

constexpr std::uint32_t kFaceUp = 2;  // of a word of the G-buffer (shaders/shared/geometry.h)

void append_islands(std::vector<shared::IslandTransform>& out,
                    std::span<const IslandPlacement> islands, const FixedPos& relative_to) {
  for (const IslandPlacement& island : islands) out.push_back(transform_of(island, relative_to));
}

/// As append_islands() does, of islands that are the first in `out`: they are turned the same way.
void append_again(std::vector<shared::IslandTransform>& out,
                  std::span<const IslandPlacement> islands, const FixedPos& relative_to) {
  for (std::size_t i = 0; i < islands.size(); ++i) {
    shared::IslandTransform again = out[i];
    again.translation = glm::vec3(blocks_between(islands[i].origin, relative_to));
    out.push_back(again);
  }
}

VkRect2D whole_area(const Cascade& cascade) {
  const auto edge = static_cast<std::uint32_t>(cascade.key.map_size);
  return {{0, 0}, {edge, edge}};
}

/// The view of a light that draws a part of a map, but for its islands.
void append_light(FrameTables& out, const Cascade& cascade, const VkRect2D& area,
                  const glm::dvec3& to_light) {
  shared::CullView light{};
  const std::array<glm::vec4, 6> planes = planes_about(cascade, area);
  for (std::size_t i = 0; i < planes.size(); ++i) light.planes[i] = planes[i];
  light.planes[5] = glm::vec4(
      0, 0, 0, 1);  // casters beyond the range are flattened onto it, so none may be culled there
  light.eye = glm::vec3(to_light);
  light.orthographic = 1;
  light.enabled = 1;
  out.views.push_back(light);
  // Relative to the map's own centre as its islands are, a function of its key alone: a map drawn
  // again in the same window is equal to the last bit.
  out.matrices.push_back(cascade.clip_from_centre);
  out.edge_growth.push_back(cascade.texel_blocks / 128.0f);
}

}  // namespace

glm::dvec3 blocks_between(const FixedPos& to, const FixedPos& from) {
  return {static_cast<double>(to[0] - from[0]) / 65536.0,
          static_cast<double>(to[1] - from[1]) / 65536.0,
          static_cast<double>(to[2] - from[2]) / 65536.0};
}

shared::IslandTransform transform_of(const IslandPlacement& island, const FixedPos& relative_to) {
  const glm::dmat3 axes = glm::mat3_cast(island.rotation);
  return {glm::vec3(axes[0]), glm::vec3(axes[1]), glm::vec3(axes[2]),
          glm::vec3(blocks_between(island.origin, relative_to))};
}

shared::CullView cull_view_of(const CameraView& camera) {
  shared::CullView view{};
  for (std::size_t i = 0; i < camera.planes.size(); ++i) view.planes[i] = camera.planes[i];
  view.enabled = 1;
  return view;
}

FrameTables build_tables(const FrameInput& input, const RenderSettings& settings, VkExtent2D size,
                         std::span<const ActiveCascade> cascades, std::span<const PartAhead> ahead,
                         const GlassPlan& glass) {
  FrameTables out;
  const CameraView camera = view_of(input.camera, size.width, size.height);
  shared::FrameConstants& f = out.constants;
  f.clip_from_world = camera.clip_from_world;
  f.ray_right = camera.right * camera.tan_half_x;
  f.ray_up = camera.up * camera.tan_half_y;
  f.ray_forward = camera.forward;
  f.pixel_to_ndc = {2.0f / static_cast<float>(size.width), 2.0f / static_cast<float>(size.height)};
  f.sample_in_pixel = {0.5f, 0.5f};
  f.size = {size.width, size.height};
  f.layers_area = {0, 0, size.width, size.height};
  f.picture_size = f.size;
  f.near_plane = kNearPlane;
  f.display_peak = static_cast<float>(srgb_encoded(settings.display.peak));
  f.display_black = settings.display.black;
  f.time_s = static_cast<float>(std::fmod(input.time_s, 3600.0));
  f.shading_flat = settings.shading == Shading::kFlat ? 1u : 0u;
  f.camera_medium = input.camera_medium;
  f.shadow_blur = shadow_blur(input, settings);
  f.bodies[0] = shader_body(input.sky.to_sun, input.sky.sun_irradiance, 0, cascades);
  f.bodies[1] = shader_body(input.sky.to_moon, input.sky.moon_irradiance, 1, cascades);

  f.ao_strength = settings.ao_strength;
  f.sky_horizon = static_cast<float>(std::asin(horizon_sine(eye_height_km(input))));
  f.haze_per_block = kClearAir * air_light(input.sky);

  out.views.push_back(cull_view_of(camera));
  out.matrices.push_back(camera.clip_from_world);
  out.edge_growth.push_back(2.0f * camera.tan_half_x / (128.0f * static_cast<float>(size.width)));
  const auto redrawn = std::ranges::count_if(cascades, &ActiveCascade::redraw);
  out.islands.reserve(input.islands.size() *
                      (1 + static_cast<std::size_t>(redrawn) + ahead.size() + glass.maps.size()));
  append_islands(out.islands, input.islands, input.camera.position);
  if (input.camera_medium != 0 && input.medium_surface) {
    const MediumSurface& above = *input.medium_surface;
    const shared::IslandTransform& t = out.islands[above.island];
    const glm::vec3 middle = glm::vec3(above.block) + glm::vec3(0.5f, 1.0f, 0.5f);
    f.medium_surface = shared::kSurfaceHere | above.island << shared::kIslandShift |
                       kFaceUp << shared::kFaceShift | input.camera_medium;
    f.medium_light = above.share;
    f.medium_surface_place =
        t.axis_x * middle.x + t.axis_y * middle.y + t.axis_z * middle.z + t.translation;
  }

  for (const ActiveCascade& active : cascades) {
    f.cascades[active.slot] = shader_cascade(active, settings.shadow_size);
    if (!active.redraw) continue;
    append_light(out, active.cascade, active.area, active.to_light);
    append_again(out.islands, input.islands, active.cascade.centre);
  }
  for (const PartAhead& part : ahead) {
    append_light(out, part.cascade, whole_area(part.cascade), part.to_light);
    append_islands(out.islands, part.islands, part.cascade.centre);
    out.views.back().first_section = part.sections.first;
    out.views.back().section_limit = part.sections.end;
  }
  f.glass_body = glass.body;
  f.glass_per_texel = glass.per_shadow_texel;
  for (std::uint32_t layer = 0; layer < glass.maps.size(); ++layer) {
    const GlassMap& map = glass.maps[layer];
    append_light(out, map.cascade, map.shadow_area, map.to_light);
    append_again(out.islands, input.islands, map.cascade.centre);
    out.views.back().glass = 1;
    // Where quads overlapped, the map would count what is behind them twice.
    out.edge_growth.back() = 0.0f;
    const float half_texel = 1.0f / static_cast<float>(map.cascade.key.map_size);
    out.matrices.back()[3] -= glm::vec4(half_texel, half_texel, 0.0f, 0.0f);
    const glm::uvec2 first(map.area.offset.x, map.area.offset.y);
    f.cascades[map.slot].glass_layer = layer;
    f.cascades[map.slot].glass_area =
        glm::uvec4(first, first + glm::uvec2(map.area.extent.width, map.area.extent.height));
  }
  return out;
}

Celestial sky_of_part(Celestial sky, std::uint32_t part, std::uint32_t parts) {
  if (parts == 1) return sky;
  constexpr double kGoldenAngle = 2.399963229728653;
  const double radius = static_cast<double>(shared::kBodyRadius) * std::sqrt((part + 0.5) / parts);
  for (glm::dvec3* to_light : {&sky.to_sun, &sky.to_moon}) {
    const std::array<glm::dvec3, 3> axes = light_axes(*to_light);
    *to_light = glm::normalize(*to_light + radius * std::cos(kGoldenAngle * part) * axes[0] +
                               radius * std::sin(kGoldenAngle * part) * axes[1]);
  }
  return sky;
}

bool disc_in_view(const Celestial& sky, const shared::FrameConstants& frame) {
  const glm::vec3 corner = frame.ray_forward + frame.ray_right + frame.ray_up;
  // Discs are drawn a pixel beyond their edge; twice the radius covers that at any usual size.
  const float pixel = frame.pixel_to_ndc.y * glm::length(frame.ray_up);
  const float reach = std::acos(std::clamp(1.0f / glm::length(corner), 0.0f, 1.0f)) +
                      2.0f * shared::kDiscRadius + 2.0f * pixel;
  const float horizon = std::sin(frame.sky_horizon);
  const auto seen = [&](glm::dvec3 to_body) {
    const glm::vec3 body(to_body);
    if (body.y < horizon - 2.0f * shared::kDiscRadius - 2.0f * pixel) return false;
    const float cosine = glm::dot(body, frame.ray_forward);
    return std::acos(std::clamp(cosine, -1.0f, 1.0f)) <= reach;
  };
  return (sky.sun_exists && seen(sky.to_sun)) || (sky.moon_exists && seen(sky.to_moon));
}

void shift_view(shared::CullView& view, const FixedPos& frozen, const FixedPos& now) {
  const glm::vec3 moved(blocks_between(now, frozen));
  for (glm::vec4& plane : view.planes) plane.w += glm::dot(glm::vec3(plane), moved);
  view.eye -= moved;
}

}  // namespace skerry::render
