#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/settings.h"
#include "engine/render/light/cascades.h"
#include "engine/render/light/shadow_history.h"
#include "engine/render/light/shadow_job.h"
#include "engine/render/scene/geometry_changes.h"

namespace skerry::render {

/// A body's cascade this frame.
struct ActiveCascade {
  int body = 0;             ///< 0 the sun, 1 the moon
  int index = 0;            ///< in its body
  std::uint32_t slot = 0;   ///< index in FrameConstants::cascades
  std::uint32_t layer = 0;  ///< of the map array
  bool redraw = false;      ///< false: the kept map still shows the same
  VkRect2D area{};          ///< texels to draw if so; outside of them the kept map is right
  glm::dvec3 to_light{};    ///< unit; that the map is drawn by
  Cascade cascade;
};

/// Some of the sections of a map that no frame shows yet.
struct PartAhead {
  std::uint32_t layer = 0;  ///< of the map array
  bool clear = false;       ///< it is the map's first
  SectionRange sections;
  glm::dvec3 to_light{};  ///< unit
  Cascade cascade;
  /// Where the islands were when the map was begun, as from the frame's anchor, so that its parts
  /// fit together; as many as the frame has.
  std::vector<IslandPlacement> islands;
};

/// See plan_shadows().
inline constexpr double kShadowBlocks = 128.0;
/// What the sun moves such a shadow by in 10 s of the day.
inline constexpr double kShadowStepBlocks = 0.0931;

struct ShadowPlan {
  ShadowLayout layout;
  std::vector<ActiveCascade> cascades;  ///< all that are active, sun first
  std::vector<PartAhead> ahead;         ///< drawn before those
  ShadowHistory next;                   ///< without its generation
};

/// Layers of the array up to the last that the frame draws or shows.
std::uint32_t layers_used(const ShadowPlan& plan);

/// Decides a frame's cascades and which of the kept maps still show what they should. Bodies below
/// the horizon have none. A map is kept while its window and its light stay: islands may have moved
/// by a quarter of a texel, and the light, unless a frame has parts, may have turned by as much as
/// moves the shadow of what stands kShadowBlocks before a surface by that, or by kShadowStepBlocks:
/// what is shaded follows every step of the clock, and fine maps need not. Where sections came or
/// went, or islands moved further, only the texels that these can show in are drawn again.
/// So it is with each fine map, and with all where the input may not lag. The others may lag: what
/// they lack is drawn within 16 frames, some sections a frame, to another layer that takes their
/// place (docs/decisions/0055). Until then they show islands within 0.45 of a texel of their
/// places, by which no lit face turns dark, and the light up to twice as far from its way as above.
/// @param sections one a slot of the geometry store.
/// @param generation of the array that exists now. A function of its arguments alone.
ShadowPlan plan_shadows(const FrameInput& input, const RenderSettings& settings,
                        std::span<const shared::Section> sections, const GeometryChanges& geometry,
                        const ShadowHistory& history, std::uint64_t generation);

}  // namespace skerry::render
