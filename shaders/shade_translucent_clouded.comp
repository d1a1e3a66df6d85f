#version 460
#extension GL_GOOGLE_include_directive : require
// Water and glass under clouds with shadow maps. docs/conventions.md.
#define SKERRY_SHADOWS
#define SKERRY_CLOUDS
#include "include/shade_translucent.glsl"
