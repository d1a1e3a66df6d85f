#version 460
#extension GL_GOOGLE_include_directive : require
// What is seen through the surface of level water, by rays that it bends: the radiance of the pixel where the picture shows the place that the bent
// ray meets, and how far it lies from the surface [blocks], negative where an eye in water sees it mirrored because no light leaves there; its own
// pixel's and 0 where the picture does not show it. To an image of its own, since pixels look at one another: put_bent_rays.comp copies it to the
// radiance image. docs/decisions/0063-water-bends-what-is-seen.md, docs/decisions/0079-snells-window.md.
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
layout(binding = kRadianceBinding, rgba16f) readonly uniform image2D radiance;
layout(binding = kBentLightBinding) writeonly uniform image2D bent_light;

layout(constant_id = kWaterLayersConstant) const uint kWaterLayers = 3u;
layout(constant_id = kBentConstant) const uint kBent = kBentIntoWater;

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

// A ray as the picture shows it: straight, and its places' inverse distance along the view axis changes evenly along it.
struct Line {
  vec2 from, to;             // pixels
  float from_depth, to_depth;  // reverse depths
};

// Whether the nearest thing that a pixel shows is the water whose surface a word names. Pixels outside the picture, and where no water can be, stand
// for the nearest ones that have some layer.
ivec2 nearest_pixel(vec2 at) { return ivec2(clamp(at, vec2(frame.layers_area.xy), vec2(frame.layers_area.zw) - 1.0)); }
ivec2 pixel_on_line(vec2 at, bool mirrored) { return mirrored ? ivec2(clamp(at, vec2(0.0), vec2(frame.size) - 1.0)) : nearest_pixel(at); }
bool shows_water(ivec2 pixel, uint word) {
  return texelFetch(layer_depths_0, pixel, 0).r > 0.0 && texelFetch(layer_surfaces, ivec3(pixel, 0), 0).r == word;
}

// Rays are bent less where the picture ends, or shows the water no more, near what they would meet or before: up to half the way to there, so that
// nothing is stretched to more than about twice its size and no step shows.
// @param place where the picture would show what the bent ray meets, were the bed level.
float bent_share(vec2 pixel, vec2 place, uint word) {
  const float kLook = 4.0;  // times the way to the place
  const uint kLooks = 7u;   // halvings
  vec2 way = (place - pixel) * kLook;
  float on = 0.0, off = 1.0;  // shares of the way
  for (uint i = 0u; i < kLooks; ++i) {
    float middle = 0.5 * (on + off);
    vec2 at = pixel + way * middle;
    ivec2 nearest = nearest_pixel(at);
    bool still = ivec2(floor(at)) == nearest && shows_water(nearest, word);
    on = still ? middle : on;
    off = still ? off : middle;
  }
  float most = 2.0 / max(kLook * on, 1e-3);
  return pow(1.0 + most * most * most * most, -0.25);
}

// Steps along a bent ray, over kLongest times the way that it would have if the bed were level, and along one that is mirrored, over as many
// blocks; and halvings of the step that passes the bed.
const uint kSteps = 6u, kHalvings = 4u, kMirroredSteps = 16u, kMirroredHalvings = 6u;
const float kLongest = 2.5, kLongestMirrored = 32.0;

// Whether what is opaque at a part of the line lies before the ray, behind the same surface; of a mirrored ray, before all surfaces, as the eye does.
bool is_passed(Line line, float part, uint word, bool mirrored) {
  vec2 at = mix(line.from, line.to, part);
  ivec2 pixel = pixel_on_line(at, mirrored);
  // What is not in the picture is looked for elsewhere: water.glsl.
  if (kBent == kBentIntoAir && ivec2(floor(at)) != pixel) return false;
  bool there = mirrored ? layer_depth_at(layer_depths_0, pixel, frame.layers_area) <= 0.0 : shows_water(pixel, word);
  return texelFetch(depths, pixel, 0).r >= mix(line.from_depth, line.to_depth, part) && there;
}

// @return the part of the line that the bed is met at; 2: it is not.
float part_met(Line line, uint word, bool mirrored) {
  uint most = mirrored ? kMirroredSteps : kSteps;
  uint steps = min(most, frame.size.x + kSteps);  // no constant, so that the loop is left early: docs/lavapipe.md
  float before = 0.0, behind = 0.0;
  bool met = false;
  for (uint i = 0u; i < steps && !met; ++i) {
    before = behind;
    behind += 1.0 / float(most);
    met = is_passed(line, behind, word, mirrored);
  }
  uint halvings = mirrored ? kMirroredHalvings : kHalvings;
  for (uint i = 0u; i < halvings; ++i) {
    float middle = 0.5 * (before + behind);
    bool past = is_passed(line, middle, word, mirrored);
    before = past ? before : middle;
    behind = past ? middle : behind;
  }
  return met ? behind : 2.0;
}

// What a bent ray may meet under level water, as the picture shows it.
struct Bent {
  Line line;
  float longest, end_z;  // of the ray, and where that ends along the view axis [blocks]
  bool known;
};

// A ray in water, from p on, at `z` along the view axis. @param from pixels. @param most blocks of it.
Bent bent_within(vec2 from, vec3 p, vec3 dir, float z, float most, bool known) {
  // Not behind the eye.
  float ahead = dot(dir, frame.ray_forward), longest = min(most, ahead < 0.0 ? 0.8 * z / -ahead : 1e6);
  vec3 end = p + dir * longest;
  float end_z = dot(end, frame.ray_forward);
  return Bent(Line(from, pixel_place(end, end_z), frame.near_plane / z, frame.near_plane / end_z), longest, end_z, known);
}

// @param from pixels. @param p of the surface at `z` along the view axis, n its normal. @param opaque depth of the pixel.
Bent bent_into_water(vec2 from, vec3 ray, float z, vec3 shading, vec3 n, float opaque, uint word) {
  vec3 p = ray * z, dir = refract(normalize(ray), shading, 1.0 / kWaterIndex);
  float depth = opaque > 0.0 ? (view_distance(opaque, frame.near_plane) - z) * -dot(ray, n) : 0.0;
  float level = max(depth, 0.0) / max(-dot(dir, n), 0.1);
  vec3 flat_bed = p + dir * level;
  dir = normalize(mix(normalize(ray), dir, bent_share(from, pixel_place(flat_bed, dot(flat_bed, frame.ray_forward)), word)));
  return bent_within(from, p, dir, z, level * kLongest, depth > 0.0);
}

// The same above the water about the eye: up to the sky. @param dir of the bent ray.
Bent bent_out_of_water(vec2 from, vec3 dir, float z) {
  float ahead = dot(dir, frame.ray_forward);
  return Bent(Line(from, pixel_place(dir, ahead), frame.near_plane / z, 0.0), 1.0, z, ahead > 1e-2);
}

// Whether a ray from water about the eye meets what the picture shows at a part of its line, and does not pass behind it.
bool meets(Line line, float part, bool mirrored) {
  float opaque = texelFetch(depths, pixel_on_line(mix(line.from, line.to, part), mirrored), 0).r, there = mix(line.from_depth, line.to_depth, part);
  if (opaque <= 0.0) return there <= 0.0;
  float met = view_distance(opaque, frame.near_plane);
  return abs(view_distance(max(there, 1e-12), frame.near_plane) - met) < 0.5 + 0.02 * met;
}

void main() {
  uvec2 at;
  bool here = tile_pixel(at);
  ivec2 pixel = ivec2(at);
  uint word = here ? nearest_surface(pixel) : 0u;
  vec3 ray = pixel_ray(pixel);
  float z = word != 0u ? view_distance(layer_depth_at(layer_depths_0, pixel, frame.layers_area), frame.near_plane) : 1.0;
  vec3 n = world_from_lattice_vector(island_at(surface_island(word)), face_normal(surface_face(word)));
  vec3 shading = shading_normal(word, ray, z);
  vec2 from = vec2(at) + frame.sample_in_pixel;
  Bent bent;
  bool mirrored = false;
  if (kBent == kBentIntoAir) {
    vec3 dir = bent_into_air(normalize(ray), shading, n);
    mirrored = dir == vec3(0.0);
    bent = bent_out_of_water(from, dir, z);
    if (mirrored) bent = bent_within(from, ray * z, mirrored_ray(-normalize(ray), shading, n), z, kLongestMirrored, true);
    bent.known = bent.known && surface_block(word) == frame.camera_medium;
  } else {
    bent = bent_into_water(from, ray, z, shading, n, texelFetch(depths, pixel, 0).r, word);
  }
  float part = part_met(bent.line, word, mirrored);
  if (kBent == kBentIntoAir) bent.known = bent.known && meets(bent.line, part, mirrored);
  bool bends = has_ripples(word) && bent.known && part <= 1.0 && (mirrored || !another_behind(at, ray, word, n, z));
  // Even parts of the line are not even parts of the ray.
  float way = bent.longest * part * z / mix(bent.end_z, z, part);
  vec3 behind = imageLoad(radiance, bends ? pixel_on_line(mix(bent.line.from, bent.line.to, part), mirrored) : pixel).rgb;
  if (word != 0u) imageStore(bent_light, pixel, vec4(behind, bends ? (mirrored ? -way : way) : 0.0));
}
