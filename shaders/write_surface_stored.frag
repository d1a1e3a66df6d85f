#version 460
#extension GL_GOOGLE_include_directive : require
// Opaque geometry of a G-buffer that also keeps normals or positions, for measuring. docs/conventions.md.
#include "include/write_surface_stored.glsl"
