#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/frame/frame_input.h"
#include "game/scene_file/options.h"
#include "world/light/sky_transfer.h"

namespace skerry::tools {

/// How much of the light is kept: less than the renderer does is for comparison alone.
struct LightDetail {
  int bounces = world::BounceLight::kBounces;  ///< reflections that are followed, from 0
  bool lobes = true;  ///< shares of the sky by lobe; else one share for all of a face's sky
  int degree = 2;     ///< of the harmonics that reflected light is kept in, 0 to 2
  bool keyed = true;  ///< on the nearest islands, sun and moon are followed as they are
  bool operator==(const LightDetail&) const = default;
};

/// The light that stays on the faces of a scene's islands, as the renderer stores and reads it
/// (shaders/include/light/indirect.glsl), without a device: for comparing it with other light.
class StoredLight {
 public:
  /// Finds it for all islands in view, each at the level of detail that it is shown at, on all
  /// cores. Islands shown as one far section see all of their sky. Errors: those of open_world and
  /// load_panorama.
  static Result<StoredLight> find(const game::SceneOptions& options,
                                  const LightDetail& detail = {});

  /// Irradiance of a place on a face. None: its island has no such face at the level that it is
  /// shown at. @param place in the lattice [blocks], on the face.
  /// @param direction of the face; kPlant: of a plant, which counts as level.
  std::optional<glm::dvec3> at(std::uint64_t island, glm::dvec3 place, int direction) const;
  static constexpr int kPlant = 6;
  /// What finding it took: seconds of all threads, bytes that the renderer stores of it.
  double work_seconds() const { return work_seconds_; }
  std::size_t bytes() const;

 private:
  struct Island {
    int level = 0;
    world::SkyTransfer::Skies skies;
    std::size_t first = 0;  // of its texels in sky_
  };
  LightDetail detail_;
  std::map<std::uint64_t, Island> islands_;
  std::vector<glm::uvec4> sky_;  // as render::sky_irradiance makes it
  double work_seconds_ = 0.0;
};

}  // namespace skerry::tools
