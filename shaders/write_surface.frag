#version 460
#extension GL_GOOGLE_include_directive : require
// Opaque geometry: what surface is here. Everything else about it is worked out in compute, once a pixel; normals or positions are kept for
// measuring alone. docs/conventions.md.
#include "include/common.glsl"
#include "include/write_stored.glsl"

layout(location = 0) flat in uint in_surface;
layout(location = 0) out uint out_surface;

void main() {
  out_surface = in_surface;
  if (kStored) write_stored(in_surface);
}
