#version 460
#extension GL_GOOGLE_include_directive : require
#define SKERRY_SHAFTS
#include "include/surface/shade_surfaces.glsl"
