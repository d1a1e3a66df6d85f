// What the reference renderer draws, as plain values. Positions are relative to the camera
// [blocks], axes and units as in docs/conventions.md.
#pragma once
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/render/sky/sky_model.h"
#include "tools/reference/clouds.h"
#include "tools/reference/lights.h"
#include "world/islands/volume.h"
#include "world/voxel/blocks.h"

namespace skerry::reference {

/// A lattice of voxels in the world: camera-relative world = rotation * lattice + origin.
struct Island {
  std::shared_ptr<const world::Volume> voxels;
  glm::dmat3 rotation{1.0};
  glm::dvec3 origin{0.0};
};

/// A distant light: a disc in the sky that sends `irradiance` to a surface facing it.
struct Body {
  glm::dvec3 to_light{0.0, 1.0, 0.0};  ///< unit, towards the disc's middle
  glm::dvec3 irradiance{0.0};
  double angular_radius = 0.0;  ///< [rad]; 0: a point, with hard shadows
};

/// The sky of a moment: render::sky_model, and what hides behind it.
struct Sky {
  render::SkyModel model;
  glm::dmat3 sky_from_world{1.0};  ///< the frame in which the stars stand still; unused with a
                                   ///< panorama
};

/// A pinhole camera at the origin.
struct View {
  glm::dvec3 right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0}, forward{0.0, 0.0, -1.0};  ///< unit axes
  double tan_half_y = 1.0;  ///< tangent of half the vertical field of view
  std::uint32_t width = 1, height = 1;
  world::BlockId medium = world::kAir;  ///< translucent block the camera is in
};

/// Where light comes from. At most two bodies, in the order of the program: the first one lights
/// the haze.
struct Scene {
  View view;
  std::vector<Island> islands;
  std::vector<Body> bodies;
  std::vector<Light> lights;
  glm::dvec3 environment{0.0};  ///< radiance that comes from everywhere beyond the voxels
  std::optional<Sky> sky;       ///< none: `environment` is what is seen behind the voxels
  bool sky_lights = false;      ///< `sky` lights surfaces and the air, as far as they see it
  int bounces = 0;  ///< of light between surfaces that a surface's light may have behind it
  double body_in_air = 1.0;  ///< then: how much of the air's light is that of the first body
  Clouds clouds;
  double air_light = 0.0;            ///< share of the sky's light that clouds take, 0..1
  double haze_per_block = 0.0;       ///< extinction of clear air [1/block]
  double time_s = 0.0;               ///< of the ripples on water
  bool shadows = true;               ///< whether bodies are hidden by voxels
  bool flat_shading = false;         ///< bodies: shadow times light, without the angle to the light
  bool matt = false;                 ///< surfaces are diffuse alone, as with flat shading
  double ao_strength = 0.0;          ///< strength of the darkening in corners, 0..1
  std::optional<glm::dvec3> albedo;  ///< of every surface, in place of the textures'
};

}  // namespace skerry::reference
