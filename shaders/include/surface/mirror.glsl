// What water and glass mirror besides lights. Needs before the include: what water.glsl needs, indirect.glsl, traced.glsl.
// docs/decisions/0059-what-water-mirrors.md.
#ifndef SKERRY_MIRROR_GLSL
#define SKERRY_MIRROR_GLSL

const float kMirrorReach = 256.0;  // blocks that a mirrored ray is followed

// The radiance of a place, if the picture shows it, and no water or glass there changes it in this pass.
bool shown_at(vec3 p, out vec3 seen) {
  float z = dot(p, frame.ray_forward);
  vec2 place = pixel_place(p, z);
  bool inside = frame.camera_medium == 0u && z > frame.near_plane && all(greaterThanEqual(place, vec2(frame.radiance_area.xy))) &&
                all(lessThan(place, vec2(frame.radiance_area.zw)));
  ivec2 pixel = ivec2(inside ? place : vec2(frame.radiance_area.xy));
  float depth = texelFetch(depths, pixel, 0).r;
  inside = inside && depth > 0.0 && abs(view_distance(max(depth, 1e-12), frame.near_plane) - z) < 0.5 + 0.01 * z &&
           layer_depth(0u, pixel) <= 0.0;
  seen = imageLoad(radiance, pixel).rgb;
  return inside;
}

// Share of a body's light that arrives, by one texel of a map that cannot leak (see air_visibility).
float mirrored_light(const uint index, const uint first_cascade, vec3 p, vec3 n) {
  float n_dot_l = dot(n, frame.bodies[index].to_light);
  return n_dot_l > 0.0 ? n_dot_l * light_at_place(first_cascade, p + n * 0.25) : 0.0;
}

// Mean albedo of what is not in the picture: nothing but its light is known there.
const vec3 kUnseenAlbedo = vec3(0.22, 0.2, 0.15);

// What a voxel's face sends out that the picture does not show.
vec3 unseen_face(uint word, vec3 p, vec3 n) {
  vec3 irradiance = vec3(0.0);
  if (kIndirect != kIndirectOff) irradiance += sky_of_face(p, word).irradiance;
  if ((kBodies & 1u) != 0u) irradiance += frame.bodies[0].irradiance * mirrored_light(0u, 0u, p, n);
  if ((kBodies & 2u) != 0u) irradiance += frame.bodies[1].irradiance * mirrored_light(1u, kMoonCascade, p, n);
  return irradiance * kUnseenAlbedo * kInvPi;
}

struct Mirrored {
  vec3 radiance;
  float distance;  // blocks, up to what is mirrored
  bool sky;        // nothing is met
};

// What a ray meets that a surface mirrors, in its own island. @param dir unit, before the surface. @param here false: there is none.
Mirrored mirrored_voxels(WayStart start, vec3 p, vec3 dir, bool here) {
  uint island = here ? start.island : 0u;
  IslandTransform t = island_at(island);
  VoxelGrid grid = voxel_grid(island);
  vec3 to = start.from + lattice_from_world_vector(t, dir) * (here ? grid.per_block * kMirrorReach : 0.0);
  Marched m = march(grid, start.from, start.voxel, to, ivec3(0x7fffffff));
  uint face = min(m.face, kFaceCount - 1u);
  vec3 place = p + dir * (m.share * kMirrorReach), n = world_from_lattice_vector(t, face_normal(face)), seen;
  bool shown = shown_at(place, seen);
  vec3 unseen = unseen_face((island << kIslandShift) | (face << kFaceShift), place, n);
  return Mirrored(shown ? seen : unseen, m.share * kMirrorReach, !m.met);
}

// The sky as a surface mirrors it that knows no more of the world than how much of the sky it sees and how bright the rest is. @param around
// of the surface. @param dir, normal unit, world. @param lit largest visibility of sun and moon: all that is known where the sky lights nothing.
vec3 mirrored_about(FaceSky around, uint word, vec3 dir, vec3 sky, float lit) {
  if (kIndirect == kIndirectOff) return sky * lit;
  vec3 lattice = lattice_from_world_vector(island_at(surface_island(word)), dir);
  float seen = seen_towards(around, surface_face(word), lattice);
  return sky * (seen * around.tint) + around.bounced * ((1.0 - seen) * kInvPi / max(1.0 - open_share(around, surface_face(word)), 0.1));
}
#endif
