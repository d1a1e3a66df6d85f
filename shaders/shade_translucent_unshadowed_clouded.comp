#version 460
#extension GL_GOOGLE_include_directive : require
// Water and glass under clouds in frames without shadow maps. docs/conventions.md.
#define SKERRY_CLOUDS
#include "include/shade_translucent.glsl"
