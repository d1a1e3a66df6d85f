// The frame's clouds, and boxes of files' grids in their own index space.
#ifndef SKERRY_CLOUD_BOXES_GLSL
#define SKERRY_CLOUD_BOXES_GLSL
#include "shared/bindings.h"
#include "shared/clouds.h"

layout(scalar, binding = kCloudsBinding) uniform Clouds { CloudConstants clouds; };

vec3 index_from_world(const uint v, vec3 p) {
  vec4 q = vec4(p, 1.0);
  return vec3(dot(clouds.volumes[v].index_x, q), dot(clouds.volumes[v].index_y, q), dot(clouds.volumes[v].index_z, q));
}
vec3 index_from_world_vector(const uint v, vec3 d) {
  return vec3(dot(clouds.volumes[v].index_x.xyz, d), dot(clouds.volumes[v].index_y.xyz, d), dot(clouds.volumes[v].index_z.xyz, d));
}

// Where a line in a volume's index space is inside its box: from x to y; x > y: nowhere.
vec2 box_range(const uint v, vec3 origin, vec3 along) {
  vec3 safe = mix(along, vec3(1e-20), lessThan(abs(along), vec3(1e-20)));
  vec3 a = (clouds.volumes[v].low - origin) / safe, b = (clouds.volumes[v].high - origin) / safe;
  vec3 low = min(a, b), high = max(a, b);
  return vec2(max(max(low.x, low.y), low.z), min(min(high.x, high.y), high.z));
}
#endif
