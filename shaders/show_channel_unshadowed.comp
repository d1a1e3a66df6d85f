#version 460
#extension GL_GOOGLE_include_directive : require
// Debug views of frames without shadow maps. docs/conventions.md.
#include "include/show_channel.glsl"
