#version 460
// Overlay triangles, pulled from a buffer. Pixels: docs/conventions.md.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared/overlay.h"
#include "shared/bindings.h"

layout(binding = kOverlayVerticesBinding, scalar) readonly buffer Vertices { OverlayVertex vertices[]; };
layout(binding = kOverlayClipsBinding, scalar) readonly buffer Clips { vec4 clips[]; };  // min x, min y, max x, max y [pixels]
layout(push_constant, scalar) uniform Constants { OverlayConstants constants; };

layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_color;
layout(location = 2) flat out vec4 out_clip;
layout(location = 3) flat out uint out_picture;

void main() {
  const OverlayVertex vertex = vertices[gl_VertexIndex];
  out_uv = vertex.uv;
  out_color = unpackUnorm4x8(vertex.color);
  out_clip = clips[vertex.clip & ~kOverlayPicture];
  out_picture = vertex.clip & kOverlayPicture;
  gl_Position = vec4(vertex.position * constants.ndc_from_pixel - 1.0, 0.0, 1.0);
}
