#version 460
#extension GL_GOOGLE_include_directive : require
// A frame without any geometry: sky alone. docs/conventions.md.
#include "include/common.glsl"
#include "shared/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 3) uniform Sky { SkyConstants sky; };
layout(scalar, binding = 4) buffer Stats { PixelStats stats; };
layout(binding = 8) uniform sampler2D sky_lut;
layout(binding = 9, rgba16f) writeonly uniform image2D radiance;

#include "include/sky.glsl"
#include "include/stars.glsl"

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, frame.size))) return;
  vec3 colour = sky_seen(normalize(pixel_ray(pixel)));
  if (!finite3(colour)) atomicAdd(stats.non_finite, 1u);
  imageStore(radiance, ivec2(pixel), vec4(sanitised(colour), 1.0));
}
