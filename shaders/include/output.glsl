// Where a shading pass puts its pixels: scene radiance, or, when nothing comes between it and the picture, the picture itself.
// Needs before the include: `frame`, `stats` (PixelStats).
#ifndef SKERRY_OUTPUT_GLSL
#define SKERRY_OUTPUT_GLSL
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "include/tonemap.glsl"

#ifdef SKERRY_TO_PICTURE
#include "shared/exposure.h"
layout(binding = 9, rgba8) writeonly uniform image2D picture;
layout(scalar, binding = 22) uniform Chosen { Exposure exposure; };

layout(constant_id = 31) const bool kCalibrated = false;  // the display takes other than 0 to 1

vec4 developed(vec3 colour, uvec2 pixel) {
  vec3 encoded = srgb_encode(tone_map(colour * exp2(-exposure.ev)));
  if (kCalibrated) encoded = displayed(encoded, frame.display_peak, frame.display_black);
  return vec4(dithered(encoded, pixel), 1.0);
}
#else
layout(binding = 9, rgba16f) writeonly uniform image2D radiance;
#endif

// Every invocation calls it once; `here` tells which have a pixel. What is stored is finite.
void put_pixel(uvec2 pixel, vec3 colour, bool here) {
#ifdef SKERRY_TO_PICTURE
  uint black = subgroupAdd(here && colour == vec3(0.0) ? 1u : 0u);
  if (black != 0u && subgroupElect()) atomicAdd(stats.black, black);
#endif
  if (here) {
    if (!finite3(colour)) atomicAdd(stats.non_finite, 1u);
    colour = sanitised(colour);
#ifdef SKERRY_TO_PICTURE
    imageStore(picture, ivec2(pixel), developed(colour, pixel));
#else
    imageStore(radiance, ivec2(pixel), vec4(colour, 1.0));
#endif
  }
}
#endif
