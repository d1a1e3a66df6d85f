// The sums of bloom.glsl for a CPU device: an invocation takes a column of texels downwards and keeps what the next rows need, since lavapipe reads
// shared memory one lane at a time. Needs before the include: bloom.glsl, and `void put_spread(uvec2 at, vec3 glow)`, which is called once
// for each texel of the finer level, and for some beyond its edges. The work group is 8x8. docs/decisions/0077-bloom-by-columns.md.
#ifndef SKERRY_BLOOM_COLUMNS_GLSL
#define SKERRY_BLOOM_COLUMNS_GLSL

vec3 spread_along_row(ivec4 columns, vec4 weights, int y) {
  ivec2 size = ivec2(coarse_size());
  int row = clamp(y, 0, size.y - 1);
  vec3 sum = weights.x * imageLoad(coarse, ivec2(columns.x, row)).rgb + weights.y * imageLoad(coarse, ivec2(columns.y, row)).rgb +
             weights.z * imageLoad(coarse, ivec2(columns.z, row)).rgb + weights.w * imageLoad(coarse, ivec2(columns.w, row)).rgb;
  return y == row ? sum : vec3(0.0);
}

// Of 64 columns of the finer level, the rows that kSpreadRows coarser ones lie in.
void spread_columns() {
  int x = int(gl_WorkGroupID.x * 64u + gl_LocalInvocationIndex), first = int(gl_WorkGroupID.y * kSpreadRows);
  ivec4 reach = (x + 1) / 2 - 2 + ivec4(0, 1, 2, 3), columns = clamp(reach, ivec4(0), ivec4(coarse_size().x - 1u));
  vec4 weights = ((x & 1) == 0 ? kTent : kTent.wzyx) * vec4(equal(reach, columns));
  vec3 a = spread_along_row(columns, weights, first - 2), b = spread_along_row(columns, weights, first - 1),
       c = spread_along_row(columns, weights, first), d = spread_along_row(columns, weights, first + 1);
  for (int row = first; row < min(first + int(kSpreadRows), int(coarse_size().y)); ++row) {
    vec3 e = spread_along_row(columns, weights, row + 2);
    put_spread(uvec2(x, 2 * row), kTent.x * a + kTent.y * b + kTent.z * c + kTent.w * d);
    put_spread(uvec2(x, 2 * row + 1), kTent.w * b + kTent.z * c + kTent.y * d + kTent.x * e);
    a = b;
    b = c;
    c = d;
    d = e;
  }
}
#endif
