#pragma once
#include <cstdint>

#include "shaders/shared/geometry.h"
#include "world/mesh/chunk_mesh.h"
#include "world/stream/stream.h"

namespace skerry::game {

/// What the renderer keeps of a chunk's mesh, but for where its quads are.
/// @param island index into the island table.
shared::Section section_record(const world::SectionKey& key, const world::ChunkMesh& mesh,
                               std::uint32_t island);

}  // namespace skerry::game
