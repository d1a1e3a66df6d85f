#include "engine/render/frame/frame_choices.h"

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

}  // namespace skerry::render
