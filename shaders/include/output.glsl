// Where a shading pass puts its pixels: scene radiance, or, when nothing comes between it and the picture, the picture itself.
// Needs before the include: `frame`, `stats` (PixelStats).
#ifndef SKERRY_OUTPUT_GLSL
#define SKERRY_OUTPUT_GLSL
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "include/tonemap.glsl"

// Every invocation calls put_pixel() once; `here` tells which have a pixel. What is stored is finite.
#ifdef SKERRY_TO_PICTURE
#include "shared/exposure.h"
layout(binding = 9, rgba8) writeonly uniform image2D picture;
layout(scalar, binding = 22) uniform Chosen { Exposure exposure; };

layout(constant_id = 31) const bool kCalibrated = false;  // the display takes other than 0 to 1

vec4 developed(vec3 exposed, uvec2 pixel) {
  vec3 encoded = srgb_encode(tone_map(exposed));
  if (kCalibrated) encoded = displayed(encoded, frame.display_peak, frame.display_black);
  return vec4(dithered(encoded, pixel), 1.0);
}

// @param glow exposed light that the lens adds.
void put_pixel(uvec2 pixel, vec3 colour, vec3 glow, bool here) {
  uint black = subgroupAdd(here && colour == vec3(0.0) ? 1u : 0u);
  if (black != 0u && subgroupElect()) atomicAdd(stats.black, black);
  if (!here) return;
  if (!finite3(colour)) atomicAdd(stats.non_finite, 1u);
  imageStore(picture, ivec2(pixel), developed(sanitised(colour) * exp2(-exposure.ev) + glow, pixel));
}
void put_pixel(uvec2 pixel, vec3 colour, bool here) { put_pixel(pixel, colour, vec3(0.0), here); }
#else
layout(binding = 9, rgba16f) writeonly uniform image2D radiance;

void put_pixel(uvec2 pixel, vec3 colour, bool here) {
  if (!here) return;
  if (!finite3(colour)) atomicAdd(stats.non_finite, 1u);
  imageStore(radiance, ivec2(pixel), vec4(sanitised(colour), 1.0));
}
#endif
#endif
