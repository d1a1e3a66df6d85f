#version 460
#extension GL_GOOGLE_include_directive : require
// Exposure, bloom, tone curve and sRGB encoding: scene radiance to the picture. docs/conventions.md.
#define SKERRY_BLOOM
#include "include/develop.glsl"
