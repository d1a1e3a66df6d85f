#version 460
#extension GL_GOOGLE_include_directive : require
// Puts what bend_rays.comp found in place of the radiance of the pixels that show water or glass.
#include "include/frame/common.glsl"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths;
layout(binding = kBentLightBinding, rgba16f) readonly uniform image2D bent_light;
layout(binding = kRadianceBinding) writeonly uniform image2D radiance;

#include "include/scene/layers.glsl"
#include "include/scene/tiles.glsl"

void main() {
  uvec2 at;
  bool here = tile_pixel(at);
  ivec2 pixel = ivec2(at);
  if (here && layer_depth_at(layer_depths, pixel, frame.layers_area) > 0.0) imageStore(radiance, pixel, imageLoad(bent_light, pixel));
}
