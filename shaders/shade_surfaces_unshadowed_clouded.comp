#version 460
#extension GL_GOOGLE_include_directive : require
// Deferred light under clouds of frames without shadow maps, to radiance. docs/conventions.md.
#define SKERRY_CLOUDS
#include "include/shade_surfaces.glsl"
