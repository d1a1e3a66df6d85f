// Light that places under level water get through it. Needs before the include: common.glsl, `frame`, `island_at()`, `materials`, visibility.glsl.
// docs/decisions/0066-light-under-water.md.
#ifndef SKERRY_UNDER_WATER_GLSL
#define SKERRY_UNDER_WATER_GLSL
#include "shared/constants.h"
#include "include/surface/media.glsl"
#include "include/surface/ripples.glsl"

const float kShoreBlocks = 0.5;  // what reaches closer to the surface from below is a shore, not something under water

struct Depth {
  float blocks;     // to the water's surface; 0: not under water
  vec3 up;          // the surface's normal
  vec3 extinction;  // 1/block
  vec3 through_glass;  // share of the light of frame.glass_body that glass on its way lets through
};
Depth no_depth() { return Depth(0.0, vec3(0.0, 1.0, 0.0), vec3(0.0), vec3(1.0)); }

// @param island whose water it is. @param block of that water.
Depth depth_below(float blocks, uint island, uint block) {
  return Depth(blocks, world_from_lattice_vector(island_at(island), vec3(0.0, 1.0, 0.0)), extinction(materials[block]), vec3(1.0));
}

layout(constant_id = kUnderWaterConstant) const bool kUnderWater = false;  // something may be
layout(constant_id = kGlassConstant) const bool kGlass = false;  // light may come through glass

// Of a place in the medium that the eye is in.
Depth depth_in_medium(vec3 p) {
  bool known = frame.camera_medium != 0u && frame.medium_surface != 0u && has_ripples(frame.medium_surface);
  Depth depth = depth_below(0.0, known ? surface_island(frame.medium_surface) : 0u, frame.camera_medium);
  depth.blocks = known ? max(dot(depth.up, frame.medium_surface_place - p), 0.0) : 0.0;
  return depth;
}

// Where shadow of a body is asked for, for a place under water: on the bent ray, not quite at the surface, where the edge of a shore that is level
// with it could not be told from its inside. @param to_light as the bent ray has it.
vec3 near_surface(Depth depth, vec3 p, vec3 to_light) {
  float blocks = max(depth.blocks - kShoreBlocks, 0.5 * depth.blocks);
  return p + to_light * (blocks / max(dot(depth.up, to_light), 0.1));
}

// What water takes from an even sky on the way down to a level bed, to 2% up to an optical depth of 2: 2 times the integral of
// (1 - F) exp(-x / c') c over the cosine c, c' that of the bent ray, is 0.933 exp(-1.18 x).
vec3 left_on_way_down(Depth depth) { return exp(-1.18 * depth.extinction * depth.blocks); }

// How many times as much light a wide level bed has as comes through the surface, which mirrors back some of what the bed sends up: at an
// optical depth x, 0.475 exp(-4.7 x) of it, to 0.015. Of an albedo of 0.45: what it is, light at fewer pixels does not know.
vec3 lit_again(Depth depth) {
  vec3 twice = left_on_way_down(depth) * left_on_way_down(depth);
  return depth.blocks > 0.0 ? 1.0 / (1.0 - 0.45 * 0.475 * twice * twice) : vec3(1.0);
}

// How a body's light comes to a place.
struct BodyWay {
  vec3 to_light;  // where it comes from there
  vec3 share;     // of its irradiance, shadow and clouds aside
};

// Snell's law at the level surface, Fresnel's and Beer's. A beam that is bent upright is as much narrower as its angle says.
BodyWay body_way(Depth depth, vec3 to_light) {
  float cosine = dot(depth.up, to_light);
  vec3 bent = -refract(-to_light, depth.up, 1.0 / kWaterIndex);
  float inside = max(dot(depth.up, bent), 0.1);
  vec3 share = exp(-depth.extinction * (depth.blocks / inside)) * ((1.0 - fresnel(cosine, false, kWaterIndex)) * max(cosine, 0.0) / inside);
  return depth.blocks > 0.0 ? BodyWay(bent, share) : BodyWay(to_light, vec3(1.0));
}

// Whether something under the surface stands before a place, on the straight way to a body: by the texel of its finest map there, which shows what
// stands nearest to the body. Shores do not count: near_surface().
bool shaded_in_water(Depth depth, vec3 p, vec3 normal, vec3 to_light, const uint first_cascade) {
  if (!kShadows) return false;
  float distance = length(p);
  Cascade c = pick_cascade(first_cascade, min(cascades_within(first_cascade, kCascades, distance), kCascades - 1u));
  vec3 q = p + normal * (0.5 * c.texel_blocks);
  vec3 map = vec3(dot(c.map_from_world_x, vec4(q, 1.0)), dot(c.map_from_world_y, vec4(q, 1.0)), dot(c.map_from_world_z, vec4(q, 1.0)));
  bool known = all(greaterThanEqual(map.xy, vec2(0.0))) && all(lessThan(map.xy, vec2(textureSize(shadow_maps, 0).xy)));
  float nearest = texelFetch(shadow_maps, ivec3(known ? ivec2(floor(map.xy)) : ivec2(0), int(c.layer)), 0).r;
  float way = (nearest - map.z) / c.depth_per_block;
  return known && way > 0.25 + 2.0 * c.texel_blocks && way * dot(depth.up, to_light) < depth.blocks - kShoreBlocks;
}

// Light of the sky that comes to a place under an open surface, of what would without water.
vec3 sky_share(Depth depth) { return depth.blocks > 0.0 ? 0.933 * left_on_way_down(depth) : vec3(1.0); }
#endif
