#include "game/view/sky_light_feed.h"

#include <algorithm>
#include <glm/common.hpp>

#include "engine/gpu/transfer/uploader.h"

namespace skerry::game {
namespace {

// An island takes another's place only if that is this much farther: as a camera goes to and fro,
// none of them blinks.
constexpr double kFarther = 1.25, kFartherBlocks = 16.0;

glm::ivec3 place(const IslandLight::FoundChunk& chunk) {
  return {chunk.at.x, chunk.at.y, chunk.at.z};
}

render::ChunkSkyLight light_of(const IslandLight::FoundChunk& chunk) {
  return {place(chunk),  chunk.sky->table,        chunk.sky->texels,
          chunk.changed, chunk.sky->parts.tinted, chunk.sky->parts.keyed};
}

/// Around all chunks. @pre there are some.
render::IslandChunks box_of(const IslandLight::Found& found) {
  glm::ivec3 low(INT32_MAX), high(INT32_MIN);
  for (const IslandLight::FoundChunk& chunk : found.chunks)
    low = glm::min(low, place(chunk)), high = glm::max(high, place(chunk));
  return {low, high - low + 1, static_cast<std::uint32_t>(found.row.level)};
}

/// Whether an entry has light in the store that may be taken for one at `distance`.
constexpr auto kGivesWay = [](const auto& entry, double distance) {
  return entry.in_store && entry.distance > distance * kFarther + kFartherBlocks;
};

bool same_box(const render::IslandChunks& a, const render::IslandChunks& b) {
  return a.low == b.low && a.size == b.size && a.voxel_size_log2 == b.voxel_size_log2;
}

}  // namespace

void SkyLightFeed::add(IslandLight::Found found) {
  if (found.chunks.empty()) {
    shown_.emplace_back(found.row, found.keys);
    return;
  }
  Entry& entry = entries_[found.row];
  const render::IslandChunks box = box_of(found);
  // A find that replaces one before it was all put: what that one would have changed. What was put
  // of another grid is dropped with it.
  std::set<world::IVec3> missing;
  if (!same_box(box, entry.box)) {
    missing = entry.unshown;
  } else if (entry.state == State::kWaiting) {
    for (std::size_t i = entry.next; i < entry.found.chunks.size(); ++i)
      if (entry.found.chunks[i].changed) missing.insert(entry.found.chunks[i].at);
  }
  for (IslandLight::FoundChunk& chunk : found.chunks) {
    chunk.changed |= missing.contains(chunk.at);
    if (chunk.changed) entry.unshown.insert(chunk.at);
  }
  if (entry.state == State::kDark) entry.dark_until = 0;
  entry.found = std::move(found);
  entry.box = box;
  std::vector<render::ChunkSkyLight> chunks;
  for (const IslandLight::FoundChunk& chunk : entry.found.chunks) chunks.push_back(light_of(chunk));
  entry.bytes = render::IndirectStore::bytes_for(box, chunks);
  entry.begun = false;
  entry.next = 0;
  entry.state = entry.state == State::kDark ? State::kDark : State::kWaiting;
}

SkyLightFeed::Put SkyLightFeed::put(render::IndirectStore& store, gpu::Uploader& uploader,
                                    Entry& entry, std::uint64_t most_bytes) {
  Result<void> done;
  if (!entry.begun) done = store.begin(uploader, entry.slot, entry.box);
  entry.begun = static_cast<bool>(done);
  entry.in_store |= entry.begun;
  for (; done && entry.next < entry.found.chunks.size(); ++entry.next) {
    if (uploader.pending_bytes() >= most_bytes) return Put::kPaused;
    done = store.put(uploader, entry.slot, light_of(entry.found.chunks[entry.next]));
    if (!done) break;
  }
  if (!done) {
    why_ = done.error().message;
    return Put::kFull;
  }
  store.finish(uploader, entry.slot);
  entry.state = State::kShown;
  entry.unshown.clear();
  shown_.emplace_back(entry.found.row, entry.found.keys);
  return Put::kDone;
}

std::vector<SkyLightFeed::Entry*> SkyLightFeed::nearest(
    State state, const std::map<world::IslandLevel, NearIsland>& islands) {
  std::vector<Entry*> out;
  for (auto& [id, entry] : entries_) {
    const auto at = islands.find(id);
    if (at == islands.end()) continue;
    entry.slot = at->second.slot;
    entry.distance = at->second.distance;
    if (entry.state == state) out.push_back(&entry);
  }
  std::ranges::stable_sort(out, {}, &Entry::distance);
  return out;
}

/// Entries with light in the store that may give way to one at `distance`, farthest first.
std::vector<SkyLightFeed::Entry*> SkyLightFeed::lit_beyond(double distance) {
  std::vector<Entry*> out;
  for (auto& [id, entry] : entries_)
    if (kGivesWay(entry, distance)) out.push_back(&entry);
  std::ranges::stable_sort(out, std::greater{}, &Entry::distance);
  return out;
}

/// What the store has left and what may give way to an entry.
std::uint64_t SkyLightFeed::room_for(const render::IndirectStore& store, const Entry& entry) {
  std::uint64_t room = store.bytes_left();
  for (const auto& [id, other] : entries_)
    if (kGivesWay(other, entry.distance)) room += other.bytes;
  return room;
}

/// @return false: all that is farther would not be enough, and stays.
bool SkyLightFeed::make_room(render::IndirectStore& store, gpu::Uploader& uploader,
                             const Entry& entry) {
  const std::vector<Entry*> farther = lit_beyond(entry.distance);
  if (farther.empty() || room_for(store, entry) < entry.bytes) return false;
  std::uint64_t freed = store.bytes_left();
  for (Entry* other : farther) {
    go_dark(store, uploader, *other);
    refusal_ = why_;
    freed += other->bytes;
    if (freed >= entry.bytes) break;
  }
  return true;
}

void SkyLightFeed::go_dark(render::IndirectStore& store, gpu::Uploader& uploader, Entry& entry) {
  store.end_island(uploader, entry.slot);
  entry.state = State::kDark;
  entry.in_store = entry.begun = false;
  entry.dark_until = 0;
}

void SkyLightFeed::take_back(render::IndirectStore& store, gpu::Uploader& uploader) {
  for (auto& [id, entry] : entries_) go_dark(store, uploader, entry);
}

/// The nearest island without light waits again, if there is room for it or farther ones can make
/// it. @return whether there is one.
bool SkyLightFeed::try_dark_again(render::IndirectStore& store,
                                  const std::map<world::IslandLevel, NearIsland>& islands) {
  for (Entry* entry : nearest(State::kDark, islands)) {
    if (room_for(store, *entry) < std::max(entry->bytes, entry->dark_until)) continue;
    entry->state = State::kWaiting;
    entry->begun = false;
    entry->next = 0;
    for (IslandLight::FoundChunk& chunk : entry->found.chunks) chunk.changed = true;
    return true;
  }
  return false;
}

bool SkyLightFeed::idle() const {
  return std::ranges::all_of(entries_,
                             [](const auto& entry) { return entry.second.state == State::kShown; });
}

bool SkyLightFeed::hand_over(render::IndirectStore& store, gpu::Uploader& uploader,
                             const std::map<world::IslandLevel, NearIsland>& islands,
                             std::uint64_t most_bytes) {
  for (Entry* entry : nearest(State::kWaiting, islands)) {
    const Put result = put(store, uploader, *entry, most_bytes);
    if (result == Put::kDone) continue;
    // What has been freed can be taken once the GPU has finished with it.
    if (result == Put::kPaused || store.bytes_waiting() != 0) return true;
    if (make_room(store, uploader, *entry)) return true;
    go_dark(store, uploader, *entry);
    // With the part that was put, which is room once the GPU is done with it. What there is lies in
    // pieces that are too small: more of it first, or it would be tried for ever.
    const std::uint64_t room = store.bytes_waiting() + room_for(store, *entry);
    if (room >= entry->bytes) entry->dark_until = room + entry->bytes / 4;
    refusal_ = why_;
  }
  if (idle()) return false;
  return store.bytes_waiting() != 0 || try_dark_again(store, islands);
}

}  // namespace skerry::game
