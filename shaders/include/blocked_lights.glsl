// Light of a pixel's lights, past the walls that stand before them. Needs before the include: `lights[]`, light_index(list, i), lights.glsl,
// traced.glsl, kOracle; `list.count` lights are asked.
#ifndef SKERRY_BLOCKED_LIGHTS_GLSL
#define SKERRY_BLOCKED_LIGHTS_GLSL

// Walls are looked for before the strongest lights alone. What arrives of them stands for the others: those are dimmed by the same share, so
// that a closed room stays dark.
vec3 strongest_blocked(Cluster list, Brdf b, WayStart start, vec3 to_eye) {
  Strongest strongest = no_lights();
  vec3 others = vec3(0.0);
  for (uint i = 0u; i < list.count; ++i) {
    uint light = light_index(list, i);
    vec3 part = light_reflected(lights[light], b, start.position, start.normal, to_eye);
    others += part;
    add_strength(strongest, luminance(part), light);
  }
  vec3 arrived = vec3(0.0);
  float asked = 0.0, through = 0.0;
  for (uint k = 0u; k < min(kTracedLights, kMostTraced); ++k) {
    if (strongest.strengths[k] <= 0.0) continue;
    Light light = lights[strongest.lights[k]];
    vec3 part = light_reflected(light, b, start.position, start.normal, to_eye);
    float visibility = traced_visibility(start, light);
    others -= part;
    arrived += part * visibility;
    asked += strongest.strengths[k];
    through += strongest.strengths[k] * visibility;
  }
  return arrived + max(others, vec3(0.0)) * (asked > 0.0 ? through / asked : 1.0);
}

vec3 light_past_walls(Light light, Brdf b, WayStart start, vec3 to_eye) {
  if (out_of_range(light, start.position)) return vec3(0.0);
  vec3 part = light_reflected(light, b, start.position, start.normal, to_eye);
  if (kTracedLights != 0u && part != vec3(0.0)) part *= traced_visibility(start, light);
  return part;
}

// Radiance that a surface sends to the eye. Nothing is marched for lights that do not light it.
vec3 lights_reflected(Cluster list, Brdf b, WayStart start, vec3 to_eye) {
  if (kTracedLights != 0u && kTracedLights != kEveryLight) return strongest_blocked(list, b, start, to_eye);
  vec3 sum = vec3(0.0);
  // Two a round for the oracle: lavapipe ends loops after 65,535 rounds.
  for (uint i = 0u; i < list.count; ++i) {
    sum += light_past_walls(lights[light_index(list, i)], b, start, to_eye);
    if (kOracle && ++i < list.count) sum += light_past_walls(lights[light_index(list, i)], b, start, to_eye);
  }
  return sum;
}
#endif
