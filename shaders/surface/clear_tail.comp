#version 460
#extension GL_GOOGLE_include_directive : require
// Where the last layer has a surface, and so something may lie behind it: nothing is added up yet. docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kTailDepthsBinding, rgba32f) writeonly uniform image2D tail_depths;
layout(binding = kTailLightBinding, rgba32f) writeonly uniform image2D tail_light;

#include "include/scene/tiles.glsl"

void main() {
  uvec2 pixel;
  if (!tile_pixel(pixel)) return;
  imageStore(tail_depths, ivec2(pixel), vec4(0.0));
  imageStore(tail_light, ivec2(pixel), vec4(0.0));
}
