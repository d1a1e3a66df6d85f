#version 460
#extension GL_GOOGLE_include_directive : require
// Mirrored clouds in a frame without shadow maps. docs/clouds.md.
#include "include/march_mirrored_clouds.glsl"
