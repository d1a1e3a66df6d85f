// Leaves and plants: surfaces where the texture's alpha covers the pixel. Needs before the include: common.glsl, `in_uv`,
// `kFinestCoverage`.
#ifndef SKERRY_CUTOUT_GLSL
#define SKERRY_CUTOUT_GLSL
#include "shared/bindings.h"

layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;

void discard_uncovered(uint surface) {
  Material material = materials[surface_block(surface)];
  uint face = surface_face(surface);
  uint layer = face == 2u ? material.layer_top : face == 3u ? material.layer_bottom : material.layer_side;
  vec3 uv = vec3(face >= 6u ? plant_uv(in_uv) : in_uv, float(layer));
  float alpha = kFinestCoverage ? textureLod(block_textures, uv, 0.0).a : texture(block_textures, uv).a;
  // Leaves are seen from the front: whether their backs are drawn must not depend on which ranges of a section are culled.
  bool behind = face < kFaceCount && !gl_FrontFacing;
  if (behind || alpha < 0.5) discard;
}
#endif
