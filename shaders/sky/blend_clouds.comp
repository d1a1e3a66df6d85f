#version 460
#extension GL_GOOGLE_include_directive : require
// Clouds before what is shaded. March: along the rays of every second pixel each way, to the coarse image. Else blend, in place: from the coarse
// image where a neighbour in it saw as far as the pixel does; along edges the pixel's own ray is marched. docs/clouds.md, docs/conventions.md.
#include "include/sky/cloud_view.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(binding = kRadianceBinding, rgba16f) uniform image2D radiance;
layout(binding = kCoarseCloudsBinding) uniform sampler2D coarse;
layout(binding = kMarchedCloudsBinding, rgba16f) writeonly uniform image2D marched;

layout(constant_id = kMarchConstant) const bool kMarch = false;
layout(constant_id = kCoarseConstant) const bool kCoarse = false;  // there is a coarse image

// Adds one neighbour. @return its share if it saw what the pixel sees.
float take(uvec2 texel, float share, vec2 way, inout vec4 sum) {
  vec4 seen = texelFetch(coarse, ivec2(texel), 0);
  vec2 its_way = open_way(min(texel * 2u, frame.size - 1u));
  bool alike = abs(its_way.y - way.y) <= 0.08 * min(its_way.y, way.y);
  // Nothing within a longer way: nothing within the pixel's.
  bool nothing = seen == vec4(0.0, 0.0, 0.0, 1.0) && its_way.y >= way.y;
  float taken = alike || nothing ? share : 0.0;
  sum += seen * taken;
  return taken;
}

void march() {
  uvec2 size = (frame.size + 1u) / 2u;
  uvec2 texel = gl_GlobalInvocationID.xy;
  bool here = all(lessThan(texel, size));
  uvec2 pixel = min(texel * 2u, frame.size - 1u);
  vec2 way = open_way(pixel);
  if (!here) way = vec2(0.0);
  Clouded seen = clouds_seen(pixel, way, gradient_jitter(texel));
  if (here) imageStore(marched, ivec2(texel), vec4(min(seen.light, vec3(kMaxRadiance)), seen.clear));
}

void blend() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  bool here = all(lessThan(pixel, frame.size));
  pixel = min(pixel, frame.size - 1u);
  vec2 way = open_way(pixel);
  here = here && way.y > way.x;
  vec4 known = vec4(0.0);
  float shares = 0.0;
  if (kCoarse) {
    uvec2 last = (frame.size + 1u) / 2u - 1u, low = pixel / 2u, high = min(low + 1u, last);
    vec2 side = 0.5 * vec2(pixel % 2u);
    shares += take(low, (1.0 - side.x) * (1.0 - side.y), way, known);
    shares += take(uvec2(high.x, low.y), side.x * (1.0 - side.y), way, known);
    shares += take(uvec2(low.x, high.y), (1.0 - side.x) * side.y, way, known);
    shares += take(high, side.x * side.y, way, known);
    known /= max(shares, 1e-6);
  }
  Clouded seen = clouds_seen(pixel, here && shares == 0.0 ? way : vec2(0.0), gradient_jitter(pixel));
  if (shares > 0.0) seen = Clouded(known.rgb, known.a);
  vec3 colour = imageLoad(radiance, ivec2(pixel)).rgb * seen.clear + seen.light;
  if (here && !finite3(colour)) atomicAdd(stats.non_finite, 1u);
  if (here) imageStore(radiance, ivec2(pixel), vec4(as_halves(sanitised(colour)), 1.0));
}

void main() {
  if (kMarch)
    march();
  else
    blend();
}
