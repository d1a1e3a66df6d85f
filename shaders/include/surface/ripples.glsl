// How surfaces of water and glass face the light. Needs before the include: common.glsl, `frame`, `island_at()`, `materials`.
#ifndef SKERRY_RIPPLES_GLSL
#define SKERRY_RIPPLES_GLSL

// What is left of the small things of a surface at a distance [blocks]: far ones are smaller than a pixel.
float fading(float distance) { return exp(-distance * 0.02); }

// Small waves on a level water surface: slopes of four sine waves in the lattice; their periods divide an hour, after which time_s repeats.
vec3 rippled_normal(vec3 lattice, float distance) {
  const vec4 waves[4] = vec4[](vec4(0.83, 0.31, 80.0, 0.022), vec4(-0.47, 1.13, 120.0, 0.018), vec4(1.91, -1.27, 150.0, 0.011),
                               vec4(-2.3, -2.9, 200.0, 0.007));
  vec2 slope = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    float phase = dot(waves[i].xy, lattice.xz) + frame.time_s * 6.28318530718 * floor(30.0 * length(waves[i].xy)) / 100.0;
    slope += waves[i].xy / length(waves[i].xy) * (waves[i].w * cos(phase));
  }
  slope *= fading(distance);
  return normalize(vec3(-slope.x, 1.0, -slope.y));
}

// How a surface of water or glass mirrors lights.
struct Gloss {
  float alpha;  // of its lobe
  float waves;  // share of the lobe that is that of waves which have faded
};
// Of all waves: alpha^2 of a lobe whose slopes have their mean square, sqrt(pi) times half the sum of these slopes' squares.
const float kRippleAlpha2 = 8.67e-4;

// Water that lies level in its lattice.
bool has_ripples(uint word) { return (surface_face(word) >> 1) == 1u && materials[surface_block(word)].liquid != 0u; }

// @param t of the surface along `ray`.
vec3 shading_normal(uint word, vec3 ray, float t) {
  uint face = surface_face(word);
  IslandTransform island = island_at(surface_island(word));
  if (!has_ripples(word)) return world_from_lattice_vector(island, face_normal(face));
  vec3 rippled = rippled_normal(lattice_from_world(island, ray * t), t * length(ray));
  return world_from_lattice_vector(island, rippled) * (face == 2u ? 1.0 : -1.0);
}

Gloss gloss_of(uint word, vec3 ray, float t) {
  float roughness = max(materials[surface_block(word)].roughness, 0.06), left = has_ripples(word) ? fading(t * length(ray)) : 1.0;
  float drawn = pow(roughness, 4.0), faded = kRippleAlpha2 * (1.0 - left * left);
  return Gloss(sqrt(drawn + faded), faded / (drawn + faded));
}
#endif
