#version 460
#extension GL_GOOGLE_include_directive : require
// Leaves and plants. docs/conventions.md.
#include "include/write_cutout.glsl"
