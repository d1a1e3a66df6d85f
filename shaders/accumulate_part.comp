#version 460
#extension GL_GOOGLE_include_directive : require
// Adds one part to a picture that is the mean of several frames (P. Haeberli and K. Akeley, The Accumulation Buffer, SIGGRAPH 1990).
#define SKERRY_ACCUMULATE
#include "include/average_samples.glsl"
