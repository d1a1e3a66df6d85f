#version 460
#extension GL_GOOGLE_include_directive : require
// Deferred light of frames without shadow maps, to radiance. docs/conventions.md.
#include "include/shade_surfaces.glsl"
