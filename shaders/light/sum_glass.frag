#version 460
#extension GL_GOOGLE_include_directive : require
// Glass as a body sees it: its optical depth up to the nearest opaque surface behind it, which is what that body lights, summed up over the surfaces
// of glass in any order. Each counts the way from itself to what is opaque, positive where glass begins and negative where it ends.
// docs/decisions/0069.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "include/surface/touched.glsl"

layout(location = 0) flat in uint in_surface;
layout(location = 1) in vec2 in_touched;  // x: see draw_quads.vert
layout(location = 0) out vec4 out_depth;  // rgb

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;

layout(push_constant, scalar) uniform Push {
  layout(offset = 76) uint cascade;  // of frame.cascades; what draw_quads.vert declares comes before
} push;

#include "include/surface/media.glsl"
#include "include/light/listed_glass.glsl"

void main() {
  bool entering = gl_FrontFacing;
  uint touched = touched_number(in_touched.x);
  if (!entering && touched != 0u) discard;
  Cascade c = frame.cascades[push.cascade];
  ivec2 most = textureSize(shadow_maps, 0).xy - 1;
  ivec2 texel = min(ivec2(floor(gl_FragCoord.xy / frame.glass_per_texel)), most);
  float opaque = texelFetch(shadow_maps, ivec3(texel, int(c.layer)), 0).r;
  if (gl_FragCoord.z <= opaque) discard;
  float blocks = (gl_FragCoord.z - opaque) / c.depth_per_block;
  vec3 begun = entering ? glass_extinction(surface_block(in_surface)) : -glass_extinction(surface_block(in_surface));
  if (touched != 0u) begun -= glass_extinction(materials[touched].translucent_block);
  out_depth = vec4(begun * blocks, 0.0);
}
