// Lights as the options set them, for the renderer and the reference.
#pragma once
#include <optional>

#include "engine/render/frame/camera.h"
#include "engine/render/frame/frame_input.h"
#include "game/scene_file/options.h"
#include "game/view/light_field.h"
#include "world/islands/world.h"

namespace skerry::game {

/// A field with the lights that a scene has besides those of its blocks: its file's, and those
/// scattered over what its first camera sees.
LightField light_field_of(const SceneOptions& options, world::World& world,
                          const render::Camera& first);

/// The light in the hand, relative to the camera. None: the hand is empty.
std::optional<shared::Light> held_light(const Settings& settings, const LightField& field,
                                        double yaw_deg, double world_time_s);

/// What an island hides from others: an ellipsoid within the box of its voxels, which is wider than
/// most of them are.
render::IslandLand land_of(const world::IslandSpec& spec);

}  // namespace skerry::game
