#version 460
#extension GL_GOOGLE_include_directive : require
// Clouds in a frame without shadow maps, under the frame's lights. docs/clouds.md.
#define SKERRY_LIGHTS
#include "include/march_clouds.glsl"
