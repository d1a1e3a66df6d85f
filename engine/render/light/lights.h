#pragma once
#include "engine/core/result.h"
#include "shaders/shared/light.h"

namespace skerry::render {

/// The most a light may ask for. Within, every sum and product of the shaders stays finite.
inline constexpr float kMaxLightRange = 1e6f;      ///< blocks
inline constexpr float kMaxLightIntensity = 1e8f;  ///< a channel of Light::intensity
inline constexpr float kMaxLightSize = 1e3f;       ///< blocks
inline constexpr float kMaxLightDistance = 1e7f;   ///< from the camera, along an axis [blocks]

/// The one way for a light into a frame: FrameInput::lights holds only what this
/// has returned.
/// @param asked any bits. Its islands (first_island, island_count) are taken as they are.
/// @return the light as shaders take it: axis unit, cone cosines apart, fields that its kind does
/// not use 0. Intensity 0 is a light that lights nothing.
/// Errors: a kind or bit that does not exist; a number that is not finite, negative or over the
/// most above; range 0; an axis of no length; a cone whose inner angle is not within its outer one.
Result<shared::Light> checked_light(const shared::Light& asked);

}  // namespace skerry::render
