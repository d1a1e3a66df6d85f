#include "engine/render/renderer/frame_steps.h"

#include <array>

#include "engine/render/steps/bloom_step.h"
#include "engine/render/steps/cloud_steps.h"
#include "engine/render/steps/edge_step.h"
#include "engine/render/steps/geometry_steps.h"
#include "engine/render/steps/light_steps.h"
#include "engine/render/steps/measure_steps.h"
#include "engine/render/steps/meter_steps.h"
#include "engine/render/steps/picture_steps.h"
#include "engine/render/steps/resolve_step.h"
#include "engine/render/steps/shade_step.h"
#include "engine/render/steps/shadow_step.h"
#include "engine/render/steps/sky_table_step.h"
#include "engine/render/steps/water_steps.h"

namespace skerry::render {

std::span<const FrameStep> frame_steps() {
  static const std::array kSteps{
      pixel_stats_step(),
      sky_table_step(),
      break_sky_table_step(),
      cull_step(),
      draw_geometry_step(),
      draw_revealed_step(),
      draw_shadows_step(),
      draw_translucent_step(),
      draw_glass_step(),
      sort_lights_step(),
      show_channel_step(),
      light_clouds_step(),
      shade_step(),
      break_shaded_step(),
      blend_clouds_behind_water_step(),
      mirror_clouds_step(),
      shade_translucent_step(),
      blend_clouds_step(),
      break_looked_through_step(),
      resolve_step(),
      capture_radiance_step(),
      meter_step(),
      bloom_step(),
      develop_step(),
      smooth_edges_step(),
      mix_frames_step(),
      show_exposure_step(),
      draw_marker_step(),
      enlarge_step(),
      capture_geometry_step(),
  };
  return kSteps;
}

}  // namespace skerry::render
