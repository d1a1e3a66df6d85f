#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
// Lists the pixels whose light has to be worked out because they cannot take it from the four points of a grid around them (list_points.comp); the
// others take it. A list's order follows threads, what is stored for a pixel does not. docs/decisions/0030-light-at-fewer-pixels.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/clusters.h"
#include "shared/constants.h"

layout(local_size_x = kChooseGroup) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kSamplesBinding, rgba32ui) readonly uniform uimage2D samples;  // at the grid's points
// Of pixels that ask no light, and of those that ask some: the former from the beginning, the latter from the end.
layout(scalar, binding = kListedPixelsBinding) buffer Pixels { TileDispatch listed[kSampleLists]; uint pixels[]; };
layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kClustersBinding) readonly buffer Clusters { Cluster clusters[]; };

layout(constant_id = kTextureTapsConstant) const uint kTextureTaps = 2u;
layout(constant_id = kSquaresConstant) const bool kSquares = false;        // of squares in place of tiles

#include "include/scene/tiles.glsl"
#include "include/post/output.glsl"
#include "include/surface/surface.glsl"

// Of the bilinear weights, that alike points have to have: beside an edge, where shadows and corners are, one point far away does not do.
const float kLeastShare = 0.25;

const uint kRun = kTileEdge * kTileEdge / kChooseGroup;  // pixels of an invocation

#include "include/surface/grid_points.glsl"

// Light between the four points around a pixel. @return false where too few of them are alike, or those that are differ too much.
bool light_between(Four c, uvec2 pixel, Taker by, out vec3 colour) {
  uvec2 beside = pixel % kStep;
  vec4 same = vec4(alike(c.p00, by), alike(c.p10, by), alike(c.p01, by), alike(c.p11, by));
  vec2 f = vec2(beside) / float(kStep);
  vec4 weight = same * vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  same = vec4(greaterThan(weight, vec4(0.0)));  // a pixel in line with two points has no use for the others
  float sum = dot(weight, vec4(1.0));
  vec3 c00 = radiance_at(c.p00.sent, by.albedo), c10 = radiance_at(c.p10.sent, by.albedo);
  vec3 c01 = radiance_at(c.p01.sent, by.albedo), c11 = radiance_at(c.p11.sent, by.albedo);
  colour = (c00 * weight.x + c10 * weight.y + c01 * weight.z + c11 * weight.w) * (1.0 / max(sum, 1e-4));
  vec3 most = max(max(c00 * same.x, c10 * same.y), max(c01 * same.z, c11 * same.w));
  vec3 least = min(min(mix(most, c00, same.x), mix(most, c10, same.y)), min(mix(most, c01, same.z), mix(most, c11, same.w)));
  vec3 apart = most - least;
  bool own = beside == uvec2(0u);  // a point of the grid
  bool near = kTolerance > 0.0 && max(max(apart.r, apart.g), apart.b) <= kTolerance * max(max(most.r, most.g), most.b);
  return sum > (by.plant ? 0.0 : kLeastShare) && (own || near);
}

// @return false where there is no run.
bool first_of_run(out uvec2 first) {
  uint i = gl_LocalInvocationIndex;
  const uint across = kSquares ? 1u : kTileEdge / kRun;
  bool here = kSquares ? listed_square((gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * (kMixedGroup / kSquareEdge) + i / kSquareEdge, first)
                       : listed_tile(first);
  first += kSquares ? uvec2(0u, i % kSquareEdge) : uvec2(i % across * kRun, i / across);
  return here;
}

// An invocation takes kRun pixels of a row: at a step of as many they have their four points, and a place in the list, in common.
void main() {
  uvec2 first;
  bool tile = first_of_run(first);
  Four four = four_around(min(first, frame.size - 1u));
  uint without = 0u;  // a bit a pixel
  MeterRun run = meter_run(first);
  [[unroll]] for (uint i = 0u; i < kRun; ++i) {
    uvec2 pixel = first + uvec2(i, 0u);
    if (!in_one_cell(kRun)) run = meter_run(pixel);
    bool here = tile && all(lessThan(pixel, frame.size));
    pixel = min(pixel, frame.size - 1u);
    uint word;
    float stored_depth;
    bool surface = surface_at(pixel, word, stored_depth) && here;
    vec3 ray = pixel_ray(pixel);
    float t = view_distance(surface_depth(word != 0u ? stored_depth : 1.0), frame.near_plane);
    vec3 normal = world_from_lattice_vector(island_at(surface_island(word)), face_normal(lit_face(word)));
    float apart = kAlikeBlocks + kAlikePixels * t * frame.pixel_to_ndc.y * length(frame.ray_up);
    vec3 albedo = surface_texel(word, ray, t, kTextureTaps).rgb;
    Taker by = Taker(alike_key(word), normal, dot(normal, ray * t), t, apart, is_plant(word), albedo);
    if (kStep != kRun) four = four_around(pixel);
    vec3 colour;
    bool shared_light = light_between(four, pixel, by, colour) && surface && !emits_in_part(word);
    put_shown(pixel, shown(colour, shared_light), shared_light, run);
    if (!in_one_cell(kRun)) end_run(run);
    if (surface && !shared_light) without |= 1u << i;
  }
  if (in_one_cell(kRun)) end_run(run);
  uint lit = 0u;
  for (uint left = kLit ? without : 0u; left != 0u; left &= left - 1u) {
    uvec2 pixel = first + uvec2(uint(findLSB(left)), 0u);
    if (asks_lights(pixel, texelFetch(depths, ivec2(pixel), 0).r)) lit |= left & -left;
  }
  Slots slots = first_slots(uint(bitCount(without & ~lit)), uint(bitCount(lit)));
  for (uint left = without; left != 0u; left &= left - 1u)
    list_pixel(slots, (lit & left & -left) != 0u, first + uvec2(uint(findLSB(left)), 0u));
}
