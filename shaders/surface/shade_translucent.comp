#version 460
#extension GL_GOOGLE_include_directive : require
// Looks through the peeled layers of water and glass from front to back: absorption along each stretch
// inside a medium, light scattered towards the eye, and at each surface Fresnel reflection. In place on the radiance image. docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/sky.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kSkyTableBinding) uniform sampler2D sky_lut;
layout(binding = kRadianceBinding, rgba16f) uniform image2D radiance;
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kLayerSurfacesBinding) uniform usampler2DArray layer_surfaces;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths_0;
layout(binding = kLayerDepthsBinding + 1u) uniform sampler2D layer_depths_1;
layout(binding = kLayerDepthsBinding + 2u) uniform sampler2D layer_depths_2;
layout(binding = kLayerDepthsBinding + 3u) uniform sampler2D layer_depths_3;

layout(constant_id = kWaterLayersConstant) const uint kWaterLayers = 3u;

#include "include/scene/layers.glsl"

float layer_depth(uint k, ivec2 pixel) {
  return k == 0u ? layer_depth_at(layer_depths_0, pixel, frame.layers_area)
                 : k == 1u ? layer_depth_at(layer_depths_1, pixel, frame.layers_area)
                           : k == 2u ? layer_depth_at(layer_depths_2, pixel, frame.layers_area) : layer_depth_at(layer_depths_3, pixel, frame.layers_area);
}
// 0 where the layer has no surface; its word is undefined there.
uint layer_surface(uint k, ivec2 pixel) {
  return layer_depth(k, pixel) > 0.0 ? texelFetch(layer_surfaces, ivec3(pixel, k), 0).r : 0u;
}
// What find_layer_light.comp has found for a layer, or behind them all for the medium before the eye.
uint share_of_layer(uint k, ivec2 pixel) { return texelFetch(layer_surfaces, ivec3(pixel, kWaterLayers + k), 0).r; }

layout(binding = kMirroredCloudsBinding) uniform sampler2D mirrored_clouds;
layout(constant_id = kMirroredCloudsConstant) const bool kMirroredClouds = false;  // whether they are known

layout(constant_id = kToPictureConstant) const bool kCounted = false;  // all pixels are in the picture and in the counts already
layout(binding = kTailDepthsBinding) uniform sampler2D tail_depths;
layout(binding = kTailLightBinding) uniform sampler2D tail_light;
layout(constant_id = kTailConstant) const bool kTail = false;  // they are known where the last layer has a surface

#include "include/scene/tiles.glsl"
#include "include/frame/pixel_stats.glsl"
#include "include/surface/surface.glsl"
#include "include/sky/sky.glsl"
#include "include/surface/lighting.glsl"
#include "include/light/clustered.glsl"
#include "include/light/traced.glsl"
#include "include/light/light_panes.glsl"
#include "include/light/indirect.glsl"
#include "include/surface/ripples.glsl"
#include "include/sky/mirrored_clouds.glsl"
#include "include/surface/packed_share.glsl"
#include "include/surface/water.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel);
  // A mixed tile is in both lists: each list does its own pixels.
  here = here && (layer_surface(0u, ivec2(pixel)) != 0u) == (push.kind == 0u);
  vec4 behind = imageLoad(radiance, ivec2(pixel));
  vec3 colour = look_through(pixel, pixel_ray(pixel), behind);
  count_non_finite(here && !finite3(colour));
  colour = as_halves(sanitised(colour));
  if (kCounted) count_black(here && colour == vec3(0.0), here && behind.rgb == vec3(0.0));
  if (here) imageStore(radiance, ivec2(pixel), vec4(colour, 1.0));
}
