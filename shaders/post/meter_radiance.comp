#version 460
#extension GL_GOOGLE_include_directive : require
// The meter. First the histogram of the luminance of scene radiance, black left out: one pixel of each cell of stride x stride, at a place in it
// that looks random and is always the same, from the image of radiance or from what shading kept; integer counts: no order of work groups shows.
// Then, in one work group with a thread a bin, an exposure from the histogram: mean of log2 luminance without the darkest and the brightest pixels;
// sums run in a fixed order.
// Last, if it is asked for, a debug view over the lower third of the picture: the histogram by log2 luminance from left to right. White bars
// count, grey ones are passed over. Blue lines: where the limits lie; yellow: what is metered; red: what the picture is exposed for.
// docs/exposure.md, docs/conventions.md.
#include "include/frame/common.glsl"
#include "include/post/meter.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = kMeterGroup, local_size_y = kMeterGroup) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kRadianceBinding, rgba16f) readonly uniform image2D radiance;
layout(binding = kMeteredBinding, r32f) readonly uniform image2D metered;  // their luminance
layout(scalar, binding = kHistogramBinding) buffer Histogram { uint counts[kHistogramBins]; };
layout(scalar, binding = kExposureBinding) buffer Chosen { Exposure exposure; };
layout(binding = kPictureBinding, rgba8) uniform image2D picture;  // of the debug view
layout(push_constant) uniform Push { Metering metering; } push;

layout(constant_id = kChooseConstant) const bool kChoose = false;
layout(constant_id = kShowConstant) const bool kShow = false;  // neither: the histogram is filled
layout(constant_id = kMeterStrideConstant) const uint kMeterStride = 0u;
const bool kFromCells = kMeterStride != 0u;  // if not, something is bound in place of what was metered

shared uint here[kHistogramBins];

void fill_histogram() {
  uint stride = push.metering.stride, thread = gl_LocalInvocationIndex;
  here[thread] = 0u;
  barrier();
  uvec2 cell = gl_GlobalInvocationID.xy;
  if (all(lessThan(cell * stride, frame.picture_size))) {
    uvec2 pixel = metered_pixel(cell, stride, frame.picture_size);
    float y = kFromCells ? imageLoad(metered, ivec2(cell)).r : exact_luminance(imageLoad(radiance, ivec2(pixel)).rgb);
    if (counts_as_light(y)) atomicAdd(here[bin_of(y)], 1u);
  }
  barrier();
  if (here[thread] != 0u) atomicAdd(counts[thread], here[thread]);
}

shared uint counted[kHistogramBins];
shared float summed[kHistogramBins];
shared uint first_bin, last_bin, most;

uint share_of(uint total, uint fraction) {
  uint high, low;
  umulExtended(total, fraction, high, low);
  return high;
}

void choose_exposure() {
  uint bin = gl_LocalInvocationIndex, count = counts[bin];
  counted[bin] = count;
  if (bin == 0u) {
    first_bin = kHistogramBins;
    last_bin = most = 0u;
  }
  for (uint step = 1u; step < kHistogramBins; step *= 2u) {
    barrier();
    uint before = bin >= step ? counted[bin - step] : 0u;
    barrier();
    counted[bin] += before;
  }
  barrier();
  uint total = counted[kHistogramBins - 1u], end = counted[bin];
  uint first = share_of(total, kPassedOverDark), last = total - share_of(total, kPassedOverBright);
  // Ranks of this bin's pixels that lie in [first, last).
  uint kept = max(min(end, last), first) - max(min(end - count, last), first);
  if (kept != 0u) {
    atomicMin(first_bin, bin);
    atomicMax(last_bin, bin);
  }
  atomicMax(most, count);
  summed[bin] = kept != 0u ? float(kept) * log2_of_bin(bin) : 0.0;
  for (uint step = kHistogramBins / 2u; step != 0u; step /= 2u) {
    barrier();
    if (bin < step) summed[bin] += summed[bin + step];
  }
  if (bin != 0u) return;
  exposure.metered = total;
  if (total == 0u) return;
  exposure.first_bin = first_bin;
  exposure.last_bin = last_bin;
  exposure.most = most;
  Metering m = push.metering;
  float seen = summed[0] / float(last - first);
  float ev = log2(kDayLuminance / m.key) + kFollowed * (seen - log2(kDayLuminance));
  exposure.metered_ev = max(min(ev, m.max_ev), m.min_ev);
  if (m.decides != 0u) exposure.ev = exposure.metered_ev;
}

// Column of the mean log2 luminance that is exposed at `ev`.
float column_of(float ev) {
  float seen = log2(kDayLuminance) + (ev - log2(kDayLuminance / push.metering.key)) / kFollowed;
  return (seen - float(kFirstOctave)) * float(kBinsPerOctave) / float(kHistogramBins) * float(frame.picture_size.x);
}

bool on_line(uint x, float ev) { return abs(float(x) + 0.5 - column_of(ev)) < 1.0; }

void show_histogram() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  uint height = (frame.picture_size.y + 2u) / 3u;
  if (pixel.x >= frame.picture_size.x || pixel.y >= height) return;
  ivec2 at = ivec2(pixel.x, frame.picture_size.y - 1u - pixel.y);
  vec3 colour = 0.4 * imageLoad(picture, at).rgb;
  uint bin = pixel.x * kHistogramBins / frame.picture_size.x;
  if (exposure.metered != 0u) {
    bool kept = bin >= exposure.first_bin && bin <= exposure.last_bin;
    if (counts[bin] != 0u && float(pixel.y) <= float(counts[bin]) / float(exposure.most) * float(height - 1u))
      colour = vec3(kept ? 0.9 : 0.45);
    if (on_line(pixel.x, exposure.metered_ev)) colour = vec3(1.0, 0.85, 0.0);
  }
  if (on_line(pixel.x, push.metering.min_ev) || on_line(pixel.x, push.metering.max_ev)) colour = vec3(0.2, 0.4, 1.0);
  if (on_line(pixel.x, exposure.ev) && (pixel.y & 4u) != 0u) colour = vec3(1.0, 0.2, 0.1);
  imageStore(picture, at, vec4(colour, 1.0));
}

void main() {
  if (kShow)
    show_histogram();
  else if (kChoose)
    choose_exposure();
  else
    fill_histogram();
}
