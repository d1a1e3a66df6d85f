#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bindings.h"
// Overlay text and panels, in sRGB values as ImGui blends them. Pixels: docs/conventions.md.

layout(binding = kFontBinding) uniform sampler2D font;      // coverage in red
layout(binding = kOverlayPicturesBinding) uniform sampler2D pictures;  // sRGB values, straight alpha

layout(location = 0) in vec2 in_uv;
layout(location = 1) in vec4 in_color;
layout(location = 2) flat in vec4 in_clip;
layout(location = 3) flat in uint in_picture;
layout(location = 0) out vec4 out_color;

void main() {
  // A rectangle a draw instead of a scissor: the whole overlay is one draw.
  if (any(lessThan(gl_FragCoord.xy, in_clip.xy)) || any(greaterThanEqual(gl_FragCoord.xy, in_clip.zw))) discard;
  // Neither has mips, so that a divergent branch needs no derivatives.
  out_color = in_color * (in_picture != 0u ? textureLod(pictures, in_uv, 0.0)
                                           : vec4(1.0, 1.0, 1.0, textureLod(font, in_uv, 0.0).r));
}
