#version 460
#extension GL_GOOGLE_include_directive : require
// One layer of translucent surfaces: the nearest one behind the previous layer and before the opaque surface (depth peeling, Everitt 2001).
// docs/conventions.md.
#include "include/frame/common.glsl"
#include "include/surface/touched.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(location = 0) flat in uint in_surface;
layout(location = 1) in vec2 in_touched;  // x: see draw_quads.vert
layout(location = 0) out uint out_surface;

layout(binding = kDepthsBinding) uniform sampler2D opaque_depth;
layout(binding = kPreviousDepthsBinding) uniform sampler2D previous_depth;  // of the layer before; for the first layer the opaque depth again, unread

layout(constant_id = kFirstLayerConstant) const bool kFirstLayer = true;

// Walls along a shore grow by a part of a pixel (draw_quads.vert) and would stand out of the water: as a share of the distance, far less than voxels
// of any level are long.
const float kBehind = 1.0 - 2e-4;

void main() {
  if (!gl_FrontFacing && touches_another(in_touched.x)) discard;
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float z = gl_FragCoord.z;  // reverse-Z: nearer is greater
  float opaque = texelFetch(opaque_depth, pixel, 0).r;
  if (z <= opaque * kBehind) discard;
  if (!kFirstLayer && z >= texelFetch(previous_depth, pixel, 0).r) discard;
  // Which side faces the camera distinguishes a block's back from its front.
  out_surface = gl_FrontFacing ? in_surface : in_surface ^ kOppositeFace;
}
