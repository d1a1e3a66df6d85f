#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "engine/render/frame/camera.h"
#include "game/view/light_field.h"
#include "world/islands/world.h"

namespace skerry::game {

struct ScatterView {
  world::WorldPos camera;
  render::CameraView lens;
  double view_distance_blocks = 1000.0;
  double time_s = 0.0;
};

/// Torches a little off the surfaces that a camera sees, spread evenly over its picture: where the
/// rays of a low-discrepancy sequence of pixels first meet a block at full detail. The farther away
/// and the more of them, the smaller is what each lights, so that some twenty light a pixel. By
/// section of level 0, as LightField::scatter takes them; deterministic.
/// @param count of torches; fewer when 16 rays for each have not found enough to stand on.
std::map<world::SectionKey, std::vector<LatticeLight>> scatter_lights(world::World& world,
                                                                      const ScatterView& view,
                                                                      std::uint32_t count);

}  // namespace skerry::game
