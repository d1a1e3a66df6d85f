#version 460
#extension GL_GOOGLE_include_directive : require
// Exposure, tone curve and sRGB encoding: scene radiance to the picture, after passes that need radiance. docs/conventions.md.
#include "include/develop.glsl"
