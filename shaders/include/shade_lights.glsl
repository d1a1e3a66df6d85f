// Body of shade_lights*.comp: adds the light of the clusters' lights to the surfaces of the tiles that have any, in place on the radiance image.
// The air only takes from it: haze glows of sun and moon alone.
#include "include/common.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) uniform Islands { IslandTransform islands[kMaxIslands]; };
layout(scalar, binding = 2) uniform Materials { Material materials[kMaxMaterials]; };
layout(scalar, binding = 4) buffer Stats { PixelStats stats; };
layout(binding = 5, r32ui) readonly uniform uimage2D surfaces;
layout(binding = 6) uniform sampler2D depths;
layout(binding = 7) uniform sampler2DArray block_textures;
layout(binding = 9, rgba16f) uniform image2D radiance;

layout(constant_id = 0) const uint kTextureTaps = 2u;

#include "include/tiles.glsl"
#include "include/surface.glsl"
#include "include/reflection.glsl"
#include "include/corners.glsl"
#include "include/clustered.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel);
  uint word = imageLoad(surfaces, ivec2(pixel)).r;
  here = here && word != 0u;
  float depth = here ? surface_depth(texelFetch(depths, ivec2(pixel), 0).r) : 1.0;
  Cluster list = lights_at(pixel, view_distance(depth, frame.near_plane));
  if (!here) list.count = 0u;
  Surface s = resolve_surface(word, ivec2(pixel), depth, pixel_ray(pixel), kTextureTaps);
  vec3 to_eye = -normalize(s.position);
  Brdf b = surface_brdf(s, to_eye);
  vec3 light = vec3(0.0);
  // Two a round for the oracle: lavapipe ends loops after 65,535 rounds.
  for (uint i = 0u; i < list.count; ++i) {
    light += light_reflected(lights[light_index(list, i)], b, s.position, s.normal, to_eye);
    if (kOracle && ++i < list.count) light += light_reflected(lights[light_index(list, i)], b, s.position, s.normal, to_eye);
  }
  vec3 colour = imageLoad(radiance, ivec2(pixel)).rgb + light * (surface_openness(s, word) * clear_air(s.position));
  if (here && !finite3(colour)) atomicAdd(stats.non_finite, 1u);
  if (here) imageStore(radiance, ivec2(pixel), vec4(sanitised(colour), 1.0));
}
