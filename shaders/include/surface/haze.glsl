// Haze between eye and surface. Needs before the include: what lighting.glsl has, sky.glsl, `sky_lut`.
#ifndef SKERRY_HAZE_GLSL
#define SKERRY_HAZE_GLSL

// What the air between eye and surface does to a surface's radiance: it takes a part away and sends light of its own, the colour of the sky behind,
// as far as sun or moon reach it at three places along the way, and past clouds at one. No haze where they do not: a cave stays black.
// @param sky share of its sky that the surface sees: as much of the air that the body does not light is lit by the sky.
vec3 seen_through_air(vec3 radiance, vec3 p, float sky) {
  if ((kBodies == 0u && kIndirect == kIndirectOff) || !kHaze) return radiance;
  // The sun's cascades, or the moon's when it is alone: the first either way.
  float lit = kBodies == 0u ? 0.0 : light_in_air(0u, p) * light_through_clouds((kBodies & 1u) != 0u ? 0u : 1u, p * 0.5);
  if (kIndirect != kIndirectOff) lit = mix(sky, 1.0, lit * frame.body_in_air);
  float clear = clear_air(p);
  return radiance * clear + sample_sky(sky_lut, p / length(p), frame.sky_horizon, frame.sky_yaw) * (lit * (1.0 - clear));
}
#endif
