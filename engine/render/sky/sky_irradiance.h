#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "engine/render/frame/celestial.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/sky/sky_model.h"

namespace skerry::render {

/// How far a body may be from a key direction for all of its light, and for any, to be followed
/// from there.
inline constexpr double kNearKeyDeg = 4.0, kFarFromKeyDeg = 10.0;

/// What each lobe of an open sky sends to each face of each island: irradiance, linear RGB, without
/// the discs of sun and moon. And the harmonics, about the island's own axes, of all that sky and
/// bodies send, but for what of sun and moon has been followed from a key direction (KeyedBody):
/// all of its weight up to kNearKeyDeg from there, none of it from kFarFromKeyDeg on. The skies of
/// all 64 headings are summed up in any case; an island that is tilted, or where others hide a part
/// of the sky (IslandShade), costs most. Far ones of about the same heading have one sky in common.
/// Helpers::of_frames() take a share of the work.
/// @param shown one an island: others have a sky of 0 in common.
/// @return in the layout of shaders/shared/indirect.h: which sky each island has, and the skies.
/// What a half holds is at most what it can.
std::vector<glm::uvec4> sky_irradiance(const SkyModel& sky, const Celestial& bodies,
                                       std::span<const IslandPlacement> islands,
                                       const std::vector<bool>& shown, const FixedPos& eye);

}  // namespace skerry::render
