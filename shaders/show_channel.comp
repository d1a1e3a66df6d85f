#version 460
#extension GL_GOOGLE_include_directive : require
// Debug views with shadow maps. docs/conventions.md.
#define SKERRY_SHADOWS
#include "include/show_channel.glsl"
