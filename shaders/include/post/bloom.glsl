// A coarser level of bloom's pyramid, seen at the finer one's texels: 3x3 tent of bilinear taps (J. Jimenez 2014), on the texel grid, black
// beyond the edges. Needs before the include: `coarse` (rgba16f image), `coarse_size()`, `kTileTexels` (at least 128); the work group is 8x8 finer
// texels. docs/exposure.md.
#ifndef SKERRY_BLOOM_GLSL
#define SKERRY_BLOOM_GLSL

shared vec3 tile[kTileTexels];  // 8x8 coarser texels, then rows of them
shared uint tile_lit;
const uint kRows = 64u;

// Weights of four coarser texels on a line, for the finer one on the left of a pair; mirrored for the right one.
const vec4 kTent = vec4(0.0625, 0.3125, 0.4375, 0.1875);

// Every invocation of the work group calls it, once.
vec3 spread_from_coarser() {
  uint thread = gl_LocalInvocationIndex;
  uvec2 local = gl_LocalInvocationID.xy;
  if (thread == 0u) tile_lit = 0u;
  barrier();
  ivec2 at = ivec2(gl_WorkGroupID.xy) * 4 - 2 + ivec2(local);
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(coarse_size())));
  vec3 value = inside ? imageLoad(coarse, at).rgb : vec3(0.0);
  tile[thread] = value;
  if (value != vec3(0.0)) atomicOr(tile_lit, 1u);
  barrier();
  if (tile_lit == 0u) return vec3(0.0);  // the same for all
  uvec2 first = (local + 1u) / 2u;         // of the four: b - 2 + 2 or b - 1 + 2
  vec4 x = (local.x & 1u) == 0u ? kTent : kTent.wzyx, y = (local.y & 1u) == 0u ? kTent : kTent.wzyx;
  uint row = local.y * 8u + first.x;
  tile[kRows + thread] = x.x * tile[row] + x.y * tile[row + 1u] + x.z * tile[row + 2u] + x.w * tile[row + 3u];
  barrier();
  uint column = first.y * 8u + local.x;
  return y.x * tile[kRows + column] + y.y * tile[kRows + column + 8u] + y.z * tile[kRows + column + 16u] + y.w * tile[kRows + column + 24u];
}
#endif
