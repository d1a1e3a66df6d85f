#pragma once
#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "engine/render/light/cascades.h"

namespace skerry::render {

/// The array of shadow maps that a frame needs.
struct ShadowLayout {
  std::array<bool, 2> casting{};  ///< sun, moon
  std::uint32_t layers = 0;       ///< one a cascade; 0: nothing casts, there is no array
  std::uint32_t edge = 0;         ///< texels along an edge of each layer
  std::uint32_t spares = 0;       ///< layers more, for maps of later frames
  bool operator==(const ShadowLayout&) const = default;
};

/// Where an island is that a shadow map may show.
struct DrawnIsland {
  std::uint32_t index = 0;  ///< of FrameInput::islands
  FixedPos origin{};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  double bounding_radius = 0.0;
};

/// What a shadow map shows: all there was when it was drawn.
struct DrawnMap {
  CascadeKey key;
  glm::dvec3 to_light{};
  std::uint64_t geometry_version = 0;
  std::uint32_t island_count = 0;  ///< there were; all that are not listed lie outside of the map
  /// Ascending. Never null; shared by the maps of frames between which none has moved.
  std::shared_ptr<const std::vector<DrawnIsland>> islands;
  FixedPos anchor{};
};

/// A map that is drawn in parts, some sections a frame, in a layer of its own.
struct ShadowJob {
  DrawnMap after;                  ///< what the map shows when all parts are drawn
  double quads_a_frame = 0.0;      ///< that face the light, about
  std::uint32_t next_section = 0;  ///< those before have been drawn
};

/// Placements of a frame, for later ones.
using SharedIslands = std::shared_ptr<const std::vector<IslandPlacement>>;
SharedIslands shared_islands(const FrameInput& input);

/// What the shadow maps show after a frame has been submitted.
struct ShadowHistory {
  struct Kept {
    std::optional<DrawnMap> map;
    std::uint32_t layer = 0;       ///< of the array
    std::uint32_t spare = 0;       ///< likewise, that its job draws to
    std::optional<ShadowJob> job;  ///< none: nothing is being drawn
  };
  ShadowLayout layout;
  std::uint64_t generation = 0;  ///< of the array, ShadowMaps::generation()
  std::array<Kept, 8> kept;      ///< one a cascade, sun first
  SharedIslands islands;         ///< of the last frame; null: none yet
  FixedPos anchor{};             ///< likewise

  /// Of what the maps were drawn with, meshes that came after a version were not there yet.
  void only_shows(std::uint64_t geometry_version);
};

}  // namespace skerry::render
