// Where a shading pass puts its pixels: to the picture, to an image of scene radiance where something comes between it and the picture, or to both
// where a later pass may look at the radiance. Both give the same picture. Needs before the include: `frame`, `stats` (PixelStats).
#ifndef SKERRY_OUTPUT_GLSL
#define SKERRY_OUTPUT_GLSL
#include "shared/constants.h"
#include "include/frame/pixel_stats.glsl"
#include "include/post/picture.glsl"
#include "include/post/meter.glsl"

// If both, frame.radiance_area says whose radiance is kept. Where one is false, something is bound in place of its image; and in place of the exposure.
layout(constant_id = kToPictureConstant) const bool kToPicture = false;
layout(constant_id = kToRadianceConstant) const bool kToRadiance = true;
layout(constant_id = kMeterStrideConstant) const uint kMeterStride = 0u;  // 0: no luminance is kept

layout(binding = kRadianceBinding) writeonly uniform image2D radiance;
layout(binding = kMeteredBinding) writeonly uniform image2D metered;  // [cell of stride x stride pixels]

bool keeps_radiance(uvec2 pixel) {
  return kToRadiance && (!kToPicture || in_area(pixel, frame.radiance_area));
}

// What a pixel shows: radiance, finite, and how that is encoded for the picture.
struct Shown {
  vec3 radiance, encoded;
};

// Every invocation calls this once a colour; `here` says which of them count.
Shown shown(vec3 colour, bool here) {
  count_non_finite(here && !finite3(colour));
  colour = as_halves(sanitised(colour));
  return Shown(colour, kToPicture ? developed(colour, vec3(0.0)) : vec3(0.0));
}

// What an invocation keeps for the meter of pixels of a row that lie in one of its cells: lavapipe stores lane by lane, and takes as long where no lane
// stores as where all do.
struct MeterRun {
  uvec2 cell;
  uvec2 pixel;  // of the cell, that is metered
  float luminance;
  bool here;
};
MeterRun meter_run(uvec2 first) {
  uvec2 cell = first / max(kMeterStride, 1u);
  return MeterRun(cell, metered_pixel(cell, max(kMeterStride, 1u), frame.picture_size), 0.0, false);
}
void end_run(MeterRun run) {
  if (kMeterStride != 0u && run.here) imageStore(metered, ivec2(run.cell), vec4(run.luminance));
}
// Whether as many pixels from a tile's edge on, or from that many further on, lie in one cell.
bool in_one_cell(const uint pixels) { return kMeterStride % pixels == 0u; }

// Every invocation calls this once a pixel; `here` says which have one.
void put_shown(uvec2 pixel, Shown what, bool here, inout MeterRun run) {
  if (here && keeps_radiance(pixel)) imageStore(radiance, ivec2(pixel), vec4(what.radiance, 1.0));
  if (!kToPicture) return;
  count_black(here && what.radiance == vec3(0.0), false);
  if (here) put_developed(pixel, what.encoded);
  if (kMeterStride != 0u && here && run.pixel == pixel) {
    run.luminance = exact_luminance(what.radiance);
    run.here = true;
  }
}

// Every invocation calls this once a pixel; `here` says which have one. What is stored is finite.
void put_pixel(uvec2 pixel, vec3 colour, bool here) {
  MeterRun run = meter_run(pixel);
  put_shown(pixel, shown(colour, here), here, run);
  end_run(run);
}
#endif
