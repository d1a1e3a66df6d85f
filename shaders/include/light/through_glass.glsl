// What glass leaves of the light of a body. What is known of it is in glass_sums.glsl or glass_lists.glsl, which include this. Needs before the
// include: common.glsl, `frame`, `shadow_maps`, kGlassTexels, kSearchGrowth. docs/decisions/0069.
#ifndef SKERRY_THROUGH_GLASS_GLSL
#define SKERRY_THROUGH_GLASS_GLSL

// What a map knows of the light that comes to a place.
struct GlassAt {
  Cascade cascade;
  ivec4 area;   // texels of the map that show glass, from xy to before zw
  vec2 place;   // texels of the map
  float here;   // depth of the place
  float depth;  // of what stands in the light's way, at least
  vec2 slope;   // change of depth a texel in the plane of the place
};

// Optical depth on the way of the light that passes a texel, up to what is asked for.
vec3 glass_before(ivec2 texel, GlassAt at);

// As glass_before(); w: 1, or 0 if something opaque ends that way before the place.
vec4 known_at(vec2 place, GlassAt at) {
  ivec2 texel = clamp(ivec2(floor(place)), at.area.xy, at.area.zw - 1);
  ivec2 shadow_texel = ivec2((vec2(texel) + 0.5) / (kGlassTexels * frame.glass_per_texel));
  bool passes = texelFetch(shadow_maps, ivec3(shadow_texel, int(at.cascade.layer)), 0).r <= at.depth;
  return passes ? vec4(max(glass_before(texel, at), 0.0), 1.0) : vec4(0.0);
}

// Of the four texels about a place. Where the edges of two quads of a pane meet within a texel, one of them may miss it or both cover it, and that
// texel knows nothing: of four the mean of the middle two counts.
vec4 known_about(GlassAt at) {
  vec2 first = at.place - 0.5;
  vec4 a = known_at(first, at), b = known_at(first + vec2(1.0, 0.0), at);
  vec4 c = known_at(first + vec2(0.0, 1.0), at), d = known_at(first + vec2(1.0, 1.0), at);
  vec4 sum = a + b + c + d;
  vec3 middle = sum.rgb - min(min(a, b), min(c, d)).rgb - max(max(a, b), max(c, d)).rgb;
  return sum.w == 4.0 ? vec4(middle, 2.0) : sum;
}

// On the edge of a shadow light comes past what casts it: from further off than the texels about the place. @param radius [texels].
vec4 known_around(float radius, GlassAt at) {
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < 8u; ++i) {
    float angle = 0.78539816 * float(i);
    sum += known_at(at.place + radius * vec2(cos(angle), sin(angle)), at);
  }
  return sum;
}

// Change of depth in a plane, a texel. @param n its normal; 0: level, seen from the body.
vec2 slope_of(vec3 n, Cascade c, float texel) {
  vec3 x = c.map_from_world_x.xyz * c.texel_blocks, y = c.map_from_world_y.xyz * c.texel_blocks;
  float facing = dot(n, c.map_from_world_z.xyz / c.depth_per_block);
  return vec2(dot(n, x), dot(n, y)) * (-texel * c.depth_per_block * sign(facing) / max(abs(facing), 0.05));
}

// @param p of a surface that frame.glass_body lights. @param n its normal, as slope_of() takes it.
vec3 share_through_glass(vec3 p, vec3 n) {
  Body body = frame.bodies[frame.glass_body];
  float distance = length(p);
  uint index = 0u;
  for (uint i = 0u; i < body.cascade_count; ++i) index += uint(distance > frame.cascades[body.first_cascade + i].radius);
  GlassAt at;
  at.cascade = frame.cascades[body.first_cascade + min(index, max(body.cascade_count, 1u) - 1u)];
  vec4 place = vec4(p, 1.0);
  const float per_shadow_texel = kGlassTexels * frame.glass_per_texel;
  at.place = (vec2(dot(at.cascade.map_from_world_x, place), dot(at.cascade.map_from_world_y, place)) - 0.5) * per_shadow_texel;
  float texel = at.cascade.texel_blocks / per_shadow_texel;
  // Where a cascade fades into the next, light comes past by that one's texels.
  float next = frame.cascades[body.first_cascade + min(index + 1u, max(body.cascade_count, 1u) - 1u)].texel_blocks;
  float widest = max(max(frame.shadow_blur, 2.0 * next) / texel, 1.5);
  vec2 low = floor(vec2(at.cascade.glass_area.xy) * kGlassTexels), high = ceil(vec2(at.cascade.glass_area.zw) * kGlassTexels);
  at.area = ivec4(low, high);
  if (low.x >= high.x || any(lessThan(at.place, low - widest)) || any(greaterThan(at.place, high + widest))) return vec3(1.0);
  // A slope about the place may stand a little nearer to the light.
  at.here = dot(at.cascade.map_from_world_z, place);
  at.slope = slope_of(n, at.cascade, texel);
  at.depth = at.here + at.cascade.depth_per_block * (0.25 + 2.0 * texel);
  vec4 known = known_about(at);
  for (float radius = 1.5; known.w == 0.0 && radius < kSearchGrowth * widest; radius *= kSearchGrowth) known = known_around(min(radius, widest), at);
  // Where no way is known hardly any light comes.
  return known.w > 0.0 ? exp(-known.rgb / known.w) : vec3(0.0);
}
#endif
