#version 460
#extension GL_GOOGLE_include_directive : require
// Opaque blocks, leaves and plants: what surface is here. Everything else about it is worked out in compute, once a pixel. docs/conventions.md.
#include "include/scene/write_surface.glsl"
