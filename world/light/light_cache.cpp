#include "world/light/light_cache.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

namespace skerry::world {
namespace {

// Of floats too: light from -0 need not be light from 0.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  static_assert(sizeof(T) % sizeof(std::uint32_t) == 0 && alignof(T) == alignof(std::uint32_t));
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_light_chunk(const LightChunk& a, const LightChunk& b) {
  return same_bits(a.quads, b.quads) && a.opaque == b.opaque && a.leaves == b.leaves &&
         same_bits(a.lamps, b.lamps) && same_bits(a.strong, b.strong) && a.stained == b.stained &&
         a.voxel_blocks == b.voxel_blocks;
}

bool same_light_chunks(const LightChunks& a, const LightChunks& b) {
  return std::ranges::equal(a, b, [](const auto& p, const auto& q) {
    return p.first == q.first && (p.second == q.second || same_light_chunk(*p.second, *q.second));
  });
}

std::uint64_t mixed(std::uint64_t into, std::uint64_t value) {
  return std::rotl((into ^ value) * 0x9e3779b97f4a7c15u, 29);
}

/// Of where the chunks are and what is drawn of them: islands that differ in nothing of that are
/// told apart by their contents.
std::uint64_t fingerprint_of(const LightChunks& chunks) {
  std::uint64_t out = chunks.size();
  for (const auto& [at, chunk] : chunks) {
    for (const std::int32_t along : {at.x, at.y, at.z})
      out = mixed(out, static_cast<std::uint32_t>(along));
    out = mixed(out, chunk->quads.size());
    for (const shared::Quad& quad : chunk->quads)
      out = mixed(out, std::uint64_t{quad.geometry} << 32 | quad.material);
  }
  return out;
}

template <class T>
std::size_t bytes_in(const std::vector<T>& items) {
  return items.size() * sizeof(T);
}

std::size_t bytes_of(const LightChunk& chunk) {
  std::size_t bytes = sizeof chunk + bytes_in(chunk.quads) + bytes_in(chunk.lamps) +
                      bytes_in(chunk.strong) + bytes_in(chunk.stained);
  for (const ChunkOccupancy* voxels : {&chunk.opaque, &chunk.leaves})
    bytes += bytes_in(voxels->table) + bytes_in(voxels->words);
  return bytes;
}

std::size_t bytes_of(const LightChunks& chunks, const LightCache::Light& light) {
  std::size_t bytes = 0;
  for (const auto& [at, chunk] : chunks) bytes += bytes_of(*chunk);
  for (const auto& [at, sky] : light.skies)
    bytes += sizeof *sky + bytes_in(sky->table) + bytes_in(sky->texels);
  for (const auto& [at, reaches] : light.reaches) bytes += bytes_in(reaches);
  return bytes;
}

}  // namespace

LightCache::Entries::iterator LightCache::place_of(std::uint64_t fingerprint,
                                                   const LightChunks& chunks, Kind kind,
                                                   const KeyDirections& keys) {
  const auto [first, last] = by_fingerprint_.equal_range(fingerprint);
  for (auto one = first; one != last; ++one)
    if (one->second->kind == kind && one->second->keys == keys &&
        same_light_chunks(one->second->chunks, chunks))
      return one->second;
  return entries_.end();
}

std::shared_ptr<const LightCache::Light> LightCache::find(const LightChunks& chunks, Kind kind,
                                                          const KeyDirections& keys) {
  const std::uint64_t fingerprint = fingerprint_of(chunks);
  const std::lock_guard lock(mutex_);
  const auto place = place_of(fingerprint, chunks, kind, keys);
  if (place == entries_.end()) {
    ++stats_.missed;
    return nullptr;
  }
  ++stats_.found;
  entries_.splice(entries_.begin(), entries_, place);
  return place->light;
}

void LightCache::keep(const LightChunks& chunks, Kind kind, const KeyDirections& keys,
                      Light light) {
  Entry entry{fingerprint_of(chunks), kind, keys, chunks, {}, bytes_of(chunks, light)};
  if (entry.bytes > most_bytes_) return;
  entry.light = std::make_shared<const Light>(std::move(light));
  const std::lock_guard lock(mutex_);
  if (place_of(entry.fingerprint, chunks, kind, keys) != entries_.end()) return;
  stats_.bytes += entry.bytes;
  entries_.push_front(std::move(entry));
  by_fingerprint_.emplace(entries_.front().fingerprint, entries_.begin());
  while (stats_.bytes > most_bytes_) evict();
}

void LightCache::evict() {
  const auto last = std::prev(entries_.end());
  const auto [first, end] = by_fingerprint_.equal_range(last->fingerprint);
  by_fingerprint_.erase(
      std::find_if(first, end, [&](const auto& one) { return one.second == last; }));
  stats_.bytes -= last->bytes;
  entries_.erase(last);
}

LightCache::Stats LightCache::stats() const {
  const std::lock_guard lock(mutex_);
  Stats stats = stats_;
  stats.entries = entries_.size();
  return stats;
}

}  // namespace skerry::world
