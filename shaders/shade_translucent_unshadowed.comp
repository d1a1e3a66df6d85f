#version 460
#extension GL_GOOGLE_include_directive : require
// Water and glass in frames without shadow maps. docs/conventions.md.
#include "include/shade_translucent.glsl"
