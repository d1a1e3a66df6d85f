// Pixels of the picture: exposed, tone-mapped, dithered. Needs before the include: `frame`.
#ifndef SKERRY_PICTURE_GLSL
#define SKERRY_PICTURE_GLSL
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/exposure.h"
#include "include/post/tonemap.glsl"

layout(binding = kTargetBinding) writeonly uniform image2D target;
layout(scalar, binding = kExposureBinding) uniform Chosen { Exposure exposure; };

layout(constant_id = kCalibratedConstant) const bool kCalibrated = false;  // the display takes other than 0 to 1

// @param glow exposed light that the lens adds.
vec3 developed(vec3 radiance, vec3 glow) {
  vec3 exposed = radiance * exp2(-exposure.ev) + glow;
  vec3 encoded = srgb_encode(tone_map(exposed));
  return kCalibrated ? displayed(encoded, frame.display_peak, frame.display_black) : encoded;
}

// Rounded here: how a store rounds differs from driver to driver.
void put_developed(uvec2 pixel, vec3 encoded) {
  imageStore(target, ivec2(pixel), vec4(floor(dithered(encoded, pixel) * 255.0 + 0.5) / 255.0, 1.0));
}
#endif
