#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance at another resolution. Average: of a pixel from its samples, their mean, as a sensor's square pixel gathers it. Shrink: a level of bloom's
// pyramid from the finer one by 13 taps of 2x2 texels (J. Jimenez, Next Generation Post Processing in Call of Duty, 2014), on the texel grid, with
// nothing but black beyond the edges, so that no light is made. Spread: the coarser levels mixed into a finer one, in place: the same image is then
// both `fine` and `made`. docs/settings.md, aa.samples and shadow.samples; docs/exposure.md, docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/bloom.h"
#include "shared/exposure.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kFineBloomBinding, rgba16f) readonly uniform image2D fine;
layout(binding = kCoarseBloomBinding, rgba16f) readonly uniform image2D coarse;  // to spread
layout(binding = kMadeBloomBinding, rgba16f) writeonly uniform image2D made;
layout(scalar, binding = kExposureBinding) uniform Chosen { Exposure exposure; };
layout(binding = kTotalBinding, rgba32f) uniform image2D total;  // of a picture that has several parts
layout(scalar, binding = kTileDispatchesBinding) readonly buffer Dispatches { TileDispatch dispatches[]; };
layout(scalar, binding = kTilesBinding) readonly buffer Tiles { uint tiles[]; };  // x | y << 16, of 8x8 texels
layout(push_constant) uniform Push { BloomStep step; float share; } push;  // share: of a part in the total

layout(constant_id = kFilterConstant) const uint kFilter = kFilterAverage;
// To shrink: from radiance, which is exposed and of which what is too bright is taken. To average: the first part, there is no total yet.
layout(constant_id = kFirstConstant) const bool kFirst = false;
layout(constant_id = kSamplesPerEdgeConstant) const uint kSamplesPerEdge = 2u;
layout(constant_id = kColumnsConstant) const bool kColumns = false;  // by columns of texels, without shared memory
layout(constant_id = kListedConstant) const bool kListed = false;  // tiles of what is made are listed; if not, something is bound for the lists
layout(constant_id = kAccumulateConstant) const bool kAccumulate = false;  // a part is added to those before

uvec2 coarse_size() { return push.step.coarse_size; }
const int kTile = 20;  // texels that 8x8 coarser ones look at, along an edge
const int kTileTexels = kTile * kTile;
#include "include/post/bloom.glsl"
#include "include/post/too_bright.glsl"

void put_spread(uvec2 at, vec3 glow) {
  if (any(greaterThanEqual(at, push.step.fine_size))) return;
  imageStore(made, ivec2(at), vec4(mix(imageLoad(fine, ivec2(at)).rgb, glow, kBloomShare), 1.0));
}
#include "include/post/bloom_columns.glsl"

vec3 texel(ivec2 at) {
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(push.step.fine_size)))) return vec3(0.0);
  vec3 value = imageLoad(fine, at).rgb;
  return kFirst ? too_bright(value, push.step.threshold) : value;
}

float calmed(vec3 mean) { return 1.0 / (1.0 + dot(mean, vec3(0.2126, 0.7152, 0.0722))); }

// Weighted mean of five squares of 4x4 texels, which is what the 13 taps are: of their sums. The first step weighs them by their darkness as well
// (B. Karis: Tone Mapping, 2013), so that a lone bright pixel does not flicker; yet never takes more than the plain mean.
vec3 mean_of_squares(vec3 middle, vec3 corners[4]) {
  vec3 plain = (0.5 * middle + 0.125 * (corners[0] + corners[1] + corners[2] + corners[3])) / 16.0;
  if (!kFirst) return plain;
  float weight = 0.5 * calmed(middle / 16.0), weights = weight;
  vec3 sum = weight * middle;
  for (int i = 0; i < 4; ++i) {
    weight = 0.125 * calmed(corners[i] / 16.0);
    weights += weight;
    sum += weight * corners[i];
  }
  return min(plain, sum / (16.0 * weights));
}

// @param at corner of what it looks at, in `tile`.
vec3 shrunk(ivec2 at) {
  vec3 middle = vec3(0.0), corners[4] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  for (int y = 0; y < 6; ++y) {
    int row = (at.y + y) * kTile + at.x;
    vec3 inner = tile[row + 2] + tile[row + 3], left = tile[row + 1] + inner, right = inner + tile[row + 4];
    vec3 low = left + tile[row], high = right + tile[row + 5];
    if (y >= 1 && y < 5) middle += left + tile[row + 4];
    if (y < 4) {
      corners[0] += low;
      corners[1] += high;
    }
    if (y >= 2) {
      corners[2] += low;
      corners[3] += high;
    }
  }
  return mean_of_squares(middle, corners);
}

void shrink() {
  uint thread = gl_LocalInvocationIndex;
  if (thread == 0u) tile_lit = 0u;
  barrier();
  ivec2 corner = ivec2(gl_WorkGroupID.xy) * 16 - 2;
  bool bright = false;
  for (int i = int(thread); i < kTileTexels; i += 64) {
    tile[i] = texel(corner + ivec2(i % kTile, i / kTile));
    bright = bright || tile[i] != vec3(0.0);
  }
  if (bright) atomicOr(tile_lit, 1u);
  barrier();
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(push.step.coarse_size)))) return;
  vec3 sum = tile_lit != 0u ? shrunk(2 * ivec2(gl_LocalInvocationID.xy)) : vec3(0.0);
  imageStore(made, at, vec4(sum, 1.0));
}

// Sums of a row's texels: -2 to 1, 0 to 3 and -1 to 2 from a pair on.
struct RowSums {
  vec3 low, high, middle;
};

RowSums sums_of_row(ivec2 pair) {
  vec3 t[6];
  for (int i = 0; i < 6; ++i) t[i] = texel(pair + ivec2(i - 2, 0));
  vec3 inner = t[2] + t[3], left = t[1] + inner, right = inner + t[4];
  return RowSums(left + t[0], right + t[5], left + t[4]);
}

// As shrink(), by columns of 8 texels that an invocation takes downwards. A row of the work group takes a tile of 8x8, of those listed or of all.
void shrink_columns() {
  uvec2 tile_at = uvec2(gl_WorkGroupID.x * 8u + gl_LocalInvocationID.y, gl_WorkGroupID.y);
  bool here = true;
  if (kListed) {
    uint slot = (gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * 8u + gl_LocalInvocationID.y;
    here = slot < dispatches[0].tiles;
    uint listed = tiles[here ? slot : 0u];
    tile_at = uvec2(listed & 0xffffu, listed >> 16);
  }
  ivec2 at = ivec2(tile_at * 8u) + ivec2(gl_LocalInvocationID.x, 0);
  here = here && at.x < int(push.step.coarse_size.x);
  // Squares of four rows share two with the next; each is summed row by row, as shrink() does it.
  RowSums a = sums_of_row(2 * at - ivec2(0, 2)), b = sums_of_row(2 * at - ivec2(0, 1)), c = sums_of_row(2 * at),
          d = sums_of_row(2 * at + ivec2(0, 1));
  vec3 corners[4], low = c.low + d.low, high = c.high + d.high;
  corners[2] = a.low + b.low + c.low + d.low;
  corners[3] = a.high + b.high + c.high + d.high;
  for (int row = 0; row < 8; ++row, ++at.y) {
    RowSums e = sums_of_row(2 * at + ivec2(0, 2)), f = sums_of_row(2 * at + ivec2(0, 3));
    corners[0] = corners[2];
    corners[1] = corners[3];
    corners[2] = low + e.low + f.low;
    corners[3] = high + e.high + f.high;
    vec3 sum = mean_of_squares(b.middle + c.middle + d.middle + e.middle, corners);
    if (here && at.y < int(push.step.coarse_size.y)) imageStore(made, at, vec4(sum, 1.0));
    low = e.low + f.low;
    high = e.high + f.high;
    b = d;
    c = e;
    d = f;
  }
}

void average() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, push.step.coarse_size))) return;
  vec3 sum = vec3(0.0);
  for (uint y = 0u; y < kSamplesPerEdge; ++y)
    for (uint x = 0u; x < kSamplesPerEdge; ++x) sum += imageLoad(fine, ivec2(pixel * kSamplesPerEdge + uvec2(x, y))).rgb;
  sum /= float(kSamplesPerEdge * kSamplesPerEdge);
  if (kAccumulate) {
    sum *= push.share;
    if (!kFirst) sum += imageLoad(total, ivec2(pixel)).rgb;
    imageStore(total, ivec2(pixel), vec4(sum, 1.0));
  }
  imageStore(made, ivec2(pixel), vec4(sum, 1.0));
}

void main() {
  if (kFilter == kFilterAverage)
    average();
  else if (kFilter == kFilterShrink && kColumns)
    shrink_columns();
  else if (kFilter == kFilterShrink)
    shrink();
  else if (kColumns)
    spread_columns();
  else
    put_spread(gl_GlobalInvocationID.xy, spread_from_coarser());
}
