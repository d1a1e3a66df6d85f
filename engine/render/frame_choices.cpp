#include "engine/render/frame_choices.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/render/frame_setup.h"
#include "engine/render/light_clusters.h"
#include "engine/render/shadow_maps.h"

namespace skerry::render {

bool shows_channel(const RenderSettings& settings) {
  return settings.debug_view != DebugView::kNone && settings.debug_view != DebugView::kExposure;
}

int samples_per_edge(const RenderSettings& settings) {
  return shows_channel(settings) ? 1 : settings.samples_per_edge;
}

bool meters(const FrameInput& input, const RenderSettings& settings) {
  return input.meter || !input.exposure_ev || settings.debug_view == DebugView::kExposure;
}

bool by_radiance(const FrameInput& input, const RenderSettings& settings,
                 const FrameFeatures& features) {
  return features.has(Feature::kLights) || features.has(Feature::kClouds) ||
         settings.bloom.intensity > 0.0f || meters(input, settings) || input.capture ||
         input.fault.has_value() || samples_per_edge(settings) > 1 || input.parts > 1;
}

std::uint32_t marked_slices(const FrameInput& input, const FrameContents& contents) {
  const std::uint32_t lit =
      contents.features.has(Feature::kClouds) ? slices_lit(contents.lights) : 0u;
  return lit | (input.camera_medium != 0 ? 1u : 0u);
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

}  // namespace skerry::render
