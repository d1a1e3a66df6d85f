#version 460
#extension GL_GOOGLE_include_directive : require
// The picture of this frame mixed with what earlier frames saw of the same surfaces at other places of the pixel. What a pixel shows moves
// exactly as its island or the sky does, so that it is known where the last frame had it; words and depths of the last frame say whether it is the
// same surface. Where several surfaces share a pixel, colours from around it bound what is taken over, if they move apart. docs/decisions/0048.
#include "include/frame/common.glsl"
#include "include/scene/layers.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/temporal.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kMotionsBinding) uniform usamplerBuffer motions;
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kLayerDepthsBinding) uniform sampler2D water_depths;
layout(binding = kFreshPictureBinding) uniform sampler2D fresh;
layout(binding = kKeptSurfacesBinding, r32ui) readonly uniform uimage2D kept_surfaces;
layout(binding = kKeptDepthsBinding) uniform sampler2D kept_depths;
layout(binding = kKeptPictureBinding) uniform sampler2D kept_picture;
layout(binding = kMixedPictureBinding, rgba16f) writeonly uniform image2D mixed;  // light of the display; alpha: see Mixed
layout(binding = kPictureBinding, rgba8) writeonly uniform image2D picture;
layout(scalar, binding = kTilesBinding) readonly buffer Tiles { uint tiles[]; };  // find_mixed_tiles.comp
layout(scalar, binding = kTileDispatchesBinding) readonly buffer Dispatches { TileDispatch dispatches[2]; };
layout(push_constant, scalar) uniform Push { TemporalStep step; } push;

layout(constant_id = kTranslucentConstant) const bool kTranslucent = false;  // there is water or glass
layout(constant_id = kCloudLayerConstant) const bool kClouds = false;        // there are clouds before the sky

layout(constant_id = kPlaneConstant) const bool kPlane = false;  // of tiles that show one plane alone

#include "include/scene/coverage.glsl"

// Frames that are mixed, where a pixel shows one surface and where it shows several; and where nothing moves, so that nothing blurs.
const float kFramesInside = 4.0, kFramesAtEdges = 8.0;
const float kFramesInsideAtRest = 16.0, kFramesAtEdgesAtRest = 32.0;
const float kApart = 0.1;          // pixels a frame: surfaces that move apart by more are bounded by colours
const float kBounded = 64.0;       // added to the count where they do
const float kSeveral = 128.0;      // added where a pixel shows several surfaces

vec4 row_of(uint mover, uint row) { return uintBitsToFloat(texelFetch(motions, int(mover * kMotionTexels + row))); }

Motion motion_of(uint mover) { return Motion(row_of(mover, 0u), row_of(mover, 1u), row_of(mover, 2u)); }

struct Moved {
  vec2 by;      // pixels, to the last frame
  float depth;  // there; negative: it was not there
};

Moved moved(Motion motion, vec2 place, float depth) {
  vec4 at = vec4(place, 1.0, depth);
  float w = dot(motion.w, at);
  if (w <= 0.0) return Moved(vec2(0.0), -1.0);
  return Moved(vec2(dot(motion.x, at), dot(motion.y, at)) / w - place, depth / w);
}

ivec2 in_picture(ivec2 pixel) { return clamp(pixel, ivec2(0), ivec2(frame.size) - 1); }
vec3 light_of(vec3 encoded) { return encoded * encoded; }
uint mover_of(uint word) { return word != 0u ? surface_island(word) : push.step.sky; }

// The 3x3 pixels about one.
struct Around {
  uint words[9];
  float depths[9];
};

Around around(ivec2 pixel) {
  Around a;
  for (int i = 0; i < 9; ++i) {
    ivec2 at = in_picture(pixel + ivec2(i % 3 - 1, i / 3 - 1));
    a.depths[i] = texelFetch(depths, at, 0).r;
    a.words[i] = covered_word(imageLoad(surfaces, at).r, a.depths[i]);
  }
  return a;
}

// Light within that of the 3x3 pixels about one, if `wanted`. As a loop without rounds it costs nothing where no pixel of a strip wants it.
vec3 within_around(vec3 light, ivec2 pixel, bool wanted) {
  vec3 low = vec3(wanted ? 1e9 : -1e9), high = -low;
  int count = wanted ? 9 : 0;
  for (int i = 0; i < count; ++i) {
    vec3 one = light_of(texelFetch(fresh, in_picture(pixel + ivec2(i % 3 - 1, i / 3 - 1)), 0).rgb);
    low = min(low, one);
    high = max(high, one);
  }
  return clamp(light, low, high);
}

bool bends(float before, float here, float after) {
  return abs((before - here) + (after - here)) > push.step.bend * max(max(before, after), here);
}

bool is_edge(Around a) {
  bool same = true;
  for (int i = 0; i < 9; ++i) same = same && a.words[i] == a.words[4];
  return !same || bends(a.depths[3], a.depths[4], a.depths[5]) || bends(a.depths[1], a.depths[4], a.depths[7]) ||
         bends(a.depths[0], a.depths[4], a.depths[8]) || bends(a.depths[2], a.depths[4], a.depths[6]);
}

// What was mixed so far: its light, of how many frames, and whether surfaces that move apart were among them.
struct Mixed {
  vec3 light;
  float frames;
  bool bounded;
};

const Mixed kNone = Mixed(vec3(0.0), 0.0, false);

// Sharper than linear, since what is taken over again and again would blur: Catmull and Rom's filter by five linear samples, without the four
// corners of its 4x4 pixels (J. Jimenez, Filmic SMAA, 2016). @param from place in the picture [pixels].
vec3 sharply(vec2 from) {
  vec2 size = vec2(frame.size), middle = floor(from - 0.5) + 0.5, t = from - middle;
  vec2 before = t * (-0.5 + t * (1.0 - 0.5 * t)), after = t * t * (-0.5 + 0.5 * t);
  vec2 first = 1.0 + t * t * (-2.5 + 1.5 * t), second = t * (0.5 + t * (2.0 - 1.5 * t)), both = first + second;
  vec2 low = (middle - 1.0) / size, between = (middle + second / both) / size, high = (middle + 2.0) / size;
  vec4 sum = vec4(textureLod(kept_picture, between, 0.0).rgb, 1.0) * (both.x * both.y);
  sum += vec4(textureLod(kept_picture, vec2(low.x, between.y), 0.0).rgb, 1.0) * (before.x * both.y);
  sum += vec4(textureLod(kept_picture, vec2(high.x, between.y), 0.0).rgb, 1.0) * (after.x * both.y);
  sum += vec4(textureLod(kept_picture, vec2(between.x, low.y), 0.0).rgb, 1.0) * (both.x * before.y);
  sum += vec4(textureLod(kept_picture, vec2(between.x, high.y), 0.0).rgb, 1.0) * (both.x * after.y);
  return max(sum.rgb / sum.a, vec3(0.0));
}

Mixed taken_over(ivec2 pixel, Around a, bool edge, bool anything, bool changed, out float apart, out bool at_rest) {
  at_rest = false;
  vec2 sampled = vec2(pixel) + frame.sample_in_pixel;
  int nearest = 4, farthest = 4;
  if (edge)
    for (int i = 0; i < 9; ++i) {
      if (a.depths[i] > a.depths[nearest]) nearest = i;
      if (a.depths[i] < a.depths[farthest]) farthest = i;
    }
  uint mover = mover_of(a.words[nearest]);
  // What moves apart: with another island, or else at another distance.
  int other = farthest;
  for (int i = 0; i < 9; ++i) other = edge && mover_of(a.words[i]) != mover ? i : other;
  vec2 to_nearest = vec2(nearest % 3 - 1, nearest / 3 - 1), to_other = vec2(other % 3 - 1, other / 3 - 1);
  Motion by_nearest = motion_of(mover);
  Moved motion = moved(by_nearest, sampled + to_nearest, a.depths[nearest]);
  Moved behind = moved(motion_of(mover_of(a.words[other])), sampled + to_other, a.depths[other]);
  apart = edge ? length(motion.by - behind.by) : 0.0;
  if (motion.depth < 0.0) return kNone;
  vec2 from = vec2(pixel) + 0.5 + motion.by;
  // Rounding does not blur what stands still.
  at_rest = all(lessThan(abs(motion.by), vec2(1.0 / 256.0)));
  if (at_rest) from = vec2(pixel) + 0.5;
  if (any(lessThan(from, vec2(0.0))) || any(greaterThan(from, vec2(frame.size)))) return kNone;
  vec2 slope = 0.5 * vec2(a.depths[5] - a.depths[3], a.depths[7] - a.depths[1]);
  vec2 first = floor(from - 0.5), between = from - 0.5 - first;
  vec4 sum = vec4(0.0);
  float all = 0.0;
  bool bounded = false;
  // Reverse depths of the 3x3 surfaces, as the last frame had them.
  float since = motion.depth / max(a.depths[nearest], 1e-9);
  float low = a.depths[farthest] * since * 0.97, high = a.depths[nearest] * since * 1.03;
  for (int i = 0; i < 4; ++i) {
    vec2 corner = vec2(i & 1, i >> 1);
    float weight = (corner.x > 0.0 ? between.x : 1.0 - between.x) * (corner.y > 0.0 ? between.y : 1.0 - between.y);
    ivec2 at = in_picture(ivec2(first + corner));
    float depth = texelFetch(kept_depths, at, 0).r;
    uint word = covered_word(imageLoad(kept_surfaces, at).r, depth);
    vec4 texel = texelFetch(kept_picture, at, 0);
    bool taken;
    if (edge) {
      taken = false;
      for (int k = 0; k < 9; ++k) taken = taken || word == a.words[k];
      taken = taken && depth >= low && depth <= high;
    } else {
      vec2 away = vec2(at) + push.step.last_sample - (sampled + motion.by);
      float expected = motion.depth + dot(slope, away);
      taken = word == a.words[4] && abs(depth - expected) <= 4.0 * push.step.bend * max(depth, expected) + 0.25 * (abs(slope.x) + abs(slope.y));
    }
    // What the jitter has missed this time: it is as far, and has moved as this has.
    if (!changed && mover_of(word) == mover) taken = taken || length(moved(by_nearest, sampled, depth / max(since, 1e-9)).by - motion.by) < 0.25;
    if (!taken && !anything) continue;
    if (weight > 0.02 && mod(texel.a, kSeveral) >= kBounded) bounded = true;
    sum += vec4(texel.rgb, mod(texel.a, kBounded)) * weight;
    all += weight;
  }
  if (all < 0.01) return kNone;
  sum /= all;
  if (all > 0.999) sum.rgb = sharply(from);
  return Mixed(sum.rgb, sum.a * min(1.0, all * 2.0), bounded);
}

// Where a tile shows one plane: the surface alone says what is taken over. @param frames mixed so far, 0: none.
vec3 taken_over_on_plane(ivec2 pixel, out float frames, out bool at_rest) {
  frames = 0.0;
  float depth = texelFetch(depths, pixel, 0).r;
  uint word = covered_word(imageLoad(surfaces, pixel).r, depth);
  // Within the tile, so that both are of the plane.
  ivec2 side = ivec2((pixel.x & 7) < 7 ? 1 : -1, (pixel.y & 7) < 7 ? 1 : -1);
  vec2 slope = vec2(texelFetch(depths, in_picture(pixel + ivec2(side.x, 0)), 0).r, texelFetch(depths, in_picture(pixel + ivec2(0, side.y)), 0).r);
  slope = (slope - depth) * vec2(side);
  vec2 sampled = vec2(pixel) + frame.sample_in_pixel;
  Moved motion = moved(motion_of(mover_of(word)), sampled, depth);
  at_rest = all(lessThan(abs(motion.by), vec2(1.0 / 256.0)));
  vec2 from = vec2(pixel) + 0.5 + (at_rest ? vec2(0.0) : motion.by);
  ivec2 at = in_picture(ivec2(floor(from)));
  float there = texelFetch(kept_depths, at, 0).r;
  uint kept_word = covered_word(imageLoad(kept_surfaces, at).r, there);
  float expected = motion.depth + dot(slope, vec2(at) + push.step.last_sample - (sampled + motion.by));
  bool same = kept_word == word && abs(there - expected) <= 4.0 * push.step.bend * max(there, expected) + 0.25 * (abs(slope.x) + abs(slope.y));
  same = same && motion.depth >= 0.0 && all(greaterThanEqual(from, vec2(0.0))) && all(lessThanEqual(from, vec2(frame.size)));
  // Of the four pixels about the place: more than it can be where one of them showed several surfaces. At rest it is one pixel's.
  float count = textureLod(kept_picture, from / vec2(frame.size), 0.0).a;
  bool clean = at_rest ? mod(count, kSeveral) < kBounded : count < kFramesInsideAtRest + 1.0;
  if (same && clean) frames = mod(count, kBounded);
  return sharply(from);
}

// Light of the display under this frame's exposure, by a curve that bends as the tone curves do.
vec3 exposed_now(vec3 light) { return light * push.step.exposure_ratio / (1.0 + (push.step.exposure_ratio - 1.0) * light); }

void show(ivec2 pixel, vec3 before, float frames, float flags) {
  vec3 light = mix(before, light_of(texelFetch(fresh, pixel, 0).rgb), 1.0 / frames);
  imageStore(mixed, pixel, vec4(light, frames + flags));
  imageStore(picture, pixel, vec4(floor(sqrt(light) * 255.0 + 0.5) / 255.0, 1.0));
}

void main() {
  uvec2 count = (frame.size + (kTileEdge - 1u)) / kTileEdge;
  uint kind = kPlane ? 1u : 0u, slot = gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x;
  if (slot >= dispatches[kind].tiles) return;
  uint tile = tiles[kind * count.x * count.y + slot];
  ivec2 pixel = ivec2(uvec2(tile & 0xffffu, tile >> 16) * kTileEdge + gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size)))) return;
  bool at_rest = false;
  if (kPlane) {
    float frames;
    vec3 before = taken_over_on_plane(pixel, frames, at_rest);
    show(pixel, exposed_now(before), min(frames, (at_rest ? kFramesInsideAtRest : kFramesInside) - 1.0) + 1.0, 0.0);
    return;
  }
  Around a = around(pixel);
  bool edge = is_edge(a);
  bool seen_through = kTranslucent && layer_depth_at(water_depths, pixel, frame.layers_area) > 0.0;
  seen_through = seen_through || (kClouds && a.words[4] == 0u);
  bool changed = in_area(uvec2(pixel), push.step.changed_area);
  float apart = 0.0;
  Mixed so_far = kNone;
  if (push.step.kept != 0u) so_far = taken_over(pixel, a, edge, seen_through, changed, apart, at_rest);
  so_far.light = exposed_now(so_far.light);
  bool bounded = so_far.bounded || seen_through || changed || apart > kApart;
  so_far.light = within_around(so_far.light, pixel, bounded);
  float most = at_rest ? (edge ? kFramesAtEdgesAtRest : kFramesInsideAtRest) : edge ? kFramesAtEdges : kFramesInside;
  show(pixel, so_far.light, min(so_far.frames, most - 1.0) + 1.0, (apart > kApart ? kBounded : 0.0) + (edge ? kSeveral : 0.0));
}
