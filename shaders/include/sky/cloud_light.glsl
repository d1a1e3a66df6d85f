// How much of the light from one side clouds let through to a place: optical depths that trace_cloud_light.comp has
// filled in. Model: docs/clouds.md.
#ifndef SKERRY_CLOUD_LIGHT_GLSL
#define SKERRY_CLOUD_LIGHT_GLSL
#include "shared/constants.h"
#include "include/sky/cloud_boxes.glsl"
#include "include/sky/cloud_columns.glsl"

layout(binding = kLayerLightBinding) uniform sampler3D layer_light;
layout(binding = kVolumeLightBinding) uniform sampler3D volume_light;

layout(constant_id = kCloudLayerConstant) const bool kCloudLayer = false;
layout(constant_id = kCloudVolumesConstant) const uint kCloudVolumes = 0u;

// Of an image's part, in which values are looked up so far from its ends: what lies beyond takes no part in a blend, for it may be anything.
const float kRim = 0.51;  // texels

// A point above the layer reads its top, where nothing is left to pass; one below reads its base, on the same column.
float layer_depth(const uint light, vec3 p) {
  float slices = clouds.shadow_steps + 1.0;
  float height = clamp((p.y + clouds.layer.place.y) / clouds.layer.thickness, 0.0, 1.0);
  float slice = clamp(height * clouds.shadow_steps + 0.5, kRim, slices - kRim) + float(light) * slices;
  vec2 at = column_texel(column_through(p, clouds.lights[light].to_light, clouds.layer));
  return textureLod(layer_light, vec3(at, slice / (slices * float(kCloudLights))), 0.0).r;
}

// What lies on the way to the light: all of the volume's, from where the way enters its box.
float volume_depth(const uint v, const uint light, vec3 p) {
  vec3 at = index_from_world(v, p), to_light = index_from_world_vector(v, clouds.lights[light].to_light);
  vec2 range = box_range(v, at, to_light);
  bool met = range.y > max(range.x, 0.0);
  // Where nothing is met, something is looked up even so: lavapipe takes all lanes along, and not every number is a place.
  at = met ? at + to_light * clamp(range.x, 0.0, 1e9) : clouds.volumes[v].low;
  vec3 size = clouds.volumes[v].light_texels;
  vec3 texel = (at - clouds.volumes[v].low) / (clouds.volumes[v].high - clouds.volumes[v].low) * size;
  texel = clamp(texel, vec3(kRim), size - kRim) + vec3(0.0, 0.0, clouds.volumes[v].light_first[light]);
  float depth = textureLod(volume_light, texel / vec3(textureSize(volume_light, 0)), 0.0).r;
  return met ? depth : 0.0;
}

// Optical depth of all clouds from a place on, towards a body or the zenith. @param p world.
float cloud_depth(const uint light, vec3 p) {
  float depth = 0.0;
  if (kCloudLayer) depth += layer_depth(light, p);
  for (uint v = 0u; v < kCloudVolumes; ++v) depth += volume_depth(v, light, p);
  return depth;
}
float light_through_clouds(const uint body, vec3 p) { return exp(-cloud_depth(body, p)); }
#endif
