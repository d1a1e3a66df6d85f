#include "engine/render/frame/frame_choices.h"

#include <cmath>
#include <cstdint>

namespace skerry::render {

bool shows_channel(const RenderSettings& settings) {
  return settings.debug_view != DebugView::kNone && settings.debug_view != DebugView::kExposure;
}

int samples_per_edge(const RenderSettings& settings) {
  if (shows_channel(settings)) return 1;
  return settings.aa_samples == 16 ? 4 : settings.aa_samples == 4 ? 2 : 1;
}

float shadow_blur(const FrameInput& input, const RenderSettings& settings) {
  return input.parts == 1 ? settings.shadow_blur : 0.0f;
}

VkExtent2D picture_size(VkExtent2D shown, const RenderSettings& settings) {
  if (shows_channel(settings) || settings.render_scale >= 1.0f) return shown;
  const auto scaled = [&](std::uint32_t edge) {
    return static_cast<std::uint32_t>(std::ceil(static_cast<double>(edge) * settings.render_scale));
  };
  return {scaled(shown.width), scaled(shown.height)};
}

const char* why_not_temporal(const FrameInput& input, const RenderSettings& settings) {
  if (settings.aa != Antialiasing::kTemporal) return "aa is not temporal";
  if (shows_channel(settings)) return "a debug view is shown";
  if (samples_per_edge(settings) > 1) return "aa.samples smooths the edges";
  if (settings.gbuffer.depth == DepthStore::kD16) return "gbuffer.depth=d16";
  if (input.parts != 1) return "the picture has parts";
  return input.exposure_ev ? nullptr : "the frame chooses its own exposure";
}

const char* why_never_two_phases(const RenderSettings& settings) {
  if (settings.occlusion == Occlusion::kOff) return "view.occlusion=off";
  return settings.gbuffer.depth != DepthStore::kD32 ? "gbuffer.depth is not d32" : nullptr;
}

bool meters(const FrameInput& input, const RenderSettings& settings) {
  return input.meter || !input.exposure_ev || settings.debug_view == DebugView::kExposure;
}

}  // namespace skerry::render
