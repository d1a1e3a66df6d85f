#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
// Lists the pixels whose light has to be worked out: in a first pass all points of a grid that show a surface; then the pixels between that cannot
// take light from the four points around them. A list's order follows threads, what is stored for a pixel does not.
// docs/decisions/0030-light-at-fewer-pixels.md.
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
layout(binding = kSamplesBinding, rgba32ui) uniform uimage2D samples;  // at the grid's points
// Of pixels that ask no light, and of those that ask some: the former from the beginning, the latter from the end.
layout(scalar, binding = kListedPixelsBinding) buffer Pixels { TileDispatch listed[kSampleLists]; uint pixels[]; };
layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kClustersBinding) readonly buffer Clusters { Cluster clusters[]; };

layout(constant_id = kTextureTapsConstant) const uint kTextureTaps = 2u;
layout(constant_id = kStepConstant) const uint kStep = 4u;  // pixels between the grid's points
layout(constant_id = kEveryPixelConstant) const bool kEveryPixel = false;  // the second pass
layout(constant_id = kLitConstant) const bool kLit = false;        // the frame has lights; if not, buffers are bound that are never read
layout(constant_id = kOracleConstant) const bool kOracle = false;  // every pixel asks every light
layout(constant_id = kToleranceConstant) const float kTolerance = 0.3;  // how much the four may differ, of the brightest

#include "include/scene/tiles.glsl"
#include "include/post/output.glsl"
#include "include/surface/surface.glsl"
#include "include/surface/light_samples.glsl"
#include "include/light/clusters.glsl"

// How far apart planes may lie that are lit alike: by rounding; a plant above its foot; and pixels, which far planes lie closer than.
const float kAlikeBlocks = 0.05, kAlikePlants = 1.05, kAlikePixels = 1.0;
// How much farther or nearer, as a share and in blocks.
const float kAlikeShare = 0.1, kAlikeNear = 2.0;
// Of the bilinear weights, that alike points have to have: beside an edge, where shadows and corners are, one point far away does not do.
const float kLeastShare = 0.25;

const uint kRun = kTileEdge * kTileEdge / kChooseGroup;  // pixels of an invocation

uvec2 grid_size() { return (frame.size + (kStep - 1u)) / kStep; }

// Where an invocation's next pixels go: of the list of those that ask no light, and of the other.
struct Slots {
  uint unlit;
  uint lit;
};

// Room for pixels of each invocation, at most 511: 128 lanes sum to 16 bits. Every invocation calls it once.
Slots first_slots(uint unlit, uint lit) {
  uint counts = unlit | (lit << 16);  // both sums at once
  uint before = subgroupExclusiveAdd(counts), all = subgroupAdd(counts);
  Slots first = Slots(0u, 0u);
  if (subgroupElect()) {  // one for all: GPUs take turns at an address
    first.unlit = atomicAdd(listed[0].tiles, all & 0xffffu);
    if (kLit) first.lit = atomicAdd(listed[1].tiles, all >> 16);
  }
  return Slots(subgroupBroadcastFirst(first.unlit) + (before & 0xffffu), subgroupBroadcastFirst(first.lit) + (before >> 16));
}

void list_pixel(inout Slots next, bool lit, uvec2 pixel) {
  pixels[lit ? uint(pixels.length()) - 1u - next.lit : next.unlit] = pixel.x | (pixel.y << 16);
  next.unlit += lit ? 0u : 1u;
  next.lit += lit ? 1u : 0u;
}

// Whether some light may reach what a pixel shows.
bool asks_lights(uvec2 pixel, float stored_depth) {
  float z = view_distance(surface_depth(stored_depth), frame.near_plane);
  return kLit && (kOracle || clusters[cluster_of(tile_at(pixel), slice_at(z))].count != 0u);
}

// A pixel's surface, as far as it decides whose light it can take.
struct Taker {
  uint key;
  vec3 normal;  // of the lit face, world
  float along;  // of its plane, from the eye along the normal [blocks]
  float z;
  float apart;  // of planes, at most [blocks]
  bool plant;
  vec3 albedo;
};

// A point of the grid.
struct Point {
  uint key;
  vec3 position;
  float z;
  bool plant;
  mat2x3 sent;
};

Point point_at(uvec2 at) {
  uvec4 texel = imageLoad(samples, ivec2(at));
  float z = place_z(texel.w);
  return Point(place_key(texel.w), pixel_ray(at * kStep) * z, z, place_on_plant(texel.w), sample_of(texel));
}

// The four around a pixel.
struct Four {
  Point p00, p10, p01, p11;
};

Four four_around(uvec2 pixel) {
  uvec2 low = pixel / kStep, beside = pixel % kStep, high = min(low + (kStep == kRun ? uvec2(1u, min(beside.y, 1u)) : min(beside, 1u)), grid_size() - 1u);
  return Four(point_at(low), point_at(uvec2(high.x, low.y)), point_at(uvec2(low.x, high.y)), point_at(high));
}

// 1 if a point of the grid shows what is lit as the pixel is, else 0.
float alike(Point p, Taker by) {
  float along = dot(by.normal, p.position);
  float apart = by.plant || p.plant ? by.apart + kAlikePlants : by.apart;
  return p.key == by.key && abs(along - by.along) <= apart && abs(p.z - by.z) <= kAlikeNear + kAlikeShare * by.z ? 1.0 : 0.0;
}

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

// @return false where the pixel shows no surface.
bool surface_at(uvec2 pixel, out uint word, out float stored_depth) {
  stored_depth = texelFetch(depths, ivec2(pixel), 0).r;
  word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, stored_depth);
  return word != 0u;
}

void choose_points() {
  uvec2 at = gl_GlobalInvocationID.xy, pixel = min(at * kStep, frame.size - 1u);
  bool here = all(lessThan(at, grid_size()));
  uint word;
  float stored_depth;
  bool surface = surface_at(pixel, word, stored_depth) && here;
  if (here && !surface) imageStore(samples, ivec2(at), uvec4(kNoSurface));
  bool lit = surface && asks_lights(pixel, stored_depth);
  Slots slots = first_slots(surface && !lit ? 1u : 0u, surface && lit ? 1u : 0u);
  if (surface) list_pixel(slots, lit, pixel);
}

// An invocation takes kRun pixels of a row: at a step of as many they have their four points, and a place in the list, in common.
void choose_pixels() {
  uvec2 first;
  bool tile = listed_tile(first);
  first += uvec2(gl_LocalInvocationIndex % (kTileEdge / kRun) * kRun, gl_LocalInvocationIndex / (kTileEdge / kRun));
  Four four = four_around(min(first, frame.size - 1u));
  uint without = 0u;  // a bit a pixel
  MeterRun run = meter_run(first);
  for (uint i = 0u; i < kRun; ++i) {
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

void main() {
  if (kEveryPixel)
    choose_pixels();
  else
    choose_points();
}
