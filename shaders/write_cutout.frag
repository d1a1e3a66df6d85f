#version 460
#extension GL_GOOGLE_include_directive : require
// Leaves and plants: the same as opaque geometry where the texture's alpha covers the pixel. docs/conventions.md.
#include "shared/bindings.h"
#include "shared/constants.h"
#include "include/common.glsl"
#include "include/write_stored.glsl"

layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;

layout(constant_id = kWriteSurfaceConstant) const bool kWriteSurface = true;  // false in shadow passes, which have depth only
layout(constant_id = kFinestCoverageConstant) const bool kFinestCoverage = false;  // where several samples make a pixel: their mean is its coverage

layout(location = 0) flat in uint in_surface;
layout(location = 1) in vec2 in_uv;
layout(location = 0) out uint out_surface;

void main() {
  Material material = materials[surface_block(in_surface)];
  uint face = surface_face(in_surface);
  uint layer = face == 2u ? material.layer_top : face == 3u ? material.layer_bottom : material.layer_side;
  // A shadow map takes the finest texels: its filter averages what several of its own texels hit.
  vec3 uv = vec3(face >= 6u ? plant_uv(in_uv) : in_uv, float(layer));
  float alpha = kWriteSurface && !kFinestCoverage ? texture(block_textures, uv).a : textureLod(block_textures, uv, 0.0).a;
  // Leaves are seen from the front: whether their backs are drawn must not depend on which ranges of a section are culled.
  bool behind = face < kFaceCount && !gl_FrontFacing;
  if (behind || alpha < 0.5) discard;
  if (kWriteSurface) out_surface = in_surface;
  if (kStored) write_stored(in_surface);
}
