#version 460
#extension GL_GOOGLE_include_directive : require
// The picture of this frame, whose edges are smooth already, mixed with those of the frames before it, each as it was. A first step mixes all
// pixels if the frame is at rest, and keeps the frame; a second one those at edges. What they show moves exactly as its island or the sky does, so that it is
// known where each earlier frame had it; keys say whether it is a surface that the pixel may show. docs/decisions/0088.
#include "include/frame/common.glsl"
#include "include/scene/layers.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/edges.h"
#include "shared/temporal.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kMotionsBinding) uniform usamplerBuffer motions;
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kLayerDepthsBinding) uniform sampler2D water_depths;
layout(binding = kFreshPictureBinding) uniform sampler2D fresh;
layout(binding = kKeptPicturesBinding, r32ui) uniform uimage2DArray kept_pictures;
layout(binding = kKeptKeysBinding, r32ui) uniform uimage2DArray kept_keys;
layout(binding = kPictureBinding, rgba8) uniform image2D picture;  // unless the frame is at rest, the fresh one
layout(scalar, binding = kTileDispatchesBinding) readonly buffer Dispatches { TileDispatch dispatches[kEdgeDispatches]; };
layout(scalar, binding = kTilesBinding) readonly buffer Tiles { uint tiles[]; };  // that show edges, x | y << 16
layout(push_constant, scalar) uniform Push { TemporalStep step; } push;

layout(constant_id = kTranslucentConstant) const bool kTranslucent = false;  // there is water or glass
layout(constant_id = kCloudLayerConstant) const bool kClouds = false;        // there are clouds before the sky
layout(constant_id = kEdgesConstant) const bool kEdges = false;              // the second step
layout(constant_id = kStoreConstant) const bool kStore = false;              // the first step keeps the frame and mixes nothing: nothing is at rest

#include "include/scene/coverage.glsl"

// An earlier frame counts half as much where a pixel has moved so far since [pixels]: what is guessed of its motion is then wrong by more.
const float kHalfAsMuch = 3.5;

vec4 row_of(uint mover, uint row) { return uintBitsToFloat(texelFetch(motions, int(mover * kMotionTexels + row))); }

Motion motion_of(uint mover, uint slot) {
  mover += slot * (push.step.sky + 1u);
  return Motion(row_of(mover, 0u), row_of(mover, 1u), row_of(mover, 2u));
}

struct Moved {
  vec2 by;      // pixels, to an earlier frame
  float since;  // reverse depth there, as a share of that here; negative: it was not there
};

Moved moved(Motion motion, vec2 place, float depth) {
  vec4 at = vec4(place, 1.0, depth);
  float w = dot(motion.w, at);
  if (w <= 0.0) return Moved(vec2(0.0), -1.0);
  return Moved(vec2(dot(motion.x, at), dot(motion.y, at)) / w - place, 1.0 / w);
}

ivec2 in_picture(ivec2 pixel) { return clamp(pixel, ivec2(0), ivec2(frame.size) - 1); }
vec3 light_of(vec3 encoded) { return encoded * encoded; }
uint mover_of(uint word) { return word != 0u ? surface_island(word) : push.step.sky; }

// What a pixel shows, in 32 bits: 7 of the exponent and 13 of the mantissa of its reverse depth, 4 of a hash of its island and 8 of one of its face
// and block; 0: the sky.
const uint kHash = 0x9e3779b1u;
uint identity_of(uint word) {
  uint island = surface_island(word);
  return word != 0u ? (island * kHash >> 28 << 8) | ((word - (island << kIslandShift)) * kHash >> 24) : 0u;
}
uint kept_key(uint word, float depth) { return word != 0u ? (floatBitsToUint(depth) >> 10 << 12) | identity_of(word) : 0u; }
uint key_identity(uint key) { return key & 0xfffu; }
float key_depth(uint key) { return uintBitsToFloat(key >> 12 << 10); }

uint key_at(ivec2 pixel, uint slot) { return imageLoad(kept_keys, ivec3(pixel, slot)).r; }
bool has(uint slots, uint slot) { return (slots >> slot & 1u) != 0u; }

// Light of the display under this frame's exposure, by a curve that bends as the tone curves do.
vec3 kept_light(ivec2 pixel, uint slot) {
  vec3 light = light_of(unpackUnorm4x8(imageLoad(kept_pictures, ivec3(pixel, slot)).r).rgb);
  float ratio = push.step.exposure_ratios[slot];
  return light * ratio / (1.0 + (ratio - 1.0) * light);
}

vec3 own_light(ivec2 pixel) { return light_of(unpackUnorm4x8(imageLoad(kept_pictures, ivec3(pixel, push.step.slot)).r).rgb); }
vec3 fresh_light(ivec2 pixel) { return kEdges ? own_light(pixel) : light_of(texelFetch(fresh, pixel, 0).rgb); }

// Light within that of the 3x3 pixels about one, if `wanted`. As a loop without rounds it costs nothing where no pixel of a strip wants it.
vec3 within_around(vec3 light, ivec2 pixel, bool wanted) {
  vec3 low = vec3(wanted ? 1e9 : -1e9), high = -low;
  int count = wanted ? 9 : 0;
  for (int i = 0; i < count; ++i) {
    vec3 one = fresh_light(in_picture(pixel + ivec2(i % 3 - 1, i / 3 - 1)));
    low = min(low, one);
    high = max(high, one);
  }
  return clamp(light, low, high);
}

// Of frames in which nothing has moved since, in the order of slots: at rest the mean has the same bits frame after frame.
// @param packed this frame's picture, as it is kept: it must have the bits that it will have when it is read again.
vec3 mixed_at_rest(ivec2 pixel, uint packed, uint still) {
  vec4 sum = vec4(0.0);
  uint count = still != 0u ? kMixedFrames : 0u;
  vec3 here = light_of(unpackUnorm4x8(packed).rgb);
  for (uint slot = 0u; slot < count; ++slot) {
    bool own = slot == push.step.slot;
    if (own || has(still, slot)) sum += vec4(own ? here : kept_light(pixel, slot), 1.0);
  }
  return still != 0u ? sum.rgb / sum.a : here;
}

// The 3x3 pixels about one.
struct Around {
  uint identities[9];
  uint nearest_word;
  vec2 to_nearest;
  float nearest, farthest;  // reverse depths
  bool alike;               // all show one surface
};

Around around(ivec2 pixel) {
  Around a;
  a.nearest = -1.0;
  a.farthest = 2.0;
  a.alike = true;
  for (int i = 0; i < 9; ++i) {
    ivec2 at = in_picture(pixel + ivec2(i % 3 - 1, i / 3 - 1));
    float depth = texelFetch(depths, at, 0).r;
    uint word = covered_word(imageLoad(surfaces, at).r, depth);
    a.identities[i] = identity_of(word);
    a.alike = a.alike && a.identities[i] == a.identities[0];
    if (depth > a.nearest) {
      a.nearest = depth;
      a.nearest_word = word;
      a.to_nearest = vec2(at - pixel);
    }
    a.farthest = min(a.farthest, depth);
  }
  return a;
}

// @param changed sections came or went here: then identity decides alone. @param still slots of frames since which nothing has moved.
vec3 mixed_at_edge(ivec2 pixel, Around a, bool changed, uint still) {
  vec2 sampled = vec2(pixel) + frame.sample_in_pixel + a.to_nearest;
  uint mover = mover_of(a.nearest_word), island = identity_of(a.nearest_word) >> 8;
  vec4 sum = vec4(0.0);
  for (uint slot = 0u; slot < kMixedFrames; ++slot) {
    bool own = slot == push.step.slot, at_rest = has(still, slot);
    if (!own && !has(push.step.kept, slot)) continue;
    Motion motion = motion_of(mover, slot);
    Moved by = moved(motion, sampled, a.nearest);
    if (own || at_rest) by = Moved(vec2(0.0), 1.0);
    // Edges move with the nearest surface.
    vec2 from = vec2(pixel) + 0.5 + by.by;
    ivec2 at = in_picture(ivec2(floor(from)));
    uint key = key_at(at, slot);
    float there = key_depth(key);
    bool taken = false;
    for (int i = 0; i < 9; ++i) taken = taken || key_identity(key) == a.identities[i];
    taken = taken && there >= a.farthest * by.since * 0.97 && there <= a.nearest * by.since * 1.03;
    // What is too thin to be met by every frame: it is as far as the nearest, and has moved as that has.
    bool thin = !changed && key_identity(key) >> 8 == island && (key == 0u) == (a.nearest == 0.0);
    taken = taken || (thin && length(moved(motion, sampled, there / max(by.since, 1e-9)).by - by.by) < 0.25);
    taken = own || (at_rest && !changed) || (taken && by.since > 0.0 && all(greaterThanEqual(from, vec2(0.0))) && all(lessThan(from, vec2(frame.size))));
    // Pixels of that frame that lie across its lattice would blur.
    vec2 meets = 1.0 - abs(from - vec2(at) - 0.5);
    float weight = meets.x * meets.y / (1.0 + dot(by.by, by.by) / (kHalfAsMuch * kHalfAsMuch));
    sum += taken ? vec4(kept_light(at, slot), 1.0) * weight : vec4(0.0);
  }
  return sum.rgb / sum.a;
}

void show(ivec2 pixel, vec3 light) { imageStore(picture, pixel, vec4(floor(sqrt(light) * 255.0 + 0.5) / 255.0, 1.0)); }

void main() {
  uvec2 tile = gl_WorkGroupID.xy;
  if (kEdges) {
    uint index = gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x;
    if (index >= dispatches[0].tiles) return;
    tile = uvec2(tiles[index] & 0xffffu, tiles[index] >> 16);
  }
  ivec2 pixel = ivec2(tile * kTileEdge + gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size)))) return;
  float depth = texelFetch(depths, pixel, 0).r;
  uint word = covered_word(imageLoad(surfaces, pixel).r, depth);
  bool seen_through = kTranslucent && layer_depth_at(water_depths, pixel, frame.layers_area) > 0.0;
  seen_through = seen_through || (kClouds && word == 0u);
  bool changed = in_area(uvec2(pixel), push.step.changed_area);
  if (kEdges) {
    Around a = around(pixel);
    // What an edge has shared with a pixel stays in its kept picture when the edge has gone.
    bool bounded = seen_through || changed || (a.alike && push.step.still == 0u);
    show(pixel, within_around(mixed_at_edge(pixel, a, changed, push.step.still), pixel, bounded));
    return;
  }
  uint key = kept_key(word, depth);
  uint packed = packUnorm4x8(kStore ? imageLoad(picture, pixel) : texelFetch(fresh, pixel, 0));
  if (!kStore) {
    vec3 light = mixed_at_rest(pixel, packed, changed ? 0u : push.step.still);
    show(pixel, within_around(light, pixel, seen_through && push.step.still != 0u));
  }
  ivec3 at = ivec3(pixel, push.step.slot);
  imageStore(kept_pictures, at, uvec4(packed));
  imageStore(kept_keys, at, uvec4(key));
}
