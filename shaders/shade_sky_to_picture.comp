#version 460
#extension GL_GOOGLE_include_directive : require
// Sky, straight to the picture. docs/conventions.md.
#define SKERRY_TO_PICTURE
#include "include/shade_sky.glsl"
