#include "engine/render/sky/cloud_plan.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/check.h"

namespace skerry::render {
namespace {

/// The layer drifts [blocks/s].
constexpr glm::dvec2 kWind{5.0, 2.0};

/// Radiance of the sky, mean of all directions: a spiral over the sphere.
glm::dvec3 mean_sky(const SkyModel& sky) {
  if (sky.panorama) return sky.panorama->mean();
  constexpr int kDirections = 512;  // at dusk most comes from a narrow band
  constexpr double kGoldenAngle = 2.399963229728653;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kDirections; ++i) {
    const double y = 1.0 - (2.0 * i + 1.0) / kDirections, r = std::sqrt(1.0 - y * y);
    sum += sky_radiance({r * std::sin(kGoldenAngle * i), y, r * std::cos(kGoldenAngle * i)}, sky);
  }
  return sum / double{kDirections};
}

/// A fixed-point place in a period of `period` blocks, exactly; 0..period.
double in_period(std::int64_t units, double drift_blocks, std::int64_t period) {
  const std::int64_t whole = period * 65536;
  const std::int64_t rest = ((units % whole) + whole) % whole;
  const double place =
      static_cast<double>(rest) / 65536.0 - std::fmod(drift_blocks, static_cast<double>(period));
  const double wrapped = std::fmod(place, static_cast<double>(period));
  return wrapped < 0.0 ? wrapped + static_cast<double>(period) : wrapped;
}

shared::CloudLayer layer_of(const FrameInput& input, const CloudSettings& settings) {
  const FixedPos& camera = input.camera.position;
  const auto at = [&](int axis, double wind) {
    return static_cast<float>(in_period(
        camera[static_cast<std::size_t>(axis)] - input.anchor[static_cast<std::size_t>(axis)],
        wind * input.time_s, shared::kLayerPeriod));
  };
  const double height =
      static_cast<double>(camera[1] - input.anchor[1]) / 65536.0 - settings.altitude;
  return {{at(0, kWind.x), static_cast<float>(height), at(2, kWind.y)},
          settings.thickness,
          settings.density,
          settings.coverage};
}

/// Of the hottest place: a fire's orange.
constexpr glm::vec3 kFlame{1.0f, 0.42f, 0.10f};

shared::CloudVolume volume_of(const CloudVolumeDesc& desc, const PackedVolume& packed,
                              const FixedPos& camera, const CloudSettings& settings,
                              std::uint32_t slot) {
  const glm::dvec3 offset{static_cast<double>(camera[0] - desc.origin[0]) / 65536.0,
                          static_cast<double>(camera[1] - desc.origin[1]) / 65536.0,
                          static_cast<double>(camera[2] - desc.origin[2]) / 65536.0};
  const glm::dmat4 inverse = glm::inverse(desc.blocks_from_index);
  const glm::dvec3 middle(inverse * glm::dvec4(offset, 1.0));
  const auto row = [&](int r) {
    return glm::vec4(inverse[0][r], inverse[1][r], inverse[2][r], middle[r]);
  };
  shared::CloudVolume out{};
  out.index_x = row(0);
  out.index_y = row(1);
  out.index_z = row(2);
  out.low = packed.low;
  out.high = packed.high;
  if (desc.role == CloudRole::kDensity)
    out.extinction = packed.value_range * settings.file_density;
  else
    out.emission = kFlame * settings.file_emission;
  const glm::dvec3 extent(packed.high - packed.low);
  const glm::dmat3 axes(desc.blocks_from_index);
  double diagonal = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    diagonal += glm::dot(axes[axis], axes[axis]) * extent[axis] * extent[axis];
  out.step_blocks = static_cast<float>(std::sqrt(diagonal) / settings.steps);
  out.first_cell = packed.first_cell;
  out.cell_count = packed.cell_count;
  out.cell_low = packed.cell_low;
  out.light_texels = packed.light_texels;
  for (std::uint32_t light = 0; light < shared::kCloudLights; ++light)
    out.light_first[light] =
        static_cast<float>((slot * shared::kCloudLights + light) * shared::kVolumeLightEdge);
  return out;
}

/// Whether light that was traced for one direction serves another: a body has moved by no more than
/// in 10 s of the day. Across a box, that is a twentieth of a texel.
bool good_enough(const CloudHistory::LitAs& lit, const CloudHistory::LitAs& now) {
  constexpr float kMostTurn = 7.28e-4f;
  return lit.valid && lit.steps == now.steps && lit.extinction == now.extinction &&
         glm::length(lit.to_light - now.to_light) <= kMostTurn;
}

/// Finds the volumes whose light is not what `plan.next` says any more, and notes that it will be.
void plan_light(CloudPlan& plan, const FrameInput& input, std::size_t volumes) {
  const std::array<bool, shared::kCloudLights> casts{input.sky.sun_casts, input.sky.moon_casts,
                                                     plan.sky};
  for (std::uint32_t v = 0; v < volumes; ++v)
    for (std::uint32_t light = 0; light < shared::kCloudLights; ++light) {
      if (!casts[light]) continue;
      const CloudHistory::LitAs now{true, plan.constants.lights[light].to_light,
                                    plan.constants.shadow_steps,
                                    plan.constants.volumes[v].extinction};
      if (good_enough(plan.next.lit[v][light], now)) continue;
      plan.next.lit[v][light] = now;
      plan.light_jobs.push_back({v, light});
    }
}

}  // namespace

shared::CloudConstants cloud_constants(const FrameInput& input, const CloudSettings& settings,
                                       const SkyModel& sky, bool sky_lights,
                                       std::span<const CloudVolumeDesc> volumes,
                                       std::span<const PackedVolume> packed) {
  shared::CloudConstants out{};
  out.lights[0] = {glm::vec3(input.sky.to_sun), input.sky.sun_irradiance};
  out.lights[1] = {glm::vec3(input.sky.to_moon), input.sky.moon_irradiance};
  out.lights[shared::kCloudZenith] = {{0.0f, 1.0f, 0.0f}, glm::vec3(0.0f)};
  const float by_body = air_light(input.sky);  // 0 without sun and moon
  if (sky_lights || by_body > 0.0f) {
    const glm::vec3 mean(mean_sky(sky));
    out.sky_beside_body = mean * by_body;
    if (sky_lights) out.sky_above = mean * (1.0f - by_body);
  }
  out.shadow_steps = static_cast<float>(settings.shadow_steps);
  out.steps = static_cast<float>(settings.steps);
  out.layer = layer_of(input, settings);
  for (std::size_t v = 0; v < volumes.size(); ++v)
    out.volumes[v] = volume_of(volumes[v], packed[v], input.camera.position, settings,
                               static_cast<std::uint32_t>(v));
  return out;
}

CloudPlan plan_clouds(const FrameInput& input, const CloudSettings& settings, const SkyModel& sky,
                      bool sky_lights, const CloudFacts& facts, const CloudHistory& history) {
  CloudPlan plan;
  plan.layer = settings.coverage > 0.0f;
  SKERRY_ASSERT(plan.layer || !facts.volumes.empty());
  plan.constants = cloud_constants(input, settings, sky, sky_lights, facts.volumes, facts.packed);
  plan.sky = plan.constants.sky_above != glm::vec3(0.0f);
  plan.bake_noise = plan.layer && (history.noise_generation == 0 ||
                                   history.noise_generation != facts.noise_generation);
  plan.volume_light =
      !facts.volumes.empty() && (input.sky.sun_casts || input.sky.moon_casts || plan.sky);
  plan.next.noise_generation = history.noise_generation;
  // Light in an image that has been made anew since is lost.
  if (history.light_generation == facts.light_generation) plan.next.lit = history.lit;
  if (plan.volume_light) plan_light(plan, input, facts.volumes.size());
  return plan;
}

}  // namespace skerry::render
