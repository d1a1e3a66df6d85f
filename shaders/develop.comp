#version 460
#extension GL_GOOGLE_include_directive : require
// Exposure, tone curve and sRGB encoding: scene radiance to the picture. docs/conventions.md.
#include "include/common.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) buffer Stats { PixelStats stats; };
layout(binding = 2, rgba16f) readonly uniform image2D radiance;
layout(binding = 3, rgba8) writeonly uniform image2D picture;

#include "include/tonemap.glsl"

shared uint black_pixels;

void main() {
  if (gl_LocalInvocationIndex == 0u) black_pixels = 0u;
  barrier();
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (all(lessThan(pixel, frame.size))) {
    vec3 c = imageLoad(radiance, ivec2(pixel)).rgb;
    if (!finite3(c)) atomicAdd(stats.non_finite, 1u);
    c = sanitised(c);
    if (c == vec3(0.0)) atomicAdd(black_pixels, 1u);
    imageStore(picture, ivec2(pixel), vec4(dithered(srgb_encode(tone_map(c * frame.exposure)), pixel), 1.0));
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u && black_pixels != 0u) atomicAdd(stats.black, black_pixels);
}
