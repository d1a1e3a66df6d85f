#version 460
#extension GL_GOOGLE_include_directive : require
// Deferred light under clouds, with shadow maps, from kept normals or positions, to radiance. docs/conventions.md.
#define SKERRY_SHADOWS
#define SKERRY_STORED
#define SKERRY_CLOUDS
#include "include/shade_surfaces.glsl"
