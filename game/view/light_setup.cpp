#include "game/view/light_setup.h"

#include "game/view/held_torch.h"
#include "game/view/scatter_lights.h"

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

}  // namespace skerry::game
