#pragma once
#include <map>
#include <vector>

#include "world/light/lamp_reach.h"

namespace skerry::world {

/// Of all strong lamps, in the order of LightChunk::strong; chunks without are left out.
using LampReaches = std::map<IVec3, std::vector<LampReach::Found>>;
LampReaches reaches_of(const LightChunks& chunks);
/// The same of chunks some of which have been edited: only lamps whose light may enter where faces
/// have changed are asked again. @param before, known chunks as they were, and what reaches_of()
/// found of them.
LampReaches reaches_after(const LightChunks& chunks, const LightChunks& before,
                          const LampReaches& known);

}  // namespace skerry::world
