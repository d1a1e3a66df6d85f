// Maps of glass as a body sees it, beside its shadow maps (docs/decisions/0069).
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/settings.h"
#include "engine/render/light/shadow_plan.h"
#include "engine/render/scene/voxel_box.h"

namespace skerry::render {

/// Of a cascade that glass stands before.
struct GlassMap {
  std::uint32_t slot = 0;  ///< of the cascade in FrameConstants::cascades
  VkRect2D area{};         ///< texels that show glass
  VkRect2D shadow_area{};  ///< the same in the shadow map
  glm::dvec3 to_light{};   ///< unit; that the cascade's map is drawn by
  Cascade cascade;
};

struct GlassPlan {
  std::uint32_t body = 0;  ///< that the maps are of: the brighter one of those that cast
  std::uint32_t edge = 0;  ///< of a map [texels]
  /// Texels along one of a shadow map: the inverse of an even number. The middle of each is that of
  /// a shadow map's texel, so that what stands before it is known for the same ray.
  float per_shadow_texel = 1.0f;
  bool stained = false;        ///< some of it colours light
  std::vector<GlassMap> maps;  ///< one a layer; empty: no glass stands before what is lit
};

/// @param cascades of the frame, as their maps are shown. @param boxes
/// GeometryStore::glass_boxes().
/// @param sections one a slot of the geometry store.
GlassPlan plan_glass(const FrameInput& input, const RenderSettings& settings,
                     std::span<const ActiveCascade> cascades,
                     std::span<const shared::Section> sections,
                     const std::map<std::uint32_t, GlassBox>& boxes);

}  // namespace skerry::render
