#version 460
#extension GL_GOOGLE_include_directive : require
// A picture that was drawn smaller, at the size at which it is shown: linear between pixel centres, but steeper, so that edges stay sharper.
// docs/decisions/0035.
#extension GL_EXT_scalar_block_layout : require
#include "shared/bindings.h"
#include "shared/constants.h"

layout(binding = kSmallPictureBinding) uniform sampler2D small_picture;
layout(push_constant, scalar) uniform Constants { vec2 drawn_from_shown; };  // pixels
layout(location = 0) out vec4 shown;

void main() {
  vec2 at = gl_FragCoord.xy * drawn_from_shown - 0.5, first = floor(at);
  vec2 between = clamp((at - first - 0.5) * kEnlargeSlope + 0.5, vec2(0.0), vec2(1.0));
  shown = textureLod(small_picture, (first + between + 0.5) / vec2(textureSize(small_picture, 0)), 0.0);
}
