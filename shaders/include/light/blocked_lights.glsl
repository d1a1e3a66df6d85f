// Light of a pixel's lights, past the walls that stand before them. Needs before the include: frame_light(index), light_index(list, i), lights.glsl,
// traced.glsl, left_by_panes(light, position), kOracle; `list.count` lights are asked. Loops are left at their end: docs/lavapipe.md.
#ifndef SKERRY_BLOCKED_LIGHTS_GLSL
#define SKERRY_BLOCKED_LIGHTS_GLSL

// What is summed: radiance of a surface; or, of a surface of any albedo, that of a black one and of a white one (light_samples.glsl).
#ifdef SKERRY_ANY_ALBEDO
struct BrdfPair {
  Brdf black;
  Brdf white;
};
#define Reflectance BrdfPair
#define Reflected mat2x3
Reflected sent_to_eye(Light light, BrdfPair b, WayStart start, vec3 to_eye) {
  vec3 left = left_by_panes(light, start.position);
  return mat2x3(light_reflected(light, b.black, start.position, start.normal, to_eye) * left,
                light_reflected(light, b.white, start.position, start.normal, to_eye) * left);
}
// Of a surface of average albedo.
float strength_of(Reflected sent) { return luminance(mix(sent[0], sent[1], 0.3)); }
Reflected not_negative(Reflected sent) { return mat2x3(max(sent[0], vec3(0.0)), max(sent[1], vec3(0.0))); }
#else
#define Reflectance Brdf
#define Reflected vec3
Reflected sent_to_eye(Light light, Brdf b, WayStart start, vec3 to_eye) {
  return light_reflected(light, b, start.position, start.normal, to_eye) * left_by_panes(light, start.position);
}
float strength_of(Reflected sent) { return luminance(sent); }
Reflected not_negative(Reflected sent) { return max(sent, vec3(0.0)); }
#endif

// If no light has one, a buffer that is never read.
layout(scalar, binding = kLightReachBinding) readonly buffer Reaches { LightReach reaches[]; };

// Whether walls let a light arrive at a surface, as far as that is known: by voxels, so that it does not depend on the tile that lists the light.
bool arrives_at(Light light, WayStart start) {
  if (light.reach == 0u) return true;
  uint index = light.reach - 1u;
  if (start.island != reaches[index].island) return true;  // then it is out of range
  ivec3 size = reaches[index].size, brick = (start.voxel >> int(reaches[index].edge_log2)) - reaches[index].low;
  bool inside = all(lessThan(uvec3(brick), uvec3(size)));
  uint bit = inside ? uint(brick.z + size.z * (brick.x + size.x * brick.y)) : 0u;
  return inside && (reaches[index].bits[bit >> 5] >> (bit & 31u) & 1u) != 0u;
}

// Walls are looked for before the strongest lights alone. What arrives of them stands for the others: those are dimmed by the same share, so
// that a closed room stays dark.
Reflected strongest_blocked(Cluster list, Reflectance b, WayStart start, vec3 to_eye) {
  Strongest strongest = no_lights();
  Reflected others = Reflected(0.0);
  for (uint i = 0u; list.count > 0u;) {
    uint index = light_index(list, i);
    Light light = frame_light(index);
    Reflected part = sent_to_eye(light, b, start, to_eye);
    if (!arrives_at(light, start)) part = Reflected(0.0);
    others += part;
    add_strength(strongest, strength_of(part), index);
    if (++i == list.count) break;
  }
  Reflected arrived = Reflected(0.0);
  float asked = 0.0, through = 0.0;
  uint found = lights_found(strongest);  // not a branch within: lavapipe goes through rounds that the compiler can count
  for (uint k = 0u; found > 0u;) {
    Light light = frame_light(strongest.lights[k]);
    Reflected part = sent_to_eye(light, b, start, to_eye);
    float visibility = traced_visibility(start, light);
    others -= part;
    arrived += part * visibility;
    asked += strongest.strengths[k];
    through += strongest.strengths[k] * visibility;
    if (++k == found) break;
  }
  return arrived + not_negative(others) * (asked > 0.0 ? through / asked : 1.0);
}

Reflected light_unblocked(Light light, Reflectance b, WayStart start, vec3 to_eye) {
  return out_of_range(light, start.position) ? Reflected(0.0) : sent_to_eye(light, b, start, to_eye);
}
Reflected light_past_walls(Light light, Reflectance b, WayStart start, vec3 to_eye) {
  Reflected part = light_unblocked(light, b, start, to_eye);
  if (kLightsShadows != 0u && part != Reflected(0.0)) part *= traced_visibility(start, light);
  return part;
}

// Radiance that a surface sends to the eye. Nothing is marched for lights that do not light it.
Reflected lights_reflected(Cluster list, ShaftList shafts, Reflectance b, WayStart start, vec3 to_eye) {
  if (kLightsShadows != 0u && kLightsShadows != kEveryLight) return strongest_blocked(list, b, start, to_eye);
  Reflected sum = Reflected(0.0);
  // By words of 32: lavapipe ends loops after 65,535 rounds.
  for (uint word = 0u; list.count > 0u;) {
    uint first = word * 32u, left = asked_of(shafts, word, list.count), open = open_of(shafts, word);
    // In the lights' order, but those with open ways in a loop of their own: where lavapipe comes by code that traces, nobody needs it.
    while (left != 0u) {
      for (; kShafts && (left & (~left + 1u) & open) != 0u; left &= left - 1u)
        sum += light_unblocked(frame_light(light_index(list, first + uint(findLSB(left)))), b, start, to_eye);
      if (left == 0u) break;
      sum += light_past_walls(frame_light(light_index(list, first + uint(findLSB(left)))), b, start, to_eye);
      left &= left - 1u;
      if (left == 0u) break;
    }
    if (++word * 32u >= list.count) break;
  }
  return sum;
}
#endif
