// What stained glass leaves of a light on its way to a surface. Needs before the include: light_texels.glsl, `grid`, `materials`, `island_at()`.
#ifndef SKERRY_LIGHT_PANES_GLSL
#define SKERRY_LIGHT_PANES_GLSL
#include "include/light/light_kinds.glsl"

// Beer's law over the straight way to the light's middle, whatever the light's size.
vec3 left_by_panes(Light light, vec3 position) {
  if ((kLightKinds & kLightPanesBit) == 0u) return vec3(1.0);
  vec3 depth = vec3(0.0);
  for (uint i = 0u; i < light.pane_count; ++i) {
    LightPane pane = light_pane(grid.light_count, light.first_pane + i);
    IslandTransform t = island_at(pane.island);
    vec3 from = lattice_from_world(t, position), way = lattice_from_world(t, light.position) - from;
    vec3 per_way = 1.0 / mix(way, vec3(1e-12), lessThan(abs(way), vec3(1e-12)));
    vec3 to_low = (pane.low - from) * per_way, to_high = (pane.high - from) * per_way;
    vec3 enters = min(to_low, to_high), leaves = max(to_low, to_high);
    float share = min(min(leaves.x, leaves.y), min(leaves.z, 1.0)) - max(max(enters.x, enters.y), max(enters.z, 0.0));
    depth += max(share, 0.0) * length(way) * (materials[pane.block].absorption + materials[pane.block].scattering);
  }
  return exp(-depth);
}
#endif
