#version 460
#extension GL_GOOGLE_include_directive : require
// What is seen through level water, by rays that its surface bends, for an eye in the air: the radiance of the pixel where the picture shows the
// place that the bent ray meets, and how far it lies from the surface [blocks]; its own pixel's and 0 where the picture does not show it. To an
// image of its own, since pixels look at one another; then kPut copies that to the radiance image. docs/decisions/0063-water-bends-what-is-seen.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kLayerSurfacesBinding) uniform usampler2DArray layer_surfaces;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths_0;
layout(binding = kLayerDepthsBinding + 1u) uniform sampler2D layer_depths_1;
layout(binding = kRadianceBinding, rgba16f) uniform image2D radiance;
layout(binding = kBentLightBinding, rgba16f) uniform image2D bent_light;

layout(constant_id = kPutConstant) const bool kPut = false;
layout(constant_id = kWaterLayersConstant) const uint kWaterLayers = 3u;

#include "include/scene/layers.glsl"
#include "include/scene/tiles.glsl"
#include "include/surface/ripples.glsl"
#include "include/surface/media.glsl"

uint nearest_surface(ivec2 pixel) {
  return layer_depth_at(layer_depths_0, pixel, frame.layers_area) > 0.0 ? texelFetch(layer_surfaces, ivec3(pixel, 0), 0).r : 0u;
}

// Whether something translucent lies behind the nearest surface, at `near`: bent rays are not followed through it.
bool another_behind(uvec2 pixel, vec3 ray, uint word, vec3 n, float near) {
  const uint second = min(kWaterLayers - 1u, 1u);
  float depth = second > 0u ? layer_depth_at(layer_depths_1, ivec2(pixel), frame.layers_area) : 0.0;
  uint behind = texelFetch(layer_surfaces, ivec3(pixel, second), 0).r;
  return depth > 0.0 && !are_one_surface(behind, word, n, ray, pixel_ray(pixel + 1u), near, view_distance(depth, frame.near_plane));
}

// What a bent ray meets.
struct Met {
  ivec2 pixel;  // that shows it
  float way;    // blocks from the water's surface
  bool shown;
};

// Steps along a bent ray, over kLongest times the way that it would have if the bed were level; and halvings of the step that passes the bed.
const uint kSteps = 12u, kHalvings = 5u;
const float kLongest = 3.0;

// Whether the nearest thing that a pixel shows is the water whose surface a word names.
bool shows_water(ivec2 pixel, uint word) {
  uint there = nearest_surface(pixel);
  return has_ripples(there) && surface_face(there) == surface_face(word) && surface_island(there) == surface_island(word);
}

// The pixel that shows a place, or the nearest one of the picture, and whether what is opaque there lies before the place, under the same water.
bool lies_behind(vec3 place, uint word, out ivec2 pixel) {
  float z = dot(place, frame.ray_forward);
  pixel = ivec2(clamp(pixel_place(place, z), vec2(0.0), vec2(frame.size) - 1.0));
  float opaque = texelFetch(depths, pixel, 0).r;
  return shows_water(pixel, word) && opaque > 0.0 && view_distance(opaque, frame.near_plane) <= z;
}

// @param dir unit, into the water whose surface is at p. @param level the ray's way to a level bed where the unbent ray meets the bed [blocks].
Met met_by(vec3 p, vec3 dir, float level, uint word) {
  float step = level * (kLongest / float(kSteps)), before = 0.0, behind = 0.0;
  ivec2 pixel;
  bool met = false;
  for (uint i = 0u; i < kSteps && !met; ++i) {
    before = behind;
    behind += step;
    met = lies_behind(p + dir * behind, word, pixel);
  }
  for (uint i = 0u; i < kHalvings; ++i) {
    float middle = 0.5 * (before + behind);
    bool past = lies_behind(p + dir * middle, word, pixel);
    before = past ? before : middle;
    behind = past ? middle : behind;
  }
  lies_behind(p + dir * behind, word, pixel);
  return Met(pixel, behind, met);
}

// Rays are bent less where the picture ends, or shows the water no more, near what they would meet or before: up to half the way to there, so that
// nothing is stretched to more than about twice its size and no step shows.
// @param place where the picture would show what the bent ray meets, were the bed level.
float bent_share(vec2 pixel, vec2 place, uint word) {
  const float kLook = 4.0;  // times the way to the place
  const uint kLooks = 12u, kLookHalvings = 4u;
  vec2 way = (place - pixel) * kLook;
  float on = 0.0, off = 0.0;  // shares of the way
  bool shown = true;
  for (uint i = 0u; i < kLooks && shown; ++i) {
    on = off;
    off += 1.0 / float(kLooks);
    vec2 at = pixel + way * off;
    shown = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(frame.size))) && shows_water(ivec2(at), word);
  }
  for (uint i = 0u; i < kLookHalvings; ++i) {
    float middle = 0.5 * (on + off);
    vec2 at = pixel + way * middle;
    bool still = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(frame.size))) && shows_water(ivec2(at), word);
    on = still ? middle : on;
    off = still ? off : middle;
  }
  float most = shown ? 0.0 : 2.0 / max(kLook * on, 1e-3);
  return pow(1.0 + most * most * most * most, -0.25);
}

void main() {
  uvec2 at;
  bool here = tile_pixel(at);
  ivec2 pixel = ivec2(at);
  uint word = here ? nearest_surface(pixel) : 0u;
  if (kPut) {
    if (word != 0u) imageStore(radiance, pixel, imageLoad(bent_light, pixel));
    return;
  }
  vec3 ray = pixel_ray(pixel);
  float z = word != 0u ? view_distance(layer_depth_at(layer_depths_0, pixel, frame.layers_area), frame.near_plane) : 1.0;
  float opaque = texelFetch(depths, pixel, 0).r;
  vec3 n = world_from_lattice_vector(island_at(surface_island(word)), face_normal(surface_face(word)));
  vec3 p = ray * z, dir = refract(normalize(ray), shading_normal(word, ray, z), 1.0 / kWaterIndex);
  float depth = opaque > 0.0 ? (view_distance(opaque, frame.near_plane) - z) * -dot(ray, n) : 0.0;
  float level = max(depth, 0.0) / max(-dot(dir, n), 0.1);
  vec3 flat_bed = p + dir * level;
  float flat_z = dot(flat_bed, frame.ray_forward);
  dir = normalize(mix(normalize(ray), dir, bent_share(vec2(at) + 0.5, pixel_place(flat_bed, flat_z), word)));
  Met met = met_by(p, dir, level, word);
  bool bends = has_ripples(word) && depth > 0.0 && met.shown && !another_behind(at, ray, word, n, z);
  vec3 behind = imageLoad(radiance, bends ? met.pixel : pixel).rgb;
  if (word != 0u) imageStore(bent_light, pixel, vec4(behind, bends ? met.way : 0.0));
}
