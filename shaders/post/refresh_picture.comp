#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance to the picture, in the tiles where something has changed it since shading made the picture. docs/decisions/0047-the-picture-as-it-is-shaded.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kRadianceBinding, rgba16f) readonly uniform image2D radiance;
layout(binding = kMeteredBinding) writeonly uniform image2D metered;  // [cell of stride x stride pixels]

layout(constant_id = kMeterStrideConstant) const uint kMeterStride = 0u;  // 0: something is bound in place of what is metered

#include "include/scene/tiles.glsl"
#include "include/post/picture.glsl"
#include "include/post/meter.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel) && in_area(pixel, frame.radiance_area);  // others of the tile have none
  vec3 colour = imageLoad(radiance, ivec2(pixel)).rgb;
  if (here) put_developed(pixel, developed(colour, vec3(0.0)));
  const uint stride = max(kMeterStride, 1u);
  uvec2 cell = pixel / stride;
  bool looked_at = kMeterStride != 0u && metered_pixel(cell, stride, frame.picture_size) == pixel;
  if (here && looked_at) imageStore(metered, ivec2(cell), vec4(exact_luminance(colour)));
}
