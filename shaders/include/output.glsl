// Where a shading pass puts its pixels: scene radiance, or, when nothing comes between it and the picture, the picture itself.
// Needs before the include: `frame`, `stats` (PixelStats).
#ifndef SKERRY_OUTPUT_GLSL
#define SKERRY_OUTPUT_GLSL
#include "include/tonemap.glsl"

#ifdef SKERRY_TO_PICTURE
layout(binding = 9, rgba8) writeonly uniform image2D picture;
#else
layout(binding = 9, rgba16f) writeonly uniform image2D radiance;
#endif

shared uint black_pixels;

vec4 developed(vec3 colour, uvec2 pixel) { return vec4(dithered(srgb_encode(tone_map(colour * frame.exposure)), pixel), 1.0); }

// Every invocation of the work group calls it once; `here` tells which have a pixel. What is stored is finite.
void put_pixel(uvec2 pixel, vec3 colour, bool here) {
#ifdef SKERRY_TO_PICTURE
  if (gl_LocalInvocationIndex == 0u) black_pixels = 0u;
  barrier();
#endif
  if (here) {
    if (!finite3(colour)) atomicAdd(stats.non_finite, 1u);
    colour = sanitised(colour);
#ifdef SKERRY_TO_PICTURE
    if (colour == vec3(0.0)) atomicAdd(black_pixels, 1u);
    imageStore(picture, ivec2(pixel), developed(colour, pixel));
#else
    imageStore(radiance, ivec2(pixel), vec4(colour, 1.0));
#endif
  }
#ifdef SKERRY_TO_PICTURE
  barrier();
  if (gl_LocalInvocationIndex == 0u && black_pixels != 0u) atomicAdd(stats.black, black_pixels);
#endif
}
#endif
