#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
// Lists the points of a grid that show a surface, whose light is worked out first (shade_samples.comp). A list's order follows threads.
// docs/decisions/0030-light-at-fewer-pixels.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/clusters.h"
#include "shared/constants.h"

layout(local_size_x = kChooseGroup) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kSamplesBinding, rgba32ui) writeonly uniform uimage2D samples;  // at the grid's points
// Of pixels that ask no light, and of those that ask some: the former from the beginning, the latter from the end.
layout(scalar, binding = kListedPixelsBinding) buffer Pixels { TileDispatch listed[kSampleLists]; uint pixels[]; };
layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kClustersBinding) readonly buffer Clusters { Cluster clusters[]; };

#include "include/surface/list_pixels.glsl"

void main() {
  uvec2 at = gl_GlobalInvocationID.xy, pixel = min(at * kStep, frame.size - 1u);
  bool here = all(lessThan(at, grid_size()));
  uint word;
  float stored_depth;
  bool surface = surface_at(pixel, word, stored_depth) && here;
  if (here && !surface) imageStore(samples, ivec2(at), uvec4(0u));
  bool lit = surface && asks_lights(pixel, stored_depth);
  Slots slots = first_slots(surface && !lit ? 1u : 0u, surface && lit ? 1u : 0u);
  if (surface) list_pixel(slots, lit, pixel);
}
