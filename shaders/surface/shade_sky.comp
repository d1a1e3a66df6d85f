#version 460
#extension GL_GOOGLE_include_directive : require
// Sky: the pixels that show it, by tiles, or all of them in a frame without geometry. docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/sky.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

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

#include "include/scene/coverage.glsl"
#include "include/scene/tiles.glsl"
#include "include/post/output.glsl"
#include "include/sky/sky.glsl"
#include "include/sky/stars.glsl"

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  bool here = all(lessThan(pixel, frame.size));
  if (!kSkyAlone) {
    here = tile_pixel(pixel);
    here = here && !is_covered(imageLoad(surfaces, ivec2(pixel)).r, texelFetch(depths, ivec2(pixel), 0).r);
  }
  put_pixel(pixel, sky_seen(normalize(pixel_ray(pixel)), kStars, kDiscs), here);
}
