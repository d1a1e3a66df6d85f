#version 460
#extension GL_GOOGLE_include_directive : require
// Deferred light without shadow maps from kept normals or positions, straight to the picture. docs/conventions.md.
#define SKERRY_STORED
#define SKERRY_TO_PICTURE
#include "include/shade_surfaces.glsl"
