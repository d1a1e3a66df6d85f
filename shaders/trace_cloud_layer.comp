#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Optical depth of the cloud layer towards a body, a column an invocation: from the top of the layer down along the light.
// docs/clouds.md.
#include "include/cloud_columns.glsl"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kCloudsBinding) uniform Clouds { CloudConstants clouds; };
layout(binding = kCloudWeatherBinding) uniform sampler2D cloud_weather;
layout(binding = kLayerLightBinding, r16f) writeonly uniform image3D layer_light;
layout(binding = kCloudShapesBinding) uniform sampler2DArray cloud_shapes;
layout(binding = kCloudBillowsBinding) uniform sampler2DArray cloud_billows;
layout(push_constant) uniform Push { uint body; } push;

#include "include/cloud_layer.glsl"

// A step that is longer than the clouds' details takes several samples.
const float kLongestStep = 48.0;  // blocks
const uint kMostParts = 8u;

void main() {
  uvec2 column = gl_GlobalInvocationID.xy;
  vec3 to_light = clouds.lights[push.body].to_light;
  vec2 slope = column_slope(to_light);
  vec2 middle = column_of_texel((vec2(column) + 0.5) / float(kLayerLightEdge));
  uint steps = uint(clouds.shadow_steps);
  float rise = clouds.layer.thickness / clouds.shadow_steps;
  float stretch = sqrt(1.0 + dot(slope, slope));
  uint parts = clamp(uint(rise * stretch / kLongestStep), 1u, kMostParts);
  float depth = 0.0;
  int first = int(push.body * (steps + 1u));
  imageStore(layer_light, ivec3(column, first + int(steps)), vec4(0.0));
  for (uint k = steps; k-- > 0u;) {
    for (uint part = parts; part-- > 0u;) {
      float height = rise * (float(k) + (float(part) + 0.5) / float(parts));
      vec2 at = middle + slope * (height - 0.5 * clouds.layer.thickness);
      vec3 p = vec3(at.x, height - clouds.layer.place.y, at.y);
      depth += layer_extinction(p, layer_cover(p, clouds.layer), clouds.layer) * rise * stretch / float(parts);
    }
    imageStore(layer_light, ivec3(column, first + int(k)), vec4(min(depth, 6.0e4)));
  }
}
