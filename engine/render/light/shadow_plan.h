#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/settings.h"
#include "engine/render/light/cascades.h"
#include "engine/render/scene/geometry_changes.h"

namespace skerry::render {

/// The array of shadow maps that a frame needs.
struct ShadowLayout {
  std::array<bool, 2> casting{};  ///< sun, moon
  std::uint32_t layers = 0;       ///< one a cascade; 0: nothing casts, there is no array
  std::uint32_t edge = 0;         ///< texels along an edge of each layer
  bool operator==(const ShadowLayout&) const = default;
};

/// A body's cascade this frame.
struct ActiveCascade {
  int body = 0;             ///< 0 the sun, 1 the moon
  int index = 0;            ///< in its body
  std::uint32_t layer = 0;  ///< of the map array, and index in FrameConstants::cascades
  bool redraw = false;      ///< false: the kept map still shows the same
  VkRect2D area{};          ///< texels to draw if so; outside of them the kept map is right
  glm::dvec3 to_light{};    ///< unit; that the map is drawn by
  Cascade cascade;
};

/// What the shadow maps show after a frame has been submitted.
struct ShadowHistory {
  struct Kept {
    bool valid = false;
    CascadeKey key;
    glm::dvec3 to_light{};
    std::uint64_t geometry_version = 0;
    std::vector<IslandPlacement> islands;
    FixedPos anchor{};
  };
  ShadowLayout layout;
  std::uint64_t generation = 0;  ///< of the array the maps were drawn to, ShadowMaps::generation()
  std::array<Kept, 8> kept;      ///< one a layer
};

/// See plan_shadows().
inline constexpr double kShadowBlocks = 128.0;

struct ShadowPlan {
  ShadowLayout layout;
  std::vector<ActiveCascade> cascades;  ///< all that are active, sun first
  ShadowHistory next;                   ///< without its generation
};

/// Decides a frame's cascades and which of the kept maps still show what they should. Bodies below
/// the horizon have none. A map is kept while its window and its light stay: islands may have moved
/// by a quarter of a texel, and the light, unless a frame has parts, may have turned by as much as
/// moves the shadow of what stands kShadowBlocks before a surface by that. Where sections came or
/// went, or islands moved further, only the texels that these can show in are drawn again.
/// @param generation of the array that exists now. A function of its arguments alone.
ShadowPlan plan_shadows(const FrameInput& input, const RenderSettings& settings,
                        const GeometryChanges& geometry, const ShadowHistory& history,
                        std::uint64_t generation);

}  // namespace skerry::render
