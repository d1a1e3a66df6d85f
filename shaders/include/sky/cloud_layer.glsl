// Density of the layer: noise that repeats, shaped by a profile of height. Twin, written on its own: tools/reference/clouds.cpp.
// Needs before the include: `cloud_weather` (sampler2D), `cloud_shapes` and `cloud_billows` (sampler2DArray), which repeat; bake_cloud_noise.comp.
#ifndef SKERRY_CLOUD_LAYER_GLSL
#define SKERRY_CLOUD_LAYER_GLSL
#include "shared/clouds.h"

const float kWeatherSwing = 0.5;  // of the coverage, over the land
const float kSparsest = 0.62, kFullest = 0.20;  // shapes above this are clouds: at no coverage, at full coverage
const float kEdge = 0.2;          // shapes by so much above are as dense as can be
const float kErosion = 0.7;       // what billows take from the edges

float rising(float low, float high, float x) { return clamp((x - low) / (high - low), 0.0, 1.0); }

// A value of the noise, between eight texels: four of each of the slices above and below, which are in one layer.
float noise_at(sampler2DArray layers, vec3 at, float period) {
  const float edge = float(kCloudNoiseEdge), slices = float(kSlicesPerLayer);
  float slice = mod(at.y * (edge / period) - 0.5, edge);
  float layer = floor(slice / slices);
  vec4 texel = textureLod(layers, vec3(at.xz / period, layer), 0.0);
  return dot(texel, max(1.0 - abs(slice - layer * slices - vec4(0.0, 1.0, 2.0, 3.0)), 0.0));
}

vec3 place_in_layer(vec3 p, CloudLayer layer) { return p + layer.place; }

// Share of the sky that is covered about a place. It changes so slowly that a step has one.
float layer_cover(vec3 p, CloudLayer layer) {
  float weather = textureLod(cloud_weather, place_in_layer(p, layer).xz / kCloudWeatherPeriod, 0.0).r;
  return clamp(layer.coverage + kWeatherSwing * (weather - 0.5), 0.0, 1.0);
}

// Extinction at a place [1/block]. @param p world.
float layer_extinction(vec3 p, float cover, CloudLayer layer) {
  vec3 at = place_in_layer(p, layer);
  float height = at.y / layer.thickness;
  // Flat bases, round tops that reach the higher the more of the sky is covered.
  float profile = rising(0.0, 0.1, height) * (1.0 - rising(0.2 + 0.3 * cover, 0.6 + 0.4 * cover, height));
  float least = kSparsest - (kSparsest - kFullest) * cover;
  float body = rising(least, least + kEdge, noise_at(cloud_shapes, at, kCloudShapePeriod)) - (1.0 - profile);
  if (body <= 0.0) return 0.0;
  float detail = 1.0 - noise_at(cloud_billows, at, kCloudDetailPeriod);
  float density = rising(kErosion * detail, 1.0, body);
  float fading = 1.0 - rising(kLayerFadeBegin, kLayerFadeEnd, length(p.xz));
  return layer.extinction * density * fading;
}
#endif
