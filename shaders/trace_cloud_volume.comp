#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Optical depth of a file's grid towards a body: a texel an invocation, along the light to where its way leaves the box. docs/clouds.md.
#include "include/cloud_boxes.glsl"
#include "shared/bindings.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

layout(binding = kCloudCellsBinding) uniform sampler3D cloud_cells;
layout(binding = kCloudBricksBinding) uniform sampler3D cloud_bricks;
layout(binding = kVolumeLightBinding, r16f) writeonly uniform image3D lit;
layout(push_constant) uniform Push { CloudLightJob job; } push;

#include "include/cloud_volumes.glsl"

void main() {
  uint v = push.job.volume, body = push.job.body;
  vec3 size = clouds.volumes[v].light_texels;
  vec3 texel = vec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel, size))) return;
  vec3 at = mix(clouds.volumes[v].low, clouds.volumes[v].high, (texel + 0.5) / size);
  vec3 along = index_from_world_vector(v, clouds.lights[body].to_light);
  float way = max(box_range(v, at, along).y, 0.0);  // blocks: `along` is of one block
  float step_blocks = way / clouds.shadow_steps, sum = 0.0;
  for (float i = 0.5; i < clouds.shadow_steps; ++i) sum += volume_value(v, at + along * (i * step_blocks));
  float depth = min(sum * step_blocks * clouds.volumes[v].extinction, 6.0e4);
  imageStore(lit, ivec3(texel + vec3(0.0, 0.0, clouds.volumes[v].light_first[body])), vec4(depth));
}
