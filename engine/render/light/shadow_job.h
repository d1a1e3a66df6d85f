// Coarse shadow maps are drawn in parts, some sections a frame, so that no frame draws all that the
// light sees (docs/decisions/0055).
#pragma once
#include <cstdint>
#include <span>

#include "engine/render/light/shadow_changes.h"
#include "engine/render/light/shadow_history.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {

/// About how many quads that face the light may show in a part of a map.
double quads_in(const TexelBox& box, const Cascade& cascade, const FrameInput& input,
                std::span<const shared::Section> sections);

/// Slots of the geometry store, [first, end).
struct SectionRange {
  std::uint32_t first = 0, end = 0;
};
/// What a job draws in the next frame.
SectionRange next_part(ShadowJob& job, const Cascade& cascade, const FrameInput& input,
                       std::span<const shared::Section> sections);

}  // namespace skerry::render
