#pragma once
#include <glm/vec3.hpp>

#include "engine/render/frame/celestial.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

/// Everything of a moment's sky that does not depend on the direction looked at.
/// Source: A. J. Preetham, P. Shirley, B. Smits, A Practical Analytic Model for Daylight, SIGGRAPH
/// 1999, turbidity 2.5; sun and moon are two sources of it. The paper ends at the horizon: a stated
/// twilight takes over below (sky_model.cpp).
shared::SkyConstants sky_constants(const Celestial& sky);

/// Radiance of the sky without discs and stars, linear RGB, >= 0 and finite. The double-precision
/// twin of sky_radiance() in shaders/include/sky/sky.glsl. @param dir unit, any.
glm::dvec3 sky_radiance(glm::dvec3 dir, const shared::SkyConstants& sky);

/// Extinction of clear air [1/block].
inline constexpr float kClearAir = 0.0005f;

/// How much of the light that air and clouds take from the sky there is, 0..1: taken back as the
/// brighter body sets, so that nothing ends in a step when it is gone.
float air_light(const Celestial& sky);

}  // namespace skerry::render
