#include "game/sections/section_record.h"

#include <algorithm>
#include <array>

namespace skerry::game {
namespace {

std::uint32_t packed_box(const std::array<std::uint8_t, 3>& corner) {
  return std::uint32_t{corner[0]} | std::uint32_t{corner[1]} << 7 | std::uint32_t{corner[2]} << 14;
}

}  // namespace

shared::Section section_record(const world::SectionKey& key, const world::ChunkMesh& mesh,
                               std::uint32_t island) {
  shared::Section section{};
  const std::int32_t edge = world::kChunkEdge << key.level;
  section.origin = {key.chunk.x * edge, key.chunk.y * edge, key.chunk.z * edge};
  if (key.far) section.origin = glm::ivec3(-edge / 2);
  section.island = island;
  section.voxel_size_log2 = static_cast<std::uint32_t>(key.level);
  section.bounds_min = packed_box(mesh.bounds_min);
  section.bounds_max = packed_box(mesh.bounds_max);
  std::copy(mesh.range_end.begin(), mesh.range_end.end(), section.range_end);
  return section;
}

}  // namespace skerry::game
