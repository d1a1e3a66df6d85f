// Leaves and plants: surfaces where the texture covers the pixel. Needs before the include: common.glsl, `in_uv`,
// `kFinestCoverage`.
#ifndef SKERRY_CUTOUT_GLSL
#define SKERRY_CUTOUT_GLSL
#include "shared/bindings.h"
#include "include/scene/face_layer.glsl"

layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;  // their coverage: render::coverage_texels()

// Level of a texture whose coordinates change from pixel to pixel as `uv` does. Drivers work theirs out each in their own way, by up to half a
// level apart, and leaves would have other edges.
float texture_level(vec2 uv) {
  vec2 dx = dFdxFine(uv) * kTextureEdge, dy = dFdyFine(uv) * kTextureEdge;
  return 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-12));
}

// @param whole the quad is opaque: its texture says nothing.
void discard_uncovered(uint surface, bool whole) {
  uint face = surface_face(surface);
  uint layer = face_layer(face, surface_block(surface));
  vec2 uv = face >= 6u ? plant_uv(in_uv) : in_uv;
  float alpha = textureLod(block_textures, vec3(uv, float(layer)), kFinestCoverage ? 0.0 : texture_level(uv)).r;
  // Leaves are seen from the front: whether their backs are drawn must not depend on which ranges of a section are culled.
  bool behind = face < kFaceCount && !gl_FrontFacing;
  if (behind || (!whole && alpha < 0.5)) discard;
}
#endif
