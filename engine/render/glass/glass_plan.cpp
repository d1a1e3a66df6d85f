#include "engine/render/glass/glass_plan.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/render/light/shadow_changes.h"

namespace skerry::render {
namespace {

constexpr std::uint32_t kMostGlassEdge = 1024;  // texels, of 16 bytes each

std::uint32_t brighter_body(const Celestial& sky) {
  const auto luminance = [](const glm::vec3& light) {
    return glm::dot(light, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  };
  const float sun = sky.sun_casts ? luminance(sky.sun_irradiance) : 0.0f;
  const float moon = sky.moon_casts ? luminance(sky.moon_irradiance) : 0.0f;
  return sun >= moon ? 0 : 1;
}

}  // namespace

GlassPlan plan_glass(const FrameInput& input, const RenderSettings& settings,
                     std::span<const ActiveCascade> cascades,
                     std::span<const shared::Section> sections,
                     const std::map<std::uint32_t, GlassBox>& boxes) {
  GlassPlan plan;
  if (boxes.empty() || settings.leave_out.has(Feature::kWater)) return plan;
  plan.body = brighter_body(input.sky);
  for (const ActiveCascade& active : cascades) {
    if (static_cast<std::uint32_t>(active.body) != plan.body) continue;
    TexelBox shown;
    bool stained = false;
    for (const auto& [slot, glass] : boxes) {
      shared::Section section = sections[slot];
      if (section.range_end[shared::kRangeCount - 1] == 0 || section.island >= input.islands.size())
        continue;
      section.bounds_min = glass.box.low, section.bounds_max = glass.box.high;
      const TexelBox box =
          box_of(section, input.islands[section.island], input.camera.position, active.cascade);
      shown.add(box);
      stained |= glass.stained && !box.empty();
    }
    if (shown.empty()) continue;
    const auto shadow_edge = static_cast<std::uint32_t>(active.cascade.key.map_size);
    const std::uint32_t divisor =
        2 * ((shadow_edge + 2 * kMostGlassEdge - 1) / (2 * kMostGlassEdge));
    plan.edge = shadow_edge / divisor;
    plan.per_shadow_texel = 1.0f / static_cast<float>(divisor);
    const double along = divisor;
    const TexelBox texels{glm::floor(shown.low / along),
                          glm::min(glm::ceil(shown.high / along), glm::dvec2(plan.edge))};
    if (texels.empty()) continue;
    plan.stained |= stained;
    plan.maps.push_back(
        {active.slot, texels.rect(), shown.rect(), active.to_light, active.cascade});
  }
  return plan;
}

}  // namespace skerry::render
