#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Optical depth of clouds towards a body or the zenith. Of the layer: a column an invocation, from the top of the layer down along the light. Of a file's grid:
// a texel an invocation, along the light to where its way leaves the box. docs/clouds.md.
#include "include/sky/cloud_boxes.glsl"
#include "include/sky/cloud_columns.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kCloudWeatherBinding) uniform sampler2D cloud_weather;
layout(binding = kCloudShapesBinding) uniform sampler2DArray cloud_shapes;
layout(binding = kCloudBillowsBinding) uniform sampler2DArray cloud_billows;
layout(binding = kCloudCellsBinding) uniform sampler3D cloud_cells;
layout(binding = kCloudBricksBinding) uniform sampler3D cloud_bricks;
layout(binding = kTargetBinding, r16f) writeonly uniform image3D traced;
layout(push_constant) uniform Push { CloudLightJob job; } push;

layout(constant_id = kCloudLayerConstant) const bool kLayer = false;  // else of a file's grid

#include "include/sky/cloud_layer.glsl"
#include "include/sky/cloud_volumes.glsl"

// A step that is longer than the clouds' details takes several samples.
const float kLongestStep = 48.0;  // blocks
const uint kMostParts = 8u;

void trace_layer() {
  uvec2 column = gl_GlobalInvocationID.xy;
  vec3 to_light = clouds.lights[push.job.light].to_light;
  vec2 slope = column_slope(to_light);
  vec2 middle = column_of_texel((vec2(column) + 0.5) / float(kLayerLightEdge));
  uint steps = uint(clouds.shadow_steps);
  float rise = clouds.layer.thickness / clouds.shadow_steps;
  float stretch = sqrt(1.0 + dot(slope, slope));
  uint parts = clamp(uint(rise * stretch / kLongestStep), 1u, kMostParts);
  float depth = 0.0;
  int first = int(push.job.light * (steps + 1u));
  imageStore(traced, ivec3(column, first + int(steps)), vec4(0.0));
  for (uint k = steps; k-- > 0u;) {
    for (uint part = parts; part-- > 0u;) {
      float height = rise * (float(k) + (float(part) + 0.5) / float(parts));
      vec2 at = middle + slope * (height - 0.5 * clouds.layer.thickness);
      vec3 p = vec3(at.x, height - clouds.layer.place.y, at.y);
      depth += layer_extinction(p, layer_cover(p, clouds.layer), clouds.layer) * rise * stretch / float(parts);
    }
    imageStore(traced, ivec3(column, first + int(k)), vec4(min(depth, 6.0e4)));
  }
}

void trace_volume() {
  uint v = push.job.volume, light = push.job.light;
  vec3 size = clouds.volumes[v].light_texels;
  vec3 texel = vec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel, size))) return;
  vec3 at = mix(clouds.volumes[v].low, clouds.volumes[v].high, (texel + 0.5) / size);
  vec3 along = index_from_world_vector(v, clouds.lights[light].to_light);
  float way = max(box_range(v, at, along).y, 0.0);  // blocks: `along` is of one block
  float step_blocks = way / clouds.shadow_steps, sum = 0.0;
  for (float i = 0.5; i < clouds.shadow_steps; ++i) sum += volume_value(v, at + along * (i * step_blocks));
  float depth = min(sum * step_blocks * clouds.volumes[v].extinction, 6.0e4);
  imageStore(traced, ivec3(texel + vec3(0.0, 0.0, clouds.volumes[v].light_first[light])), vec4(depth));
}

void main() {
  if (kLayer)
    trace_layer();
  else
    trace_volume();
}
