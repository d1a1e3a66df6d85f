#version 460
// Overlay text and panels, in sRGB values as ImGui blends them. Pixels: docs/conventions.md.

layout(binding = 2) uniform sampler2D font;  // coverage in red

layout(location = 0) in vec2 in_uv;
layout(location = 1) in vec4 in_color;
layout(location = 2) flat in vec4 in_clip;
layout(location = 0) out vec4 out_color;

void main() {
  // A rectangle a draw instead of a scissor: the whole overlay is one draw.
  if (any(lessThan(gl_FragCoord.xy, in_clip.xy)) || any(greaterThanEqual(gl_FragCoord.xy, in_clip.zw))) discard;
  out_color = in_color * vec4(1.0, 1.0, 1.0, texture(font, in_uv).r);
}
