#version 460
#extension GL_GOOGLE_include_directive : require
// Light of sun, moon and lamps at listed pixels (choose_samples.comp): to the samples of a grid's points or, in the second pass, to the radiance.
// docs/decisions/0030-light-at-fewer-pixels.md.
#include "include/frame/common.glsl"
#include "shared/sky.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kSkyTableBinding) uniform sampler2D sky_lut;
layout(binding = kSamplesBinding, rgba32ui) writeonly uniform uimage2D samples;  // of the first
layout(scalar, binding = kListedPixelsBinding) readonly buffer Pixels { TileDispatch listed[kSampleLists]; uint pixels[]; };  // see choose_samples.comp
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;
layout(binding = kMediaLightBinding) uniform usampler2D media_light;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths;  // of the first layer

layout(constant_id = kTextureTapsConstant) const uint kTextureTaps = 2u;

layout(constant_id = kEveryPixelConstant) const bool kEveryPixel = false;  // the second pass
layout(constant_id = kStepConstant) const uint kStep = 4u;  // pixels between the grid's points
layout(constant_id = kLitConstant) const bool kLit = false;  // listed pixels that ask lights; of the others, buffers are bound that are never read

#define SKERRY_ANY_ALBEDO
#include "include/post/output.glsl"
#include "include/surface/surface.glsl"
#include "include/sky/sky.glsl"
#include "include/surface/lighting.glsl"
#include "include/surface/depth_of_pixel.glsl"
#include "include/surface/haze.glsl"
#include "include/light/corners.glsl"
#include "include/light/indirect.glsl"
#include "include/light/clustered.glsl"
#include "include/light/traced.glsl"
#include "include/light/shafts.glsl"
#include "include/light/light_panes.glsl"
#include "include/light/blocked_lights.glsl"
#include "include/surface/light_samples.glsl"

// A black and a white surface that are else alike.
BrdfPair surface_brdf_pair(Surface s, vec3 to_eye) {
  BrdfPair pair;
  s.albedo = vec3(1.0);
  pair.white = surface_brdf(s, to_eye);
  s.albedo = vec3(0.0);
  pair.black = surface_brdf(s, to_eye);
  // Black metal would have no lobe at all; its grazing light is that of any metal.
  if (pair.white.mirror != vec3(0.0)) pair.black.mirror = max(pair.black.mirror, vec3(1e-6));
  return pair;
}

// Of one body: twin of reflected() in lighting.glsl.
mat2x3 body_sent(Surface s, Depth depth, BrdfPair b, vec3 to_eye, const uint index, const uint first_cascade) {
  BodyLight light = light_of_body(s, depth, index, first_cascade);
  float facing = max(light.n_dot_l, 0.0);
  vec3 arriving = light.irradiance * (frame.shading_flat != 0u ? 1.0 : light.n_dot_l);
  return mat2x3(arriving * brdf(b.black, s.normal, to_eye, light.to_light, facing),
                arriving * brdf(b.white, s.normal, to_eye, light.to_light, facing));
}

// @param around irradiance of the sky and of what stays on surfaces.
mat2x3 light_sent(Surface s, Depth depth, uint word, uvec2 pixel, float z, bool here, vec3 around) {
  vec3 to_eye = -normalize(s.position);
  BrdfPair b = surface_brdf_pair(s, to_eye);
  mat2x3 sent = mat2x3(0.0);
  if ((kBodies & 1u) != 0u) sent += body_sent(s, depth, b, to_eye, 0u, 0u);
  if ((kBodies & 2u) != 0u) sent += body_sent(s, depth, b, to_eye, 1u, kMoonCascade);
  if (kLit) {
    Cluster list = lights_at(pixel, z);
    if (!here) list.count = 0u;
    sent += lights_reflected(list, kNoShafts, b, way_start(s, word), to_eye);
  }
  sent *= s.ao;
  if (kIndirect != kIndirectOff) sent += mat2x3(around * brdf_around(b.black), around * brdf_around(b.white));
  return sent;
}

void main() {
  uint slot = (gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  bool here = slot < listed[kLit ? 1u : 0u].tiles;
  slot = here ? slot : 0u;
  uint packed = pixels[kLit ? uint(pixels.length()) - 1u - slot : slot];
  uvec2 pixel = uvec2(packed & 0xffffu, packed >> 16);
  float stored_depth = texelFetch(depths, ivec2(pixel), 0).r;
  uint word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, stored_depth);
  float depth = surface_depth(stored_depth), z = view_distance(depth, frame.near_plane);
  vec3 ray = pixel_ray(pixel);
  Surface s = surface_without_texture(word, ivec2(pixel), depth, ray);
  s.ao = surface_ao(s, word);
  Depth depth_in_water = depth_of_pixel(pixel, word, s.position);
  SkyLight sky = light_of_sky(s, word, sky_share(depth_in_water) * lit_again(depth_in_water));
  mat2x3 sent = light_sent(s, depth_in_water, word, pixel, z, here, sky.irradiance);
  // What emits in part has no samples that others take: of those any albedo does.
  vec3 albedo = kEveryPixel ? surface_texel(word, ray, z, kTextureTaps).rgb : vec3(1.0);
  sent[1] += emission_of(word, albedo);
  vec3 air = seen_through_air(vec3(0.0), s.position, sky.seen);
  sent = sent * clear_air(s.position) + mat2x3(air, air);
  if (!kEveryPixel) count_non_finite(here && !(finite3(sent[0]) && finite3(sent[1])));
  sent = mat2x3(sanitised(sent[0]), sanitised(sent[1]));
  if (kEveryPixel) {
    put_pixel(pixel, radiance_at(sent, albedo), here);
  } else {
    if (here) imageStore(samples, ivec2(pixel / kStep), packed_sample(sent, place_code(word, z)));
  }
}
