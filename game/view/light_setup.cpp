#include "game/view/light_setup.h"

#include <glm/vector_relational.hpp>

#include "game/view/held_torch.h"
#include "game/view/scatter_lights.h"
#include "world/generate/shape.h"

namespace skerry::game {

LightField light_field_of(const SceneOptions& options, world::World& world,
                          const render::Camera& first) {
  LightField field;
  field.set_world_lights(options.lights);
  const Settings& settings = options.settings;
  if (settings.lights_random == 0) return field;
  const ScatterView view{{first.position[0], first.position[1], first.position[2]},
                         render::view_of(first, options.size.width, options.size.height),
                         static_cast<double>(settings.view_distance),
                         settings.world_time_s};
  field.scatter(scatter_lights(world, view, settings.lights_random));
  return field;
}

std::optional<shared::Light> held_light(const Settings& settings, const LightField& field,
                                        double yaw_deg, double world_time_s) {
  if (!settings.lights_held) return std::nullopt;
  return held_torch(field.emission(world::block::kTorch), yaw_deg, world_time_s);
}

render::IslandLand land_of(const world::IslandSpec& spec) {
  const auto vector = [](world::IVec3 v) { return glm::vec3(v.x, v.y, v.z); };
  // Of generated islands, on the mean: tests/game/view/island_shade_test.cpp.
  constexpr glm::vec3 kOfBox{0.65f, 0.6f, 0.65f};
  // Boxes have empty room beside the land, below it, and for trees above it.
  const glm::vec3 below(world::kBoxMargin, world::kKeelRoom, world::kBoxMargin),
      above(world::kBoxMargin, world::kTreeRoom, world::kBoxMargin);
  glm::vec3 low = vector(spec.box_min), high = vector(spec.box_max);
  if (glm::all(glm::greaterThan(high - low, 2.0f * (below + above)))) low += below, high -= above;
  return {0.5f * (low + high), kOfBox * 0.5f * (high - low)};
}

}  // namespace skerry::game
