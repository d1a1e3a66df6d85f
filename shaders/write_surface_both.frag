#version 460
#extension GL_GOOGLE_include_directive : require
// Opaque geometry of a G-buffer that also keeps normals and positions, for measuring. docs/conventions.md.
#define SKERRY_STORED_BOTH
#include "include/write_surface_stored.glsl"
