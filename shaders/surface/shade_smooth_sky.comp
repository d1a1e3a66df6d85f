#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// As shade_sky.comp, of tiles that show a smooth sky and nothing else (classify_shaded_tiles.comp): worked out at the corners of squares of 4x4
// pixels. An invocation takes a tile. docs/decisions/0030-light-at-fewer-pixels.md.
#include "include/frame/common.glsl"
#include "shared/sky.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = kSmoothSkyGroup) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(binding = kSkyTableBinding) uniform sampler2D sky_lut;

#include "include/scene/tiles.glsl"
#include "include/post/output.glsl"
#include "include/sky/sky.glsl"

// Of a row of squares' corners.
struct Row {
  Shown left, middle, right;
};

Shown sky_at(uvec2 pixel, bool here) {
  return shown(sample_sky(sky_lut, normalize(pixel_ray(pixel)), frame.sky_horizon, frame.sky_yaw), here);
}
Row row_at(uvec2 first, bool here) {
  return Row(sky_at(first, here), sky_at(first + uvec2(kSquareEdge, 0u), here), sky_at(first + uvec2(2u * kSquareEdge, 0u), here));
}

Shown between(Shown a, Shown b, float along) { return Shown(mix(a.radiance, b.radiance, along), mix(a.encoded, b.encoded, along)); }

// A square by its corners.
void put_square(uvec2 first, Shown a, Shown b, Shown c, Shown d, bool here) {
  MeterRun run = meter_run(first);
  [[unroll]] for (uint y = 0u; y < kSquareEdge; ++y) {
    float down = float(y) / float(kSquareEdge);
    Shown left = between(a, c, down), right = between(b, d, down);
    [[unroll]] for (uint x = 0u; x < kSquareEdge; ++x) {
      uvec2 pixel = first + uvec2(x, y);
      if (!in_one_cell(kSquareEdge)) run = meter_run(pixel);
      Shown what = between(left, right, float(x) / float(kSquareEdge));
      put_shown(pixel, Shown(as_halves(what.radiance), what.encoded), here, run);
      if (!in_one_cell(kSquareEdge)) end_run(run);
    }
  }
  if (in_one_cell(kSquareEdge)) end_run(run);
}

void main() {
  uvec2 first;
  bool tile = tile_in((gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * kSmoothSkyGroup + gl_LocalInvocationIndex, first);
  Row above = row_at(first, tile);
  [[unroll]] for (uint y = 0u; y < kTileEdge; y += kSquareEdge) {
    Row below = row_at(first + uvec2(0u, y + kSquareEdge), tile);
    put_square(first + uvec2(0u, y), above.left, above.middle, below.left, below.middle, tile);
    put_square(first + uvec2(kSquareEdge, y), above.middle, above.right, below.middle, below.right, tile);
    above = below;
  }
}
