#version 460
#extension GL_GOOGLE_include_directive : require
// Water and glass under clouds, without shadow maps, with the frame's lights. docs/conventions.md.
#define SKERRY_LIGHTS
#define SKERRY_CLOUDS
#include "include/shade_translucent.glsl"
