#version 460
// Opaque geometry: what surface is here. Everything else about it is worked out in compute, once a pixel. docs/conventions.md.
layout(location = 0) flat in uint in_surface;
layout(location = 0) out uint out_surface;

void main() { out_surface = in_surface; }
