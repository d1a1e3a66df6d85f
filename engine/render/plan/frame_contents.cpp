#include "engine/render/plan/frame_contents.h"

#include <algorithm>

#include "engine/render/light/light_clusters.h"
#include "engine/render/plan/in_view.h"

namespace skerry::render {
namespace {

/// @return the part of the picture that shows it; all of it about an eye inside.
glm::uvec4 find_water(FrameFeatures& features, const FrameInput& input, const FrameTables& tables,
                      const SceneFacts& facts) {
  const glm::uvec4 all = tables.constants.layers_area;
  if (input.camera_medium != 0 || !features.has(Feature::kWater)) return all;
  if (facts.translucent_quads == 0)
    features.set_absent(Feature::kWater, "no translucent block is resident");
  if (facts.translucent_quads == 0) return all;
  const std::optional<glm::uvec4> area = translucent_area(facts, tables);
  if (!area) features.set_absent(Feature::kWater, "no translucent block is in view");
  return area.value_or(all);
}

std::vector<bool> find_cutouts(FrameFeatures& features, const FrameTables& tables,
                               const SceneFacts& facts) {
  std::vector<bool> in_view(tables.views.size(), false);
  if (facts.cutout_quads == 0)
    features.set_absent(Feature::kCutouts, "no cut-out block is resident");
  if (!features.has(Feature::kCutouts)) return in_view;
  for (std::size_t view = 0; view < in_view.size(); ++view)
    in_view[view] = cutouts_in_view(facts.sections, tables.islands, tables.views[view]);
  if (std::find(in_view.begin(), in_view.end(), true) == in_view.end())
    features.set_absent(Feature::kCutouts, "no cut-out block is in view of camera or lights");
  return in_view;
}

std::vector<shared::Light> find_lights(FrameFeatures& features, const FrameInput& input,
                                       const FrameTables& tables, const SceneFacts& facts) {
  if (input.lights.empty()) features.set_absent(Feature::kLights, "there are no lights");
  if (!facts.has_geometry()) features.set_absent(Feature::kLights, "no geometry is resident");
  if (!features.has(Feature::kLights)) return {};
  std::vector<shared::Light> in_view = lights_in_view(input.lights, tables.views[0]);
  if (in_view.empty()) features.set_absent(Feature::kLights, "no light reaches the view");
  return in_view;
}

}  // namespace

FrameContents contents_of(const FrameInput& input, const RenderSettings& settings,
                          const FrameTables& tables, const shared::SkyConstants& sky,
                          const SceneFacts& facts) {
  FrameContents out{FrameFeatures(settings.leave_out), {}, {}, {}};
  FrameFeatures& features = out.features;
  if (!input.sky.sun_casts) features.set_absent(Feature::kSun, "the sun is below the horizon");
  if (!input.sky.moon_casts)
    features.set_absent(Feature::kMoon, "the moon is below the horizon or gives no light");
  const bool sky_lights = settings.indirect != Indirect::kOff && facts.indirect;
  if (!input.sky.sun_casts && !input.sky.moon_casts && !sky_lights)
    features.set_absent(Feature::kHaze, "there is no light for the air to scatter");
  if (facts.panorama) features.set_absent(Feature::kStars, "a panorama is the sky");
  if (sky.stars == 0.0f) features.set_absent(Feature::kStars, "it is not dark enough");
  if (!disc_in_view(input.sky, tables.constants))
    features.set_absent(Feature::kDiscs, "sun and moon are outside the picture or have set");
  if (settings.clouds.coverage == 0.0f && facts.clouds.volumes.empty())
    features.set_absent(Feature::kClouds, "clouds.coverage=0 and there is no cloud of a file");
  out.layers_area = find_water(features, input, tables, facts);
  out.cutouts_in_view = find_cutouts(features, tables, facts);
  out.blended = facts.sections_blended != 0 &&
                blended_in_view(facts.sections, tables.islands, tables.views[0]);
  out.lights = find_lights(features, input, tables, facts);
  return out;
}

std::uint32_t marked_slices(const FrameInput& input, const FrameContents& contents) {
  const std::uint32_t lit =
      contents.features.has(Feature::kClouds) ? slices_lit(contents.lights) : 0u;
  return lit | (input.camera_medium != 0 ? 1u : 0u);
}

}  // namespace skerry::render
