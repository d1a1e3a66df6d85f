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
// Of the first layer: the block in bits 0-9; in bits 16-31, as a half, how deep below its surface lies what is opaque [blocks], if the layer
// is the surface of level water seen from above, else 0.
layout(location = 1) out uint out_under_water;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kDepthsBinding) uniform sampler2D opaque_depth;
layout(binding = kPreviousDepthsBinding) uniform sampler2D previous_depth;  // of the layer before; for the first layer the opaque depth again, unread

layout(constant_id = kFirstLayerConstant) const bool kFirstLayer = true;

#include "include/surface/ripples.glsl"

// @param opaque depth.
float blocks_above(uint word, float z, float opaque) {
  vec3 up = world_from_lattice_vector(island_at(surface_island(word)), vec3(0.0, 1.0, 0.0));
  float behind = view_distance(opaque, frame.near_plane) - view_distance(z, frame.near_plane);
  return behind * -dot(up, pixel_ray(uvec2(gl_FragCoord.xy)));
}

void main() {
  if (!gl_FrontFacing && touches_another(in_touched.x)) discard;
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float z = gl_FragCoord.z;  // reverse-Z: nearer is greater
  float opaque = texelFetch(opaque_depth, pixel, 0).r;
  if (z <= opaque) discard;
  if (!kFirstLayer && z >= texelFetch(previous_depth, pixel, 0).r) discard;
  // Which side faces the camera distinguishes a block's back from its front.
  out_surface = gl_FrontFacing ? in_surface : in_surface ^ kOppositeFace;
  if (!kFirstLayer) return;
  bool level = gl_FrontFacing && opaque > 0.0 && surface_face(in_surface) == 2u && has_ripples(in_surface);
  float above = level ? blocks_above(in_surface, z, opaque) : 0.0;
  out_under_water = surface_block(in_surface) | (packHalf2x16(vec2(above, 0.0)) << 16);
}
