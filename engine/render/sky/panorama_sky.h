#pragma once
#include <glm/vec3.hpp>
#include <memory>

#include "engine/render/sky/panorama.h"
#include "engine/render/sky/sky_cube.h"

namespace skerry::render {

/// How a panorama becomes a sky. docs/decisions/0053.
struct PanoramaPlacement {
  double yaw_deg = 0.0;                ///< azimuth of its middle, as of a camera
  float scale = 1.0f;                  ///< radiance of what is 1 in the file
  float peak = kMostPanoramaRadiance;  ///< of the file: what is brighter counts as that
  bool operator==(const PanoramaPlacement&) const = default;
};

/// A panorama as the sky, made once: what is seen of it and what it sends.
class PanoramaSky {
 public:
  /// Some 50 ms.
  PanoramaSky(Panorama panorama, const PanoramaPlacement& placement);

  /// Clipped and scaled: radiance in the program's unit.
  const Panorama& image() const { return image_; }
  double yaw() const { return yaw_; }  ///< azimuth of its middle [rad]
  /// In a direction (unit), as the shaders see it.
  glm::dvec3 radiance(glm::dvec3 dir) const {
    return panorama_texel(image_, panorama_place(dir, yaw_));
  }
  /// Of all directions.
  glm::dvec3 mean() const { return mean_; }
  /// For light on faces: each direction's mean over some 20 degrees about it, so that few samples
  /// find the same light in it whichever way an island has turned.
  const SkyCube& smooth() const { return *smooth_; }

 private:
  Panorama image_;
  double yaw_;
  glm::dvec3 mean_{0.0};
  std::unique_ptr<const SkyCube> smooth_;
};

}  // namespace skerry::render
