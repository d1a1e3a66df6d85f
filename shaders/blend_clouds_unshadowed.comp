#version 460
#extension GL_GOOGLE_include_directive : require
// Clouds in a frame without shadow maps. docs/clouds.md.
#include "include/blend_clouds.glsl"
