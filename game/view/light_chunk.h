#pragma once
#include <vector>

#include "game/view/light_field.h"
#include "world/light/air_volume.h"
#include "world/stream/stream.h"

namespace skerry::game {

/// Lamps that reach no further are kept with the light of faces if `indirect=full` [voxels]: a
/// coarse voxel shines as so many blocks as have its area, so that what is weak near is weak afar.
inline constexpr float kWeakLampRange = 10.0f;

/// Takes the weak ones out of a section's lights.
std::vector<world::WeakLamp> take_weak(std::vector<LatticeLight>& lights, int level);

/// A section as light sees it. @param weak of take_weak(). @param strong all other lights.
world::LightChunk light_chunk_of(const world::ReadySection& ready,
                                 std::vector<world::WeakLamp> weak,
                                 const std::vector<LatticeLight>& strong);

}  // namespace skerry::game
