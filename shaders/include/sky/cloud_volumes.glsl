// Values of files' grids: bricks in an atlas, found through cells. Needs before the include: what cloud_boxes.glsl has, `cloud_cells` (sampler3D,
// nearest; rgb: the brick's place in the atlas in bricks, a: the largest value within, 0: there is nothing) and `cloud_bricks` (sampler3D, linear).
#ifndef SKERRY_CLOUD_VOLUMES_GLSL
#define SKERRY_CLOUD_VOLUMES_GLSL

// A cell's brick and largest value.
vec4 cell_at(const uint v, ivec3 cell, int level) {
  vec3 inside = vec3(cell);
  bool known = all(greaterThanEqual(inside, vec3(0.0))) && all(lessThan(inside * float(1 << level), clouds.volumes[v].cell_count));
  ivec3 first = ivec3(clouds.volumes[v].first_cell) >> level;
  vec4 found = texelFetch(cloud_cells, first + (known ? cell : ivec3(0)), level);
  return known ? found : vec4(0.0);
}

// The value at a place: trilinear between samples at whole numbers. @param at index.
float volume_value(const uint v, vec3 at, vec4 cell_found, vec3 cell) {
  vec3 inside = at - clouds.volumes[v].cell_low - cell * float(kCloudBrickEdge);
  vec3 brick = floor(cell_found.rgb * 255.0 + 0.5) * float(kCloudBrickTexels);
  vec3 texel = brick + clamp(inside, vec3(0.0), vec3(float(kCloudBrickEdge))) + 0.5;
  float value = textureLod(cloud_bricks, texel / vec3(textureSize(cloud_bricks, 0)), 0.0).r;
  return cell_found.a > 0.0 ? value : 0.0;
}

vec3 cell_of_index(const uint v, vec3 at) { return floor((at - clouds.volumes[v].cell_low) * (1.0 / float(kCloudBrickEdge))); }

float volume_value(const uint v, vec3 at) {
  vec3 cell = cell_of_index(v, at);
  return volume_value(v, at, cell_at(v, ivec3(cell), 0), cell);
}

// How far a line stays in empty cells, in units of `along`. @pre the cell about `at` is empty.
float empty_way(const uint v, vec3 at, vec3 along) {
  int level = int(kCloudCellLevels) - 1;
  vec3 place = (at - clouds.volumes[v].cell_low) * (1.0 / float(kCloudBrickEdge));
  if (cell_at(v, ivec3(floor(place * exp2(float(-level)))), level).a > 0.0) level = 0;
  float edge = float(kCloudBrickEdge << level);
  vec3 inside = (at - clouds.volumes[v].cell_low) - floor(place * exp2(float(-level))) * edge;
  vec3 way = mix(edge - inside, -inside, lessThan(along, vec3(0.0))) / mix(along, vec3(1e-20), lessThan(abs(along), vec3(1e-20)));
  return max(min(min(way.x, way.y), way.z), 0.0);
}
#endif
