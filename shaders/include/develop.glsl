// Body of develop*.comp. One include, two programs: a picture without bloom has no image of it to bind.
#define SKERRY_TO_PICTURE
#include "include/common.glsl"
#include "shared/bloom.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) buffer Stats { PixelStats stats; };
layout(binding = 2, rgba16f) readonly uniform image2D radiance;
#ifdef SKERRY_BLOOM
layout(binding = 3, rgba16f) readonly uniform image2D coarse;
layout(push_constant) uniform Push { BloomStep step; } push;
uvec2 coarse_size() { return push.step.coarse_size; }
#include "include/bloom.glsl"
#endif

#include "include/output.glsl"

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  bool here = all(lessThan(pixel, frame.picture_size));
  vec3 colour = imageLoad(radiance, ivec2(min(pixel, frame.picture_size - 1u))).rgb;
#ifdef SKERRY_BLOOM
  put_pixel(pixel, colour, push.step.intensity * spread_from_coarser(), here);
#else
  put_pixel(pixel, colour, vec3(0.0), here);
#endif
}
