// Clouds that nearest surfaces of water and glass mirror, for squares of four pixels; march_mirrored_clouds.glsl fills them in.
#ifndef SKERRY_MIRRORED_CLOUDS_GLSL
#define SKERRY_MIRRORED_CLOUDS_GLSL

const float kMirrorsNothing = -1.0;  // in place of what clouds leave: none of the four has such a surface

// What is mirrored, behind the clouds before it: between the squares about the pixel. Its own is among them.
vec3 past_mirrored_clouds(sampler2D mirrored_clouds, vec3 mirrored, uvec2 pixel) {
  ivec2 own = ivec2(pixel / 2u), side = ivec2(pixel % 2u) * 2 - 1, last = textureSize(mirrored_clouds, 0) - 1;
  vec4 sum = vec4(0.0);
  float shares = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 off = ivec2(i & 1, i >> 1);
    vec4 seen = texelFetch(mirrored_clouds, clamp(own + off * side, ivec2(0), last), 0);
    float share = seen.a == kMirrorsNothing ? 0.0 : (off.x == 0 ? 0.75 : 0.25) * (off.y == 0 ? 0.75 : 0.25);
    sum += seen * share;
    shares += share;
  }
  sum /= max(shares, 1e-6);
  return shares > 0.0 ? mirrored * sum.a + sum.rgb : mirrored;
}
#endif
