#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "engine/render/scene/geometry_changes.h"
#include "engine/render/scene/voxel_box.h"
#include "engine/render/sky/cloud_plan.h"
#include "engine/render/sky/panorama_sky.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {

/// What is resident before a frame is planned, as values. The spans and `changes` live as long as
/// the stores do not change.
struct SceneFacts {
  std::span<const shared::Section> sections;    ///< one a slot; free slots have no ranges
  std::span<const VoxelBox> translucent_boxes;  ///< of the sections' water and glass, one a slot
  /// GeometryStore::glass_boxes(); null: there is none.
  const std::map<std::uint32_t, GlassBox>* glass_boxes = nullptr;
  std::uint32_t sections_resident = 0, sections_blended = 0;
  std::uint64_t quads_resident = 0, translucent_quads = 0, cutout_quads = 0;
  const GeometryChanges* changes = nullptr;  ///< never null in a plan
  bool occupancy = false;                    ///< there is an occupancy store
  bool indirect = false;                     ///< there is a store of the sky's light
  CloudFacts clouds;
  std::shared_ptr<const PanoramaSky> panorama;  ///< none: the sky is the air's
  std::uint32_t quads_in_view = 0;              ///< of the newest frame that is known; 0: none is
  std::uint64_t shadow_generation = 0;          ///< ShadowMaps::generation()

  std::uint64_t kept_generation = 0;  ///< KeptFrames::generation()

  bool has_geometry() const { return sections_resident != 0; }
};

}  // namespace skerry::render
