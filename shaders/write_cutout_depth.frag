#version 460
#extension GL_GOOGLE_include_directive : require
// Leaves and plants in a shadow map. docs/conventions.md.
#define SKERRY_DEPTH_ONLY
#include "include/write_cutout.glsl"
