#version 460
#extension GL_GOOGLE_include_directive : require
// The same for a G-buffer that also keeps normals or positions, for measuring. docs/conventions.md.
#define SKERRY_STORED
#include "include/scene/write_surface.glsl"
