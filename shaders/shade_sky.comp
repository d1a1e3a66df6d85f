#version 460
#extension GL_GOOGLE_include_directive : require
// Sky, to radiance. docs/conventions.md.
#include "include/shade_sky.glsl"
