#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
// Lists the pixels whose light has to be worked out: in a first pass all points of a grid that show a surface; then the pixels between that cannot
// take light from the four points around them. A list's order follows threads, what is stored for a pixel does not.
// docs/decisions/0030-light-at-fewer-pixels.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kIslandsBinding) uniform Islands { IslandTransform islands[kMaxIslands]; };
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kRadianceBinding, rgba16f) writeonly uniform image2D radiance;
layout(binding = kSamplesBinding, rgba32ui) uniform uimage2D samples;  // at the grid's points
layout(scalar, binding = kListedBinding) buffer Listed { TileDispatch listed; };
layout(scalar, binding = kListedPixelsBinding) writeonly buffer Pixels { uint pixels[]; };

layout(constant_id = kTextureTapsConstant) const uint kTextureTaps = 2u;
layout(constant_id = kStepConstant) const uint kStep = 4u;  // pixels between the grid's points
layout(constant_id = kEveryPixelConstant) const bool kEveryPixel = false;  // the second pass
layout(constant_id = kToleranceConstant) const float kTolerance = 0.3;  // how much the four may differ, of the brightest

#include "include/scene/tiles.glsl"
#include "include/surface/surface.glsl"
#include "include/surface/light_samples.glsl"

// How far apart planes may lie that are lit alike: by rounding; a plant above its foot; and pixels, which far planes lie closer than.
const float kAlikeBlocks = 0.05, kAlikePlants = 1.05, kAlikePixels = 1.0;
// How much farther or nearer, as a share and in blocks.
const float kAlikeShare = 0.1, kAlikeNear = 2.0;
// Of the bilinear weights, that alike points have to have: beside an edge, where shadows and corners are, one point far away does not do.
const float kLeastShare = 0.25;

uvec2 grid_size() { return (frame.size + (kStep - 1u)) / kStep; }

// Every invocation calls it once.
void list_pixel(uvec2 pixel, bool wanted) {
  uvec4 ballot = subgroupBallot(wanted);
  uint count = subgroupBallotBitCount(ballot), first = 0u;
  if (count == 0u) return;
  if (subgroupElect()) {
    first = atomicAdd(listed.tiles, count);
    uint groups = (first + count + 63u) / 64u;
    atomicMax(listed.groups_x, min(groups, kTileRow));
    atomicMax(listed.groups_y, (groups + kTileRow - 1u) / kTileRow);
  }
  first = subgroupBroadcastFirst(first);
  if (wanted) pixels[first + subgroupBallotExclusiveBitCount(ballot)] = pixel.x | (pixel.y << 16);
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

// 1 if a point of the grid shows what is lit as the pixel is, else 0.
float alike(uvec4 texel, uvec2 point, Taker by) {
  float z = place_z(texel.w);
  float along = dot(by.normal, pixel_ray(point * kStep)) * z;
  float apart = by.plant || place_on_plant(texel.w) ? by.apart + kAlikePlants : by.apart;
  return place_key(texel.w) == by.key && abs(along - by.along) <= apart && abs(z - by.z) <= kAlikeNear + kAlikeShare * by.z ? 1.0 : 0.0;
}

// Light between the four points around a pixel. @return false where too few of them are alike, or those that are differ too much.
bool light_between(uvec2 pixel, Taker by, out mat2x3 light) {
  uvec2 low = pixel / kStep, beside = pixel % kStep, high = min(low + min(beside, 1u), grid_size() - 1u);
  uvec4 t00 = imageLoad(samples, ivec2(low)), t11 = imageLoad(samples, ivec2(high));
  uvec4 t10 = imageLoad(samples, ivec2(high.x, low.y)), t01 = imageLoad(samples, ivec2(low.x, high.y));
  vec4 same = vec4(alike(t00, low, by), alike(t10, uvec2(high.x, low.y), by), alike(t01, uvec2(low.x, high.y), by), alike(t11, high, by));
  vec2 f = vec2(beside) / float(kStep);
  vec4 weight = same * vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  float sum = dot(weight, vec4(1.0));
  mat2x3 l00 = sample_of(t00), l10 = sample_of(t10), l01 = sample_of(t01), l11 = sample_of(t11);
  light = (l00 * weight.x + l10 * weight.y + l01 * weight.z + l11 * weight.w) * (1.0 / max(sum, 1e-4));
  vec3 c00 = radiance_at(l00, by.albedo), c10 = radiance_at(l10, by.albedo), c01 = radiance_at(l01, by.albedo), c11 = radiance_at(l11, by.albedo);
  vec3 most = max(max(c00 * same.x, c10 * same.y), max(c01 * same.z, c11 * same.w));
  vec3 least = min(min(mix(most, c00, same.x), mix(most, c10, same.y)), min(mix(most, c01, same.z), mix(most, c11, same.w)));
  vec3 apart = most - least;
  bool own = beside == uvec2(0u);  // a point of the grid
  bool near = kTolerance > 0.0 && max(max(apart.r, apart.g), apart.b) <= kTolerance * max(max(most.r, most.g), most.b);
  return sum > (by.plant ? 0.0 : kLeastShare) && (own || near);
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy * kStep;
  bool here = all(lessThan(gl_GlobalInvocationID.xy, grid_size()));
  if (kEveryPixel) here = tile_pixel(pixel);
  pixel = min(pixel, frame.size - 1u);
  float stored_depth = texelFetch(depths, ivec2(pixel), 0).r;
  uint word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, stored_depth);
  bool surface = here && word != 0u;
  bool shared_light = false;
  if (kEveryPixel) {
    vec3 ray = pixel_ray(pixel);
    float t = view_distance(surface_depth(word != 0u ? stored_depth : 1.0), frame.near_plane);
    vec3 normal = world_from_lattice_vector(islands[surface_island(word)], face_normal(lit_face(word)));
    float apart = kAlikeBlocks + kAlikePixels * t * frame.pixel_to_ndc.y * length(frame.ray_up);
    vec3 albedo = surface_texel(word, ray, t, kTextureTaps).rgb;
    Taker by = Taker(alike_key(word), normal, dot(normal, ray * t), t, apart, is_plant(word), albedo);
    mat2x3 light;
    shared_light = light_between(pixel, by, light) && surface;
    if (shared_light) imageStore(radiance, ivec2(pixel), vec4(as_halves(sanitised(radiance_at(light, by.albedo))), 1.0));
  } else if (here && !surface) {
    imageStore(samples, ivec2(gl_GlobalInvocationID.xy), uvec4(kNoSurface));
  }
  list_pixel(pixel, surface && !shared_light);
}
