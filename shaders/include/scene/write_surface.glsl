// Body of write_surface.frag and of its twins with more outputs: what surface is here.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#ifdef SKERRY_STORED
#include "include/scene/write_stored.glsl"
#endif

layout(location = 0) flat in uint in_surface;
layout(location = 1) in vec2 in_uv;
layout(location = 0, component = 1) flat in uvec2 in_blend;
layout(location = 0) out uint out_surface;

layout(constant_id = kTexturedConstant) const bool kTextured = false;              // leaves and plants; else opaque blocks
layout(constant_id = kFinestCoverageConstant) const bool kFinestCoverage = false;  // where several samples make a pixel: their mean is its coverage

layout(constant_id = kBlendedConstant) const bool kBlended = false;                // the same, and all of sections that change their level

#include "include/scene/cutout.glsl"
#include "include/scene/blend.glsl"

void main() {
  if (kTextured) discard_uncovered(in_surface, kBlended && in_blend.y != 0u);
  // Of sections that change their level one program draws all; without textures there is no cut-out to be seen.
  bool left_out = is_blended_out(in_blend.x, uvec2(gl_FragCoord.xy)) || (!kTextured && in_blend.y == 0u);
  if (kBlended && left_out) discard;
  out_surface = in_surface;
#ifdef SKERRY_STORED
  write_stored(in_surface);
#endif
}
