// Body of shade_sky*.comp: the pixels that show sky, by tiles; or all of them, in a frame without geometry.
#include "include/common.glsl"
#include "shared/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 3) uniform Sky { SkyConstants sky; };
layout(scalar, binding = 4) buffer Stats { PixelStats stats; };
#ifndef SKERRY_EVERYWHERE
layout(binding = 5, r32ui) readonly uniform uimage2D surfaces;
#endif
layout(binding = 8) uniform sampler2D sky_lut;

layout(constant_id = 0) const bool kStars = true;  // false by day
layout(constant_id = 1) const bool kDiscs = true;  // false when neither sun nor moon is in the picture

#ifndef SKERRY_EVERYWHERE
#include "include/tiles.glsl"
#endif
#include "include/output.glsl"
#include "include/sky.glsl"
#include "include/stars.glsl"

void main() {
#ifdef SKERRY_EVERYWHERE
  uvec2 pixel = gl_GlobalInvocationID.xy;
  bool here = all(lessThan(pixel, frame.size));
#else
  uvec2 pixel;
  bool here = tile_pixel(pixel);
  here = here && imageLoad(surfaces, ivec2(pixel)).r == 0u;
#endif
  put_pixel(pixel, sky_seen(normalize(pixel_ray(pixel)), kStars, kDiscs), here);
}
