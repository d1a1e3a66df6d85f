#version 460
#extension GL_GOOGLE_include_directive : require
// A frame without any geometry: sky alone, to radiance. docs/conventions.md.
#define SKERRY_EVERYWHERE
#include "include/shade_sky.glsl"
