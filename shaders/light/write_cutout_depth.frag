#version 460
#extension GL_GOOGLE_include_directive : require
// Leaves and plants in a shadow map. docs/conventions.md.
#include "include/frame/common.glsl"

layout(location = 0) flat in uint in_surface;
layout(location = 1) in vec2 in_uv;

const bool kFinestCoverage = true;  // the map's filter averages what several of its own texels hit

#include "include/scene/cutout.glsl"

void main() { discard_uncovered(in_surface, false); }
