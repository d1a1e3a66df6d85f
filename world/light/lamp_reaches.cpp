#include "world/light/lamp_reaches.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "world/light/base/face_changes.h"
#include "world/voxel/blocks.h"

namespace skerry::world {
namespace {

IVec3 voxel_at(const glm::ivec3& v) {
  return {v.x, v.y, v.z};
}
glm::vec3 place_of(IVec3 chunk, const StrongLamp& lamp) {
  return glm::vec3(vector_of(corner_of(chunk))) + lamp.place;
}

/// Voxels, both ends included; empty: low is above high.
struct VoxelBox {
  glm::ivec3 low{INT32_MAX}, high{INT32_MIN};
  void take(const glm::ivec3& v) { low = glm::min(low, v), high = glm::max(high, v); }
};

/// Where something is other than before.
struct Changes {
  std::vector<ReachFace> faces;  // of edited chunks: a change of voxels is one of faces, too,
  VoxelBox box;                  // wherever light could tell; both sides of all of them
  std::vector<VoxelBox> chunks;  // that have come or gone, and what is next to them
};

void add_faces(Changes& out, const LightChunk& before, const LightChunk& now, IVec3 at) {
  const FaceChanges changes = face_changes(before.quads, now.quads);
  const IVec3 corner = corner_of(at);
  for (const std::vector<BlockFace>* faces : {&changes.came, &changes.went, &changes.turned})
    for (const auto& [drawn, block] : *faces) {
      const IVec3 voxel = corner + drawn.voxel, front = voxel + to_front(drawn);
      // One that has turned may have been of water or glass.
      const bool one_sided =
          !drawn.plant && faces != &changes.turned && block_kind(block) == BlockKind::kOpaque;
      out.faces.push_back({voxel, front, drawn.direction, one_sided});
      out.box.take(vector_of(voxel));
      out.box.take(vector_of(front));
    }
}

Changes changes_of(const LightChunks& before, const LightChunks& now) {
  Changes out;
  const auto add_chunk = [&](IVec3 at) {
    const glm::ivec3 low = vector_of(corner_of(at));
    out.chunks.push_back({low - 1, low + kChunkEdge});
  };
  for (const auto& [at, chunk] : now) {
    const auto old = before.find(at);
    if (old == before.end())
      add_chunk(at);
    else if (old->second != chunk)
      add_faces(out, *old->second, *chunk, at);
  }
  for (const auto& [at, chunk] : before)
    if (!now.contains(at)) add_chunk(at);
  return out;
}

/// What was found of a lamp. Null: it was not there.
const LampReach::Found* found_of(IVec3 at, const StrongLamp& lamp, const LightChunks& before,
                                 const LampReaches& known) {
  const auto found = known.find(at);
  if (found == known.end()) return nullptr;
  const std::vector<StrongLamp>& old = before.at(at)->strong;
  const auto same = std::ranges::find_if(old, [&](const StrongLamp& other) {
    return other.place == lamp.place && other.range == lamp.range;
  });
  return same == old.end() ? nullptr : &found->second[static_cast<std::size_t>(same - old.begin())];
}

struct Asked {
  IVec3 at;
  std::size_t lamp;
};

/// Leaves out those whose light enters none of the bricks in which faces have changed, but not the
/// changed faces either.
void keep_changed(std::vector<Asked>& doubtful, const Changes& changes, const LightChunks& chunks) {
  VoxelBox box = changes.box;
  for (const auto& [at, lamp] : doubtful)
    box.take(glm::ivec3(glm::floor(place_of(at, chunks.at(at)->strong[lamp]))));
  if (doubtful.empty()) return;
  const VoxelBits opaque = opaque_within(chunks, voxel_at(box.low), voxel_at(box.high));
  std::erase_if(doubtful, [&](const Asked& asked) {
    return !LampReach::changes(opaque, asked.at, chunks.at(asked.at)->strong[asked.lamp],
                               changes.faces);
  });
}

}  // namespace

LampReaches reaches_of(const LightChunks& chunks) {
  return reaches_after(chunks, {}, {});
}

LampReaches reaches_after(const LightChunks& chunks, const LightChunks& before,
                          const LampReaches& known) {
  constexpr int kAround = 2;  // faces are asked for on both sides of them
  const Changes changes = changes_of(before, chunks);
  std::vector<Asked> asked, doubtful;
  LampReaches out;
  for (const auto& [at, chunk] : chunks)
    for (std::size_t i = 0; i < chunk->strong.size(); ++i) {
      const LampReach::Found* found = found_of(at, chunk->strong[i], before, known);
      out[at].push_back(found ? *found : LampReach::Found{});
      const auto enters = [&](const VoxelBox& box) {
        return found->entered.any_within(voxel_at(box.low), voxel_at(box.high));
      };
      if (!found || std::ranges::any_of(changes.chunks, enters))
        asked.push_back({at, i});
      else if (!changes.faces.empty() && enters(changes.box))
        doubtful.push_back({at, i});
    }
  keep_changed(doubtful, changes, chunks);
  asked.insert(asked.end(), doubtful.begin(), doubtful.end());
  if (asked.empty()) return out;
  VoxelBox reached;
  for (const auto& [at, i] : asked) {
    const StrongLamp& lamp = chunks.at(at)->strong[i];
    reached.take(glm::ivec3(glm::floor(place_of(at, lamp) - lamp.range)) - kAround);
    reached.take(glm::ivec3(glm::floor(place_of(at, lamp) + lamp.range)) + kAround);
  }
  const LampReach reach(chunks, voxel_at(reached.low), voxel_at(reached.high));
  for (const auto& [at, i] : asked) out[at][i] = reach.of(at, chunks.at(at)->strong[i]);
  return out;
}

}  // namespace skerry::world
