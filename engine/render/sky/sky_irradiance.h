#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

/// What each lobe of an open sky sends to each face of each island: irradiance, linear RGB, without
/// the discs of sun and moon. Some ten microseconds an island.
/// @param shown one an island: others are passed over and get 0.
/// @return [island][face][channel], kSkyLobes halves each, in the layout of
/// shaders/shared/indirect.h; at most what a half can hold.
std::vector<glm::uvec4> sky_irradiance(const shared::SkyConstants& sky,
                                       std::span<const IslandPlacement> islands,
                                       const std::vector<bool>& shown);

}  // namespace skerry::render
