#version 460
#extension GL_GOOGLE_include_directive : require
// The surfaces that sum_glass.frag adds up, one by one: the nearest to the body behind the one found before, if any, for what glass takes of the light of other glass and of
// water. Peeled as write_layer.frag does. docs/decisions/0090.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "include/surface/touched.glsl"

layout(location = 0) flat in uint in_surface;
layout(location = 1) in vec2 in_touched;  // x: see draw_quads.vert
layout(location = 0) out uvec2 out_found;  // x: depth; y: listed_glass()

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;
layout(binding = kPreviousDepthsBinding) uniform sampler2D previous_depth;  // of the surface before; for the first one not read

layout(constant_id = kFirstLayerConstant) const bool kFirstLayer = true;

layout(push_constant, scalar) uniform Push {
  layout(offset = 76) uint cascade;  // of frame.cascades; what draw_quads.vert declares comes before
} push;

#include "include/surface/media.glsl"
#include "include/light/listed_glass.glsl"

void main() {
  bool entering = gl_FrontFacing;
  uint touched = touched_number(in_touched.x);
  if (!entering && touched != 0u) discard;
  ivec2 most = textureSize(shadow_maps, 0).xy - 1;
  ivec2 texel = min(ivec2(floor(gl_FragCoord.xy / (kListedTexels * frame.glass_per_texel))), most);
  float z = gl_FragCoord.z;
  if (z <= texelFetch(shadow_maps, ivec3(texel, int(frame.cascades[push.cascade].layer)), 0).r) discard;
  if (!kFirstLayer && z >= texelFetch(previous_depth, ivec2(gl_FragCoord.xy), 0).r) discard;
  uint block = surface_block(in_surface), beside = touched != 0u ? materials[touched].translucent_block : 0u;
  uint entered = entering ? block : 0u, left = entering ? beside : block;
  if (glass_extinction(entered) == glass_extinction(left)) discard;
  out_found = uvec2(floatBitsToUint(z), listed_glass(entered, left));
}
