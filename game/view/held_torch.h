#pragma once
#include "game/scene_file/emission.h"
#include "shaders/shared/light.h"

namespace skerry::game {

/// A torch burns at this much over or under its mean strength at most.
inline constexpr double kTorchFlicker = 0.12;

/// Strength of a flame over its mean, 1 +- kTorchFlicker: smooth noise of some five and some eleven
/// changes a second. A function of the time alone. @param time_s finite, within +-1e9.
double torch_flicker(double time_s);

/// The light of a torch in the right hand, relative to the eye. The hand turns with the yaw alone
/// and stays closer to the eye than walls can come, so that it never lights their far sides.
/// @param torch what the block sends out.
shared::Light held_torch(const BlockEmission& torch, double yaw_deg, double time_s);

}  // namespace skerry::game
