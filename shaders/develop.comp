#version 460
#extension GL_GOOGLE_include_directive : require
// Exposure, tone curve and sRGB encoding: scene radiance to the picture, after passes that need radiance. docs/conventions.md.
#define SKERRY_TO_PICTURE
#include "include/common.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) buffer Stats { PixelStats stats; };
layout(binding = 2, rgba16f) readonly uniform image2D radiance;

#include "include/output.glsl"

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  bool here = all(lessThan(pixel, frame.picture_size));
  put_pixel(pixel, imageLoad(radiance, ivec2(min(pixel, frame.picture_size - 1u))).rgb, here);
}
