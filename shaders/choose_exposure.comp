#version 460
#extension GL_GOOGLE_include_directive : require
// From the histogram to an exposure: mean of log2 luminance without the darkest and the brightest pixels. One work group, a thread a bin;
// sums run in a fixed order. docs/exposure.md, docs/conventions.md.
#extension GL_EXT_scalar_block_layout : require
#include "include/meter.glsl"
#include "shared/bindings.h"

layout(local_size_x = kHistogramBins) in;

layout(scalar, binding = kHistogramBinding) readonly buffer Histogram { uint counts[kHistogramBins]; };
layout(scalar, binding = kExposureBinding) buffer Chosen { Exposure exposure; };
layout(push_constant) uniform Push { Metering metering; } push;

shared uint counted[kHistogramBins];
shared float summed[kHistogramBins];
shared uint first_bin, last_bin, most;

uint share_of(uint total, uint fraction) {
  uint high, low;
  umulExtended(total, fraction, high, low);
  return high;
}

void main() {
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
