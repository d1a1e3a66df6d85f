#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance to the picture, in the tiles where something has changed it since shading made the picture. docs/decisions/0047-the-picture-as-it-is-shaded.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kRadianceBinding, rgba16f) readonly uniform image2D radiance;

#include "include/scene/tiles.glsl"
#include "include/post/picture.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel) && in_area(pixel, frame.radiance_area);  // others of the tile have none  // others of the tile have none
  vec3 colour = imageLoad(radiance, ivec2(pixel)).rgb;
  if (here) put_developed(pixel, developed(colour, vec3(0.0)));
}
