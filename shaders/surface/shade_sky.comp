#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Sky: the pixels that show it, by tiles, or all of them in a frame without geometry. In tiles without stars and discs it has no detail, and may be
// worked out at every fourth pixel of a row (docs/decisions/0030-light-at-fewer-pixels.md). docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/sky.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x_id = kGroupSizeConstant) in;  // of a tile: 64 / kRun

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kSkyBinding) uniform Sky { SkyConstants sky; };
layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kSkyTableBinding) uniform sampler2D sky_lut;

layout(constant_id = kStarsConstant) const bool kStars = true;  // false by day
layout(constant_id = kDiscsConstant) const bool kDiscs = true;  // false when neither sun nor moon is in the picture

// There is no geometry; then something is bound in place of surfaces and tiles.
layout(constant_id = kSkyAloneConstant) const bool kSkyAlone = false;

// Pixels of a row that an invocation takes: a divisor of a tile's edge.
layout(constant_id = kRunConstant) const uint kRun = 1u;

#include "include/scene/coverage.glsl"
#include "include/scene/tiles.glsl"
#include "include/post/output.glsl"
#include "include/sky/sky.glsl"
#include "include/sky/stars.glsl"

Shown sky_at(uvec2 pixel, bool here) { return shown(sky_seen(normalize(pixel_ray(pixel)), kStars, kDiscs), here); }

bool shows_sky(uvec2 pixel) {
  return kSkyAlone || !is_covered(imageLoad(surfaces, ivec2(pixel)).r, texelFetch(depths, ivec2(pixel), 0).r);
}

void main() {
  uvec2 first = gl_WorkGroupID.xy * kTileEdge;
  bool tile = kSkyAlone || listed_tile(first);
  const uint across = kTileEdge / kRun;  // invocations of a row
  first += uvec2(gl_LocalInvocationIndex % across * kRun, gl_LocalInvocationIndex / across);
  Shown here_shown = sky_at(first, tile), next = here_shown;
  if (kRun > 1u) next = sky_at(first + uvec2(kRun, 0u), tile);
  MeterRun run = meter_run(first);
  [[unroll]] for (uint i = 0u; i < kRun; ++i) {
    uvec2 pixel = first + uvec2(i, 0u);
    if (!in_one_cell(kRun)) run = meter_run(pixel);
    bool here = tile && all(lessThan(pixel, frame.size));
    pixel = min(pixel, frame.size - 1u);
    here = here && shows_sky(pixel);
    Shown what = here_shown;
    if (kRun > 1u) {
      float along = float(i) / float(kRun);
      what = Shown(as_halves(mix(here_shown.radiance, next.radiance, along)), mix(here_shown.encoded, next.encoded, along));
    }
    put_shown(pixel, what, here, run);
    if (!in_one_cell(kRun)) end_run(run);
  }
  if (in_one_cell(kRun)) end_run(run);
}
