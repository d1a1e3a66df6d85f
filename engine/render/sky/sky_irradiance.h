#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "engine/render/frame/celestial.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/sky/sky_model.h"

namespace skerry::render {

/// What each lobe of an open sky sends to each face of each island: irradiance, linear RGB, without
/// the discs of sun and moon. And the harmonics, about the island's own axes, of all that sky and
/// bodies send. Some ten microseconds an
/// island; far ones of about the same heading have one sky in common.
/// @param shown one an island: others are passed over and get 0.
/// @return kIndirectIslandTexels an island in the layout of shaders/shared/indirect.h; what a half
/// holds is at most what it can.
std::vector<glm::uvec4> sky_irradiance(const SkyModel& sky, const Celestial& bodies,
                                       std::span<const IslandPlacement> islands,
                                       const std::vector<bool>& shown);

}  // namespace skerry::render
