#include "world/light/lamp_reaches.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "world/light/face_changes.h"

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

/// Both sides of all faces that have changed: an edit changes faces wherever light could tell.
VoxelBox changed_in(const LightChunk& before, const LightChunk& now, IVec3 at) {
  const FaceChanges changes = face_changes(before.quads, now.quads);
  VoxelBox box;
  const IVec3 corner = corner_of(at);
  for (const std::vector<BlockFace>* faces : {&changes.came, &changes.went, &changes.turned})
    for (const auto& [drawn, block] : *faces) {
      box.take(vector_of(corner + drawn.voxel));
      box.take(vector_of(corner + drawn.voxel + to_front(drawn)));
    }
  return box;
}

std::vector<VoxelBox> changed_boxes(const LightChunks& before, const LightChunks& now) {
  std::vector<VoxelBox> out;
  const auto whole = [](IVec3 at) {
    const glm::ivec3 low = vector_of(corner_of(at));
    return VoxelBox{low - 1, low + kChunkEdge};
  };
  for (const auto& [at, chunk] : now) {
    const auto old = before.find(at);
    if (old == before.end())
      out.push_back(whole(at));
    else if (old->second != chunk)
      out.push_back(changed_in(*old->second, *chunk, at));
  }
  for (const auto& [at, chunk] : before)
    if (!now.contains(at)) out.push_back(whole(at));
  std::erase_if(out, [](const VoxelBox& box) { return box.low.x > box.high.x; });
  return out;
}

/// What is known of a lamp where no change has a part in it. Null: there is nothing.
const LampReach::Found* still_known(IVec3 at, const StrongLamp& lamp, const LightChunks& before,
                                    const LampReaches& known,
                                    const std::vector<VoxelBox>& changed) {
  const auto found = known.find(at);
  if (found == known.end()) return nullptr;
  const std::vector<StrongLamp>& old = before.at(at)->strong;
  const auto same = std::ranges::find_if(old, [&](const StrongLamp& other) {
    return other.place == lamp.place && other.range == lamp.range;
  });
  if (same == old.end()) return nullptr;
  const LampReach::Found& reach = found->second[static_cast<std::size_t>(same - old.begin())];
  const bool stays = std::ranges::none_of(changed, [&](const VoxelBox& box) {
    return reach.entered.any_within(voxel_at(box.low), voxel_at(box.high));
  });
  return stays ? &reach : nullptr;
}

}  // namespace

LampReaches reaches_of(const LightChunks& chunks) {
  return reaches_after(chunks, {}, {});
}

LampReaches reaches_after(const LightChunks& chunks, const LightChunks& before,
                          const LampReaches& known) {
  constexpr int kAround = 2;  // faces are asked for on both sides of them
  const std::vector<VoxelBox> changed = changed_boxes(before, chunks);
  struct Asked {
    IVec3 at;
    std::size_t lamp;
  };
  std::vector<Asked> asked;
  VoxelBox reached;  // by those
  LampReaches out;
  for (const auto& [at, chunk] : chunks)
    for (std::size_t i = 0; i < chunk->strong.size(); ++i) {
      const StrongLamp& lamp = chunk->strong[i];
      const LampReach::Found* same = still_known(at, lamp, before, known, changed);
      out[at].push_back(same ? *same : LampReach::Found{});
      if (same) continue;
      asked.push_back({at, i});
      reached.take(glm::ivec3(glm::floor(place_of(at, lamp) - lamp.range)) - kAround);
      reached.take(glm::ivec3(glm::floor(place_of(at, lamp) + lamp.range)) + kAround);
    }
  if (asked.empty()) return out;
  const LampReach reach(chunks, voxel_at(reached.low), voxel_at(reached.high));
  for (const auto& [at, lamp] : asked) out[at][lamp] = reach.of(at, chunks.at(at)->strong[lamp]);
  return out;
}

}  // namespace skerry::world
