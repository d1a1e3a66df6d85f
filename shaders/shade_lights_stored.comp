#version 460
#extension GL_GOOGLE_include_directive : require
// Deferred light of the frame's lights from kept normals or positions. docs/conventions.md.
#define SKERRY_STORED
#include "include/shade_lights.glsl"
