#version 460
#extension GL_GOOGLE_include_directive : require
// Deferred light of the frame's lights. docs/conventions.md.
#include "include/shade_lights.glsl"
