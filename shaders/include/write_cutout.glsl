// Body of write_cutout.frag and of its twins with other outputs: leaves and plants, the same as opaque geometry where the texture's alpha covers the pixel.
#include "shared/bindings.h"
#include "shared/constants.h"
#include "include/common.glsl"
#ifdef SKERRY_STORED
#include "include/write_stored.glsl"
#endif

layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;

#ifdef SKERRY_DEPTH_ONLY
const bool kFinestCoverage = true;  // a shadow map's filter averages what several of its own texels hit
#else
layout(constant_id = kFinestCoverageConstant) const bool kFinestCoverage = false;  // where several samples make a pixel: their mean is its coverage
layout(location = 0) out uint out_surface;
#endif

layout(location = 0) flat in uint in_surface;
layout(location = 1) in vec2 in_uv;

void main() {
  Material material = materials[surface_block(in_surface)];
  uint face = surface_face(in_surface);
  uint layer = face == 2u ? material.layer_top : face == 3u ? material.layer_bottom : material.layer_side;
  vec3 uv = vec3(face >= 6u ? plant_uv(in_uv) : in_uv, float(layer));
  float alpha = kFinestCoverage ? textureLod(block_textures, uv, 0.0).a : texture(block_textures, uv).a;
  // Leaves are seen from the front: whether their backs are drawn must not depend on which ranges of a section are culled.
  bool behind = face < kFaceCount && !gl_FrontFacing;
  if (behind || alpha < 0.5) discard;
#ifndef SKERRY_DEPTH_ONLY
  out_surface = in_surface;
#endif
#ifdef SKERRY_STORED
  write_stored(in_surface);
#endif
}
