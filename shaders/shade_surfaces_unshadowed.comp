#version 460
#extension GL_GOOGLE_include_directive : require
// Deferred light for frames without shadow maps: no body gives light, or shadows are switched off. docs/conventions.md.
#include "include/shade_surfaces.glsl"
