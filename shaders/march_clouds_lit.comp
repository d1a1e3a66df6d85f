#version 460
#extension GL_GOOGLE_include_directive : require
// Clouds that islands may shade, under the frame's lights. docs/clouds.md.
#define SKERRY_SHADOWS
#define SKERRY_LIGHTS
#include "include/march_clouds.glsl"
