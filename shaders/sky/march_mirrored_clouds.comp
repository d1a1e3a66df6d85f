#version 460
#extension GL_GOOGLE_include_directive : require
// Clouds that the nearest surfaces of water and glass mirror, or that an eye in water sees through its surface: one ray for each square of four
// pixels that shows one.
// From the surface on, as the sky is mirrored: past whatever stands there. Lamps light no cloud that is mirrored. docs/conventions.md.
#include "include/sky/cloud_ray.glsl"
#include "include/scene/layers.glsl"
#include "shared/bindings.h"

#include "include/frame/islands.glsl"
// No uniform buffer: lavapipe crashes on a fourth one in a program that marches (Mesa 22.3).
layout(scalar, binding = kMaterialsBinding) readonly buffer Materials { Material materials[]; };
layout(binding = kMirroredCloudsBinding, rgba16f) writeonly uniform image2D mirrored;
layout(binding = kLayerSurfacesBinding, r32ui) readonly uniform uimage2D layer_surfaces;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths;  // of the nearest water or glass

#include "include/surface/ripples.glsl"
#include "include/surface/bent.glsl"
#include "include/sky/mirrored_clouds.glsl"

void main() {
  uvec2 size = (frame.size + 1u) / 2u;
  uvec2 square = gl_GlobalInvocationID.xy;
  bool here = all(lessThan(square, size));
  uvec2 pixel = uvec2(0u);
  uint word = 0u;
  for (uint i = 4u; i-- > 0u;) {
    uvec2 one = min(square * 2u + uvec2(i & 1u, i >> 1), frame.size - 1u);
    bool water = here && layer_depth_at(layer_depths, ivec2(one), frame.layers_area) > 0.0;  // its word is undefined elsewhere
    uint its_word = water ? imageLoad(layer_surfaces, ivec2(one)).r : 0u;
    pixel = its_word != 0u ? one : pixel;
    word = its_word != 0u ? its_word : word;
  }
  vec3 ray = pixel_ray(pixel);
  float t = word != 0u ? view_distance(texelFetch(layer_depths, ivec2(pixel), 0).r, frame.near_plane) : 1.0;
  vec3 dir = normalize(reflect(ray, shading_normal(word, ray, t)));
  bool known = word != 0u;
  if (frame.camera_medium != 0u) {
    vec3 n = world_from_lattice_vector(island_at(surface_island(word)), face_normal(surface_face(word)));
    vec3 bent = bent_into_air(normalize(ray), shading_normal(word, ray, t), n);
    known = known && bent != vec3(0.0);
    dir = known ? bent : dir;
  }
  Clouded seen = march_clouds(pixel, ray * t, dir, 0.0, known ? kSkyDistance : 0.0, gradient_jitter(square));
  vec4 result = word != 0u ? vec4(min(seen.light, vec3(kMaxRadiance)), seen.clear) : vec4(0.0, 0.0, 0.0, kMirrorsNothing);
  if (here) imageStore(mirrored, ivec2(square), result);
}
