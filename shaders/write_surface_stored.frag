#version 460
#extension GL_GOOGLE_include_directive : require
// Opaque geometry of a G-buffer that also keeps normals or positions, for measuring. docs/conventions.md.
#include "include/common.glsl"
#include "include/write_stored.glsl"

layout(location = 0) flat in uint in_surface;
layout(location = 0) out uint out_surface;

void main() {
  out_surface = in_surface;
  write_stored(in_surface);
}
