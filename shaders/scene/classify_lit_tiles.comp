#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// As classify_tiles.comp, for frames that one body lights: tiles with surfaces (list 0), with open pixels (1), and with surfaces that the body
// does not light (2, and then not in 0). Of those each face is turned away, or all texels of the shadow maps that the filter could look at lie
// before whatever the tile shows. Errs on the side of list 0. Tiles with water or glass are in list 3 in place of 0. Those that
// lamps reach are in lists of the same order from kLampTiles on. docs/decisions/0062.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
#include "include/scene/gather_depths.glsl"
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths;  // of the first layer

layout(constant_id = kUnderWaterConstant) const bool kUnderWater = false;  // as in under_water.glsl

#include "include/scene/coverage.glsl"
#include "include/scene/list_tiles.glsl"
#include "include/light/visibility.glsl"
#include "include/light/lit_tiles.glsl"

const float kRounding = 1e-6;     // of depths in a map
const float kTurnedAway = -1e-4;  // cosine, past what rounding takes from one program to the next
const int kMostTexels = 1024;     // that are looked at for a tile and a map

// What a tile's surfaces lie in: the part of its pixels' pyramid between two distances along the view axis.
struct Part {
  vec3 low_ray, high_ray, left_ray, right_ray;  // of the corners
  float nearest, farthest;
};

vec3 texel_and_depth(Cascade c, vec3 p) {
  return vec3(dot(c.map_from_world_x, vec4(p, 1.0)), dot(c.map_from_world_y, vec4(p, 1.0)), dot(c.map_from_world_z, vec4(p, 1.0)));
}
void take_corner(inout vec3 low, inout vec3 high, Cascade c, vec3 p) {
  vec3 map = texel_and_depth(c, p);
  low = min(low, map);
  high = max(high, map);
}

// Whether each texel that a filter about some place of the part can look at shades all of the part.
bool all_shaded(Part part, Cascade c) {
  vec3 low = vec3(1e30), high = vec3(-1e30);
  for (uint i = 0u; i < 2u; ++i) {
    float z = i == 0u ? part.nearest : part.farthest;
    take_corner(low, high, c, part.low_ray * z);
    take_corner(low, high, c, part.high_ray * z);
    take_corner(low, high, c, part.left_ray * z);
    take_corner(low, high, c, part.right_ray * z);
  }
  // Places are looked up half a texel off their surface, and none of the filter's taps compares with more than that depth: cascade_visibility().
  float radius = max(kShadowBlur ? frame.shadow_blur / c.texel_blocks : 1.0, 1.0) + 0.51;
  float depth = high.z + c.depth_per_block * (max(0.9, 6.0 * c.texel_blocks) + 0.51 * c.texel_blocks) + kRounding;
  ivec2 first = ivec2(floor(low.xy - radius)), last = ivec2(floor(high.xy + radius)), size = last - first + 1;
  bool known = all(greaterThanEqual(first, ivec2(0))) && all(lessThan(last, textureSize(shadow_maps, 0).xy)) &&
               all(lessThanEqual(size, ivec2(kMostTexels)));
  int texels = known ? size.x * size.y : 0;
  bool shaded = known && texels <= kMostTexels;
  // Four texels at once, the last column and row perhaps twice. There are two at least, since the radius is more than 1.
  vec2 per_texel = 1.0 / vec2(textureSize(shadow_maps, 0).xy);
  ivec2 at = first;
  while (shaded && at.y <= last.y) {
    vec2 middle = vec2(min(at, last - 1) + 1) * per_texel;
    shaded = least_of(textureGather(shadow_maps, vec3(middle, float(c.layer)))) > depth;
    at.x += 2;
    at = at.x > last.x ? ivec2(first.x, at.y + 2) : at;
  }
  return shaded;
}

void main() {
  uvec2 count = (frame.size + (kTileEdge - 1u)) / kTileEdge;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (tile >= count.x * count.y) return;
  uvec2 at = uvec2(tile % count.x, tile / count.x);
  ivec2 low = ivec2(at * kTileEdge), last = ivec2(frame.size) - 1;
  bool covered = false, open = false;
  bool in_water = kUnderWater && frame.camera_medium != 0u;
  uint faces = 0u, least_island = ~0u, most_island = 0u;
  float farthest = 1.0, nearest = 0.0;  // depths
  for (int y = 0; y < int(kTileEdge); y += 2) {
    [[unroll]] for (int x = 0; x < int(kTileEdge); x += 2) {
      vec4 gathered = depths_about(low + ivec2(x, y), frame.size), layer = vec4(0.0);
      if (kUnderWater) layer = depths_about(layer_depths, low + ivec2(x, y), frame.size);
      [[unroll]] for (int i = 0; i < 4; ++i) {
        ivec2 pixel = min(low + ivec2(x, y) + ivec2(i == 1 || i == 2, i < 2), last);
        float depth = gathered[i];
        uint word = imageLoad(surfaces, pixel).r;
        bool here = is_covered(word, depth);
        covered = covered || here;
        open = open || !here;
        in_water = in_water || (layer[i] > 0.0 && in_area(uvec2(pixel), frame.layers_area));
        faces |= here ? 1u << surface_face(word) : 0u;
        least_island = min(least_island, here ? surface_island(word) : ~0u);
        most_island = max(most_island, here ? surface_island(word) : 0u);
        farthest = min(farthest, here ? depth : 1.0);
        nearest = max(nearest, here ? depth : 0.0);
      }
    }
  }
  if (open) list_tile(1u, at, count);
  if (!covered) return;
  // Plants ask for shadow elsewhere than where they are (faces 6 and 7), and so does what lies under water.
  bool sunless = least_island == most_island && (faces & 0xc0u) == 0u && !in_water;
  vec3 to_light = lattice_from_world_vector(island_at(most_island), frame.bodies[(kBodies & 1u) != 0u ? 0u : 1u].to_light);
  bool faces_light = false;
  for (uint face = 0u; face < 6u; ++face)
    faces_light = faces_light || ((faces & (1u << face)) != 0u && dot(face_normal(face), to_light) > kTurnedAway);
  if (kDepth16) farthest = max(farthest - 1.0 / 65535.0, 0.25 / 65535.0);
  Part part;
  uvec2 first = uvec2(low), end = uvec2(min(low + int(kTileEdge) - 1, last));
  part.low_ray = pixel_ray(first);
  part.high_ray = pixel_ray(end);
  part.left_ray = pixel_ray(uvec2(first.x, end.y));
  part.right_ray = pixel_ray(uvec2(end.x, first.y));
  part.nearest = 0.9999 * view_distance(kDepth16 ? nearest + 1.0 / 65535.0 : nearest, frame.near_plane);
  part.farthest = 1.0001 * view_distance(farthest, frame.near_plane);
  // From the cascade of the nearest place to that which the farthest may fade into. Past the last one nothing is lit.
  float most_long = max(max(length(part.low_ray), length(part.high_ray)), max(length(part.left_ray), length(part.right_ray)));
  uint cascade = cascades_within(0u, kCascades, part.nearest * 0.999 * length(frame.ray_forward));
  uint end_cascade = min(cascades_within(0u, kCascades, part.farthest * most_long * 1.27) + 1u, kCascades);
  for (; sunless && faces_light && cascade < end_cascade; ++cascade) sunless = all_shaded(part, pick_cascade(0u, cascade));
  list_tile((lamps_reach(at, count) ? kLampTiles : 0u) + (sunless ? 2u : in_water ? 3u : 0u), at, count);
}
