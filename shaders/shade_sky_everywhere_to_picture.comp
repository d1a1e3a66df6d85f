#version 460
#extension GL_GOOGLE_include_directive : require
// A frame without any geometry: sky alone, straight to the picture. docs/conventions.md.
#define SKERRY_TO_PICTURE
#define SKERRY_EVERYWHERE
#include "include/shade_sky.glsl"
