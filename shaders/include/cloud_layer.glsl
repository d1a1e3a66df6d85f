// Density of the layer: noise that repeats, shaped by a profile of height. Twin, written on its own: tools/reference/clouds.cpp.
// Needs before the include: `cloud_noise` (sampler3D that repeats; bake_cloud_noise.comp).
#ifndef SKERRY_CLOUD_LAYER_GLSL
#define SKERRY_CLOUD_LAYER_GLSL
#include "shared/clouds.h"

const float kWeatherSwing = 0.5;  // of the coverage, over the land
const float kSparsest = 0.62, kFullest = 0.20;  // shapes above this are clouds: at no coverage, at full coverage
const float kEdge = 0.2;          // shapes by so much above are as dense as can be
const float kErosion = 0.7;       // what billows take from the edges

float rising(float low, float high, float x) { return clamp((x - low) / (high - low), 0.0, 1.0); }

// Extinction at a place [1/block]. @param p world.
float layer_extinction(vec3 p, CloudLayer layer) {
  float height = (p.y + layer.place.y) / layer.thickness;
  vec3 at = vec3(layer.place.x + p.x, height * layer.thickness, layer.place.z + p.z);
  float weather = textureLod(cloud_noise, vec3(at.x, 0.0, at.z) / kCloudWeatherPeriod, 0.0).a;
  float cover = clamp(layer.coverage + kWeatherSwing * (weather - 0.5), 0.0, 1.0);
  // Flat bases, round tops that reach the higher the more of the sky is covered.
  float profile = rising(0.0, 0.1, height) * (1.0 - rising(0.2 + 0.3 * cover, 0.6 + 0.4 * cover, height));
  float shape = textureLod(cloud_noise, at / kCloudShapePeriod, 0.0).r;
  float body = rising(kSparsest - (kSparsest - kFullest) * cover, kSparsest - (kSparsest - kFullest) * cover + kEdge, shape) - (1.0 - profile);
  if (body <= 0.0) return 0.0;
  vec2 billows = textureLod(cloud_noise, at / kCloudDetailPeriod, 0.0).gb;
  float detail = 1.0 - dot(billows, vec2(0.6, 0.4));
  float density = rising(kErosion * detail, 1.0, body);
  float fading = 1.0 - rising(kLayerFadeBegin, kLayerFadeEnd, length(p.xz));
  return layer.extinction * density * fading;
}
#endif
