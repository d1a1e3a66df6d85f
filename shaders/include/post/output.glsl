// Where a shading pass puts its pixels: scene radiance, or, when nothing comes between it and the picture, the picture itself.
// Needs before the include: `frame`, `stats` (PixelStats).
#ifndef SKERRY_OUTPUT_GLSL
#define SKERRY_OUTPUT_GLSL
#include "shared/constants.h"
#include "include/post/picture.glsl"

layout(constant_id = kToPictureConstant) const bool kToPicture = false;  // if not, something is bound in place of the exposure

// Every invocation calls this once; `here` says which have a pixel. What is stored is finite.
void put_pixel(uvec2 pixel, vec3 colour, bool here) {
  if (kToPicture) {
    put_in_picture(pixel, colour, vec3(0.0), here);
  } else if (here) {
    if (!finite3(colour)) atomicAdd(stats.non_finite, 1u);
    imageStore(target, ivec2(pixel), vec4(as_halves(sanitised(colour)), 1.0));
  }
}
#endif
