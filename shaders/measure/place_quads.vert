#version 460
#extension GL_GOOGLE_include_directive : require
// Small quads in rows over the whole picture, of six vertices each: `skerry bench device`. docs/conventions.md.
#include "shared/measure.h"

layout(location = 0) flat out uint out_word;

void main() {
  const vec2 kCorners[6] = vec2[](vec2(0, 0), vec2(0, 1), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(1, 0));
  uint quad = uint(gl_VertexIndex) / 6u;
  vec2 cell = vec2(quad % kMeasuredQuadsAcross, quad / kMeasuredQuadsAcross) + 0.8 * kCorners[gl_VertexIndex % 6];
  out_word = quad;
  gl_Position = vec4(2.0 * cell / float(kMeasuredQuadsAcross) - 1.0, 0.5, 1.0);
}
