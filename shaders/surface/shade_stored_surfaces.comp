#version 460
#extension GL_GOOGLE_include_directive : require
// As shade_surfaces.comp, from a G-buffer that keeps normals or positions, and without shafts: a program binds 32 things at most.
#define SKERRY_STORED
#include "include/surface/shade_surfaces.glsl"
