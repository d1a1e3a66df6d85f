#version 460
#extension GL_GOOGLE_include_directive : require
// Deferred light with shadow maps, to radiance. docs/conventions.md.
#define SKERRY_SHADOWS
#include "include/shade_surfaces.glsl"
