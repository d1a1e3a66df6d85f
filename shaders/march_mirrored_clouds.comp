#version 460
#extension GL_GOOGLE_include_directive : require
// Mirrored clouds that islands may shade. docs/clouds.md.
#define SKERRY_SHADOWS
#include "include/march_mirrored_clouds.glsl"
