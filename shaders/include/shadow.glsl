// How much of a body's light reaches a point: cascaded shadow maps, 8 taps on a Poisson disc.
// Needs before the include: `frame` (FrameConstants) and `shadow_maps` (sampler2DArray of reverse depth, nearest filter).
#ifndef SKERRY_SHADOW_GLSL
#define SKERRY_SHADOW_GLSL

const vec2 kPoissonDisc[8] = vec2[](vec2(-0.326, -0.406), vec2(-0.840, -0.074), vec2(-0.203, 0.621), vec2(0.519, 0.767),
                                    vec2(0.962, -0.195), vec2(0.473, -0.480), vec2(0.185, -0.893), vec2(0.507, 0.064));

// Share of the filter's taps that see the light, 0..1.
// Each tap compares at a texel's centre with the depth that the receiver's own plane has there (receiver plane depth bias, Isidoro,
// GDC 2006), so a lit plane never shadows itself and the remaining bias only covers rounding: rasterised depths are exact to 1/256
// texel of the slope.
float cascade_visibility(Cascade cascade, vec3 p, vec3 normal, float n_dot_l) {
  // Half a texel off the surface: where two planes meet, the taps that fall behind the other plane would darken the corner.
  vec3 q = p + normal * (0.5 * cascade.texel_blocks);
  vec3 map = vec3(dot(cascade.map_from_world_x, vec4(q, 1.0)), dot(cascade.map_from_world_y, vec4(q, 1.0)),
                  dot(cascade.map_from_world_z, vec4(q, 1.0)));
  float texel = cascade.texel_blocks;
  float per_texel = -cascade.depth_per_block * texel * texel / max(n_dot_l, 0.02);
  vec2 slope = per_texel * vec2(dot(cascade.map_from_world_x.xyz, normal), dot(cascade.map_from_world_y.xyz, normal));
  float bias = cascade.depth_per_block * (0.004 + 0.02 * texel) + 0.016 * (abs(slope.x) + abs(slope.y));
  float radius = max(frame.pcf_radius_blocks / texel, 1.5);
  float lit = 0.0;
  for (int i = 0; i < 8; ++i) {
    ivec2 tap = ivec2(floor(map.xy + kPoissonDisc[i] * radius));
    float plane_depth = map.z + dot(slope, vec2(tap) + 0.5 - map.xy);
    float nearest = texelFetch(shadow_maps, ivec3(tap, int(cascade.layer)), 0).r;
    lit += plane_depth + bias >= nearest ? 0.125 : 0.0;
  }
  return lit;
}

// 0 in shadow, 1 in full light. Cascades are spheres around the camera; over the last fifth of its radius each fades into the next.
// Past the last cascade nothing is known, so nothing is lit.
float body_visibility(Body body, vec3 p, vec3 normal, float n_dot_l) {
  float distance = length(p);
  uint end = body.first_cascade + body.cascade_count;
  uint first = body.first_cascade;
  while (first < end && distance > frame.cascades[first].radius) ++first;
  // The last cascade has no successor to fade into.
  float to_next = first + 1u < end ? clamp((distance / frame.cascades[first].radius - 0.8) / 0.2, 0.0, 1.0) : 0.0;
  uint last = min(first + (to_next > 0.0 ? 2u : 1u), end);
  float visibility = 0.0;
  float weight = 1.0 - to_next;
  // A loop, not a branch: lavapipe skips an empty loop but runs both sides of a branch.
  for (uint c = first; c < last; ++c) {
    visibility += weight * cascade_visibility(frame.cascades[c], p, normal, n_dot_l);
    weight = to_next;
  }
  return visibility;
}
#endif
