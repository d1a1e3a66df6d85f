#pragma once
#include <volk.h>

#include <glm/mat4x4.hpp>
#include <optional>
#include <span>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/render/frame/cloud_refs.h"
#include "engine/render/frame/draw_limits.h"
#include "engine/render/frame/settings.h"

namespace skerry::render {

/// What most passes of a frame read. Filled once by the renderer; passes that write replace the
/// reference by its new version.
struct SceneRefs {
  gpu::BufferRef frame;           ///< shared::FrameConstants
  gpu::BufferRef sky;             ///< shared::SkyConstants
  gpu::BufferRef sky_scattering;  ///< shared::SkyScatter, of the frame that makes the sky table
  /// shared::IslandTransform[view][island], each view's relative to its own centre: the camera's
  /// first. Texels, too.
  gpu::BufferRef islands;
  std::span<const float> edge_growth;  ///< one a view, see FrameTables; lives as long
  std::span<const glm::mat4>
      clip_from_source;            ///< one a view; lives until the graph has been executed
  gpu::BufferRef views;            ///< shared::CullView[view]
  gpu::BufferRef materials;        ///< shared::Material[block id]
  gpu::BufferRef quads, sections;  ///< the geometry store
  gpu::BufferRef seen_sections;    ///< see CullIn; empty: the frame does not ask
  std::uint32_t section_slots = 0;
  DrawLimits most_draws{};
  /// The occupancy store; empty without one.
  gpu::BufferRef occupancy_grids, occupancy_tables, occupancy_words;
  /// Both of shaders/shared/indirect.h; a texel that is never read if off.
  gpu::BufferRef indirect, island_skies;
  gpu::BufferRef light_islands;  ///< FrameInput::light_islands; empty when no light is traced
  gpu::BufferRef indices;        ///< 16-bit: 0 1 2 0 2 3, 4 5 6 ...
  gpu::BufferRef pixel_stats;    ///< shared::PixelStats
  gpu::BufferRef exposure;       ///< shared::Exposure
  gpu::ImageRef block_textures, sky_lut;
  gpu::ImageRef block_coverage;  ///< see coverage_texels()
  bool panorama = false;         ///< `sky_lut` is one
  VkSampler sky_sampler{};       ///< of `sky_lut`
  /// One texel each, never written: bound where a program's choices leave a binding unread.
  gpu::ImageRef no_volume, no_words, no_depths, no_layers;
  VkSampler block_sampler{}, lut_sampler{}, point_sampler{};
  std::uint32_t islands_per_view = 0;
  std::uint32_t bodies = 0;  ///< that give light: bit 0 the sun, bit 1 the moon
  std::uint32_t shadow_taps = 0, shadow_cascades = 0;  ///< of each body, see RenderSettings
  std::uint32_t samples_per_edge = 1;                  ///< of a pixel, see RenderSettings
  bool shadow_blur = true;                             ///< whether shadow_blur is not 0
  bool haze = true;
  Indirect indirect_light = Indirect::kOff;
  ToneCurve tone = ToneCurve::kAces;
  bool calibrated = false;   ///< whether the display takes other than 0 to 1
  bool count_pixels = true;  ///< see FrameInput
  bool ao = false;           ///< whether corners take light; then there is an occupancy store
  bool sums_floats = false;  ///< see gpu::DeviceLimits
  bool on_cpu = false;       ///< the device is a CPU: a branch costs both its sides
  std::optional<CloudRefs> clouds;  ///< none: the frame has no clouds
  VkExtent2D size{};
  glm::uvec4 layers_area{};  ///< see shared::FrameConstants
};

}  // namespace skerry::render
