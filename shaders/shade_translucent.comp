#version 460
#extension GL_GOOGLE_include_directive : require
// Water and glass with shadow maps. docs/conventions.md.
#define SKERRY_SHADOWS
#include "include/shade_translucent.glsl"
