// What every light needs: how a surface reflects, and what clear air leaves of it. Needs before the include: `frame`.
#ifndef SKERRY_REFLECTION_GLSL
#define SKERRY_REFLECTION_GLSL
#include "shared/constants.h"
#include "shared/indirect.h"
#include "include/light/brdf.glsl"

layout(constant_id = kHazeConstant) const bool kHaze = true;
// Which bodies give light: bit 0 the sun, bit 1 the moon. A constant, so that the other body costs nothing.
layout(constant_id = kBodiesConstant) const uint kBodies = 3u;

// How a surface reflects. Literally flat shading has matt surfaces only.
Brdf surface_brdf(Surface s, vec3 to_eye) {
  Brdf b = brdf_of(s.albedo, s.roughness, s.metalness, dot(s.normal, to_eye));
  if (s.plant || frame.shading_flat != 0u) b = matt_brdf(s.albedo);
  return b;
}

// What lights surfaces besides bodies and lights; the sky then lights the air, too.
layout(constant_id = kIndirectConstant) const uint kIndirect = kIndirectOff;

// What clear air leaves of a radiance from p.
float clear_air(vec3 p) { return (kBodies == 0u && kIndirect == kIndirectOff) || !kHaze ? 1.0 : exp(-frame.haze_per_block * length(p)); }
#endif
