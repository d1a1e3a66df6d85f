#version 460
#extension GL_GOOGLE_include_directive : require
// Clouds in a frame without geometry. docs/clouds.md.
#define SKERRY_SKY_ONLY
#include "include/blend_clouds.glsl"
