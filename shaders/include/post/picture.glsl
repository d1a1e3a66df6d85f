// Pixels of the picture: exposed, tone-mapped, dithered. Needs before the include: `frame`, `stats` (PixelStats).
#ifndef SKERRY_PICTURE_GLSL
#define SKERRY_PICTURE_GLSL
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/exposure.h"
#include "include/post/tonemap.glsl"

layout(binding = kTargetBinding) writeonly uniform image2D target;  // of any format: the picture, or scene radiance
layout(scalar, binding = kExposureBinding) uniform Chosen { Exposure exposure; };

layout(constant_id = kCalibratedConstant) const bool kCalibrated = false;  // the display takes other than 0 to 1

vec4 developed(vec3 exposed, uvec2 pixel) {
  vec3 encoded = srgb_encode(tone_map(exposed));
  if (kCalibrated) encoded = displayed(encoded, frame.display_peak, frame.display_black);
  // Rounded here: how a store rounds differs from driver to driver.
  return vec4(floor(dithered(encoded, pixel) * 255.0 + 0.5) / 255.0, 1.0);
}

// Every invocation calls this once; `here` says which have a pixel. What is stored is finite.
// @param glow exposed light that the lens adds.
void put_in_picture(uvec2 pixel, vec3 colour, vec3 glow, bool here) {
  uint black = subgroupAdd(here && colour == vec3(0.0) ? 1u : 0u);
  if (black != 0u && subgroupElect()) atomicAdd(stats.black, black);
  if (!here) return;
  if (!finite3(colour)) atomicAdd(stats.non_finite, 1u);
  imageStore(target, ivec2(pixel), developed(sanitised(colour) * exp2(-exposure.ev) + glow, pixel));
}
#endif
