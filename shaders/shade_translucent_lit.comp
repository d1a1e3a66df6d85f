#version 460
#extension GL_GOOGLE_include_directive : require
// Water and glass with shadow maps, under the frame's lights. docs/conventions.md.
#define SKERRY_SHADOWS
#define SKERRY_LIGHTS
#include "include/shade_translucent.glsl"
