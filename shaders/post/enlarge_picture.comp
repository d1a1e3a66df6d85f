#version 460
#extension GL_GOOGLE_include_directive : require
// A picture that was drawn smaller, at the size at which it is shown: linear between pixel centres, but steeper, so that edges stay sharper.
// docs/decisions/0035.
#extension GL_EXT_scalar_block_layout : require
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kSmallPictureBinding) uniform sampler2D small_picture;
layout(binding = kPictureBinding, rgba8) writeonly uniform image2D shown;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(shown);
  if (any(greaterThanEqual(pixel, size))) return;
  vec2 drawn = vec2(textureSize(small_picture, 0));
  vec2 at = (vec2(pixel) + 0.5) * (drawn / vec2(size)) - 0.5, first = floor(at);
  vec2 between = clamp((at - first - 0.5) * kEnlargeSlope + 0.5, vec2(0.0), vec2(1.0));
  imageStore(shown, pixel, textureLod(small_picture, (first + between + 0.5) / drawn, 0.0));
}
