#version 460
#extension GL_GOOGLE_include_directive : require
// Debug view: the meter's histogram over the lower third of the picture, by log2 luminance from left to right. White bars count, grey ones
// are passed over. Blue lines: where the limits lie; yellow: what is metered; red: what the picture is exposed for. docs/exposure.md,
// docs/conventions.md.
#include "include/common.glsl"
#include "include/meter.glsl"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kHistogramBinding) readonly buffer Histogram { uint counts[kHistogramBins]; };
layout(scalar, binding = kExposureBinding) uniform Chosen { Exposure exposure; };
layout(binding = kPictureBinding, rgba8) uniform image2D picture;
layout(push_constant) uniform Push { Metering metering; } push;

// Column of the mean log2 luminance that is exposed at `ev`.
float column_of(float ev) {
  float seen = log2(kDayLuminance) + (ev - log2(kDayLuminance / push.metering.key)) / kFollowed;
  return (seen - float(kFirstOctave)) * float(kBinsPerOctave) / float(kHistogramBins) * float(frame.picture_size.x);
}

bool on_line(uint x, float ev) { return abs(float(x) + 0.5 - column_of(ev)) < 1.0; }

void main() {
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
