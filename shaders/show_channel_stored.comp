#version 460
#extension GL_GOOGLE_include_directive : require
// Debug views with shadow maps from kept normals or positions. docs/conventions.md.
#define SKERRY_SHADOWS
#define SKERRY_STORED
#include "include/show_channel.glsl"
