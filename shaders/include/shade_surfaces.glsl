// Body of shade_surfaces*.comp: light for every pixel that shows a surface, sky for every other. One include, two programs, because a frame
// without shadow maps has no image to bind for them.
#include "include/common.glsl"
#include "shared/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) uniform Islands { IslandTransform islands[kMaxIslands]; };
layout(scalar, binding = 2) uniform Materials { Material materials[kMaxMaterials]; };
layout(scalar, binding = 3) uniform Sky { SkyConstants sky; };
layout(scalar, binding = 4) buffer Stats { PixelStats stats; };
layout(binding = 5, r32ui) readonly uniform uimage2D surfaces;
layout(binding = 6) uniform sampler2D depths;
layout(binding = 7) uniform sampler2DArray block_textures;
layout(binding = 8) uniform sampler2D sky_lut;
layout(binding = 9, rgba16f) writeonly uniform image2D radiance;
#ifdef SKERRY_SHADOWS
layout(binding = 10) uniform sampler2DArray shadow_maps;
#include "include/shadow.glsl"
#endif

layout(constant_id = 0) const uint kTextureTaps = 2u;

#include "include/surface.glsl"
#include "include/lighting.glsl"
#include "include/sky.glsl"
#include "include/stars.glsl"

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, frame.size))) return;
  uint word = imageLoad(surfaces, ivec2(pixel)).r;
  float depth = texelFetch(depths, ivec2(pixel), 0).r;
  vec3 ray = pixel_ray(pixel);
  vec3 colour = vec3(0.0);
  // Loops, not branches: lavapipe skips an empty loop but runs both sides of a branch.
  for (int once = word != 0u ? 1 : 0; once > 0; --once) colour = shade_diffuse(resolve_surface(word, depth, ray, kTextureTaps));
  for (int once = word == 0u ? 1 : 0; once > 0; --once) colour = sky_seen(normalize(ray));
  if (!finite3(colour)) atomicAdd(stats.non_finite, 1u);
  imageStore(radiance, ivec2(pixel), vec4(sanitised(colour), 1.0));
}
