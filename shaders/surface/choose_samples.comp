#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
// Lists the pixels of one level whose light has to be worked out. The others take it from the four points of the next coarser level around
// them: those that show the same plane, where the four agree. A list's order follows threads, what is stored for a pixel does not.
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
layout(binding = kRadianceBinding, rgba16f) writeonly uniform image2D radiance;  // of step 1
layout(binding = kCoarserSamplesBinding, rgba32ui) readonly uniform uimage2D coarser;  // samples of the next coarser level
layout(binding = kOwnSamplesBinding, rgba32ui) writeonly uniform uimage2D own;  // samples of this one
layout(scalar, binding = kListedBinding) buffer Listed { TileDispatch listed; };
layout(scalar, binding = kListedPixelsBinding) writeonly buffer Pixels { uint pixels[]; };

layout(constant_id = kTextureTapsConstant) const uint kTextureTaps = 2u;
layout(constant_id = kStepConstant) const uint kStep = 1u;  // pixels between the level's points; 1: the picture itself
layout(constant_id = kFirstConstant) const bool kCoarsest = false;   // there is no coarser level: every surface is listed
layout(constant_id = kToleranceConstant) const float kTolerance = 0.1;  // how much the four may differ, of the brightest

#include "include/scene/tiles.glsl"
#include "include/surface/surface.glsl"
#include "include/surface/light_samples.glsl"

bool level_place(out uvec2 place) {
  if (kStep == 1u) return tile_pixel(place);
  uvec2 size = (frame.size + (kStep - 1u)) / kStep;
  place = min(gl_GlobalInvocationID.xy, size - 1u);
  return all(lessThan(gl_GlobalInvocationID.xy, size));
}

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

// Light between the four points around a place. @return false where they do not show the place's plane or differ too much.
bool light_between(uvec2 place, uint key, vec3 albedo, out mat2x3 light) {
  uvec2 size = (frame.size + (2u * kStep - 1u)) / (2u * kStep);
  uvec2 low = place >> 1, high = low + (place & 1u);
  bool inside = all(lessThan(high, size));
  high = min(high, size - 1u);
  uvec4 t00 = imageLoad(coarser, ivec2(low)), t11 = imageLoad(coarser, ivec2(high));
  uvec4 t10 = imageLoad(coarser, ivec2(high.x, low.y)), t01 = imageLoad(coarser, ivec2(low.x, high.y));
  mat2x3 l00 = sample_of(t00), l10 = sample_of(t10), l01 = sample_of(t01), l11 = sample_of(t11);
  light = (l00 + l10 + l01 + l11) * 0.25;
  vec3 c00 = radiance_at(l00, albedo), c10 = radiance_at(l10, albedo), c01 = radiance_at(l01, albedo), c11 = radiance_at(l11, albedo);
  vec3 most = max(max(c00, c10), max(c01, c11)), apart = most - min(min(c00, c10), min(c01, c11));
  bool same = t00.w == key && t10.w == key && t01.w == key && t11.w == key;
  return inside && same && max(max(apart.r, apart.g), apart.b) <= kTolerance * max(max(most.r, most.g), most.b);
}

void main() {
  uvec2 place;
  bool here = level_place(place);
  uvec2 pixel = place * kStep;
  float stored_depth = texelFetch(depths, ivec2(pixel), 0).r;
  uint word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, stored_depth);
  bool surface = here && word != 0u;
  bool shared_light = false;
  if (!kCoarsest) {
    float depth = word != 0u ? stored_depth : 1.0;
    vec3 ray = pixel_ray(pixel);
    float t = view_distance(surface_depth(depth), frame.near_plane);
    uint key = plane_key(word, lattice_from_world(islands[surface_island(word)], ray * t));
    vec3 albedo = vec3(0.3);  // of an average surface
    if (kStep == 1u) albedo = surface_texel(word, ray, t, kTextureTaps).rgb;
    mat2x3 light;
    shared_light = light_between(place, key, albedo, light) && surface;
    if (shared_light && kStep == 1u) imageStore(radiance, ivec2(pixel), vec4(sanitised(radiance_at(light, albedo)), 1.0));
    if (shared_light && kStep != 1u) imageStore(own, ivec2(place), packed_sample(light, key));
  }
  if (kStep != 1u && here && !surface) imageStore(own, ivec2(place), uvec4(kNoSurface));
  list_pixel(pixel, surface && !shared_light);
}
