#include "world/light/light_cache.h"

#include <gtest/gtest.h>

#include <functional>
#include <thread>
#include <vector>

#include "tests/world/light/voxel_rooms.h"

namespace skerry::world {
namespace {

using Kind = LightCache::Kind;

/// Some stone with a lamp, grass and a red pane, over two chunks.
LightChunks heap(int height = 3) {
  test::Voxels stone;
  for (int y = 0; y < height; ++y) stone.insert({y % 2, y, 62 + y});
  return test::chunks_of(stone, {.voxels = {{5, 0, 5}}}, {{9, 0, 9}},
                         {{{3, 3, 3}, block::kRedGlass}});
}

/// The same contents in objects of their own.
LightChunks copied(const LightChunks& chunks) {
  LightChunks out;
  for (const auto& [at, chunk] : chunks) out[at] = std::make_shared<const LightChunk>(*chunk);
  return out;
}

LightCache::Light light_of(const LightChunks& chunks) {
  SkyTransfer transfer(chunks);
  for (int octant = 0; octant < kOctants; ++octant) transfer.look(octant);
  transfer.spread_lamps();
  return {reaches_of(chunks), transfer.make_faces()};
}

std::size_t bytes_with(const LightChunks& chunks) {
  LightCache cache(std::size_t{1} << 30);
  cache.keep(chunks, Kind::kSky, {}, light_of(chunks));
  return cache.stats().bytes;
}

TEST(LightCache, FindsWhatWasFoundOfTheSameContents) {
  LightCache cache(1 << 24);
  const LightChunks chunks = heap();
  EXPECT_EQ(cache.find(chunks, Kind::kSky), nullptr);
  cache.keep(chunks, Kind::kSky, {}, light_of(chunks));
  const auto found = cache.find(copied(chunks), Kind::kSky);
  ASSERT_NE(found, nullptr);
  const LightCache::Light fresh = light_of(chunks);
  EXPECT_TRUE(found->reaches == fresh.reaches);
  ASSERT_EQ(found->skies.size(), fresh.skies.size());
  for (const auto& [at, sky] : fresh.skies) EXPECT_TRUE(*found->skies.at(at) == *sky);
  EXPECT_EQ(cache.stats().found, 1u);
  EXPECT_EQ(cache.stats().missed, 1u);
}

TEST(LightCache, TellsApartAllThatLightDependsOn) {
  LightCache cache(1 << 24);
  LightChunks chunks = heap();
  ASSERT_GE(chunks.size(), 2u);
  ASSERT_FALSE(chunks.begin()->second->stained.empty());
  const StrongLamp strong{{1.0f, 2.0f, 3.0f}, 20.0f, glm::vec3(1.0f)};
  const auto edit = [](LightChunks& of, const std::function<void(LightChunk&)>& change) {
    LightChunk chunk = *of.begin()->second;
    change(chunk);
    of.begin()->second = std::make_shared<const LightChunk>(std::move(chunk));
  };
  edit(chunks, [&](LightChunk& c) {
    c.strong.push_back(strong);
    c.lamps.front().intensity.x = 0.0f;
  });
  cache.keep(chunks, Kind::kSky, {}, light_of(chunks));
  ASSERT_NE(cache.find(copied(chunks), Kind::kSky), nullptr);
  EXPECT_EQ(cache.find(chunks, Kind::kBounces), nullptr);

  const std::function<void(LightChunk&)> changes[] = {
      [](LightChunk& c) { c.opaque.words.front() ^= 1u; },
      [](LightChunk& c) { c.opaque.table.front() ^= 1u; },
      [](LightChunk& c) { c.leaves.fill = ChunkOccupancy::Fill::kFull; },
      [](LightChunk& c) { c.quads.front().material ^= 1u; },
      [](LightChunk& c) { c.quads.pop_back(); },
      [](LightChunk& c) { c.lamps.front().place.y += 0.25f; },
      [](LightChunk& c) { c.lamps.front().intensity.x = -0.0f; },
      [](LightChunk& c) { c.lamps.front().range += 1.0f; },
      [](LightChunk& c) { c.strong.front().range += 1.0f; },
      [](LightChunk& c) { c.strong.clear(); },
      [](LightChunk& c) { c.stained.front().block = block::kStone; },
      [](LightChunk& c) { c.voxel_blocks = 2.0f; },
  };
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    LightChunks other = chunks;
    edit(other, changes[i]);
    EXPECT_EQ(cache.find(other, Kind::kSky), nullptr) << i;
  }
  LightChunks moved = chunks, fewer = chunks;
  auto first = moved.extract(moved.begin());
  --first.key().x;
  moved.insert(std::move(first));
  fewer.erase(fewer.begin());
  EXPECT_EQ(cache.find(moved, Kind::kSky), nullptr);
  EXPECT_EQ(cache.find(fewer, Kind::kSky), nullptr);
}

TEST(LightCache, EvictsTheLeastRecentlyUsed) {
  const LightChunks a = heap(3), b = heap(4), c = heap(5);
  const std::size_t room = bytes_with(a) + bytes_with(b) + bytes_with(c) - 1;
  LightCache cache(room);
  cache.keep(a, Kind::kSky, {}, light_of(a));
  cache.keep(b, Kind::kSky, {}, light_of(b));
  const auto held = cache.find(a, Kind::kSky);  // so that b has not been used for longer
  cache.keep(c, Kind::kSky, {}, light_of(c));
  EXPECT_NE(cache.find(a, Kind::kSky), nullptr);
  EXPECT_EQ(cache.find(b, Kind::kSky), nullptr);
  EXPECT_NE(cache.find(c, Kind::kSky), nullptr);
  EXPECT_EQ(cache.stats().entries, 2u);
  EXPECT_EQ(cache.stats().bytes, bytes_with(a) + bytes_with(c));

  LightCache small(bytes_with(c) - 1);
  small.keep(a, Kind::kSky, {}, light_of(a));
  small.keep(c, Kind::kSky, {}, light_of(c));  // more than all of it
  EXPECT_EQ(small.find(c, Kind::kSky), nullptr);
  EXPECT_NE(small.find(a, Kind::kSky), nullptr);
}

TEST(LightCache, CountsTheBytesOfWhatItHolds) {
  // A word of the sky, of the table and of each list, no less: a bound that leaves one out is none.
  const LightChunks chunks = heap();
  const LightCache::Light light = light_of(chunks);
  std::size_t least = 0;
  for (const auto& [at, c] : chunks)
    least += 4 * (c->opaque.table.size() + c->opaque.words.size()) + 8 * c->quads.size();
  for (const auto& [at, sky] : light.skies)
    least += 4 * sky->table.size() + 16 * sky->texels.size();
  EXPECT_GE(bytes_with(chunks), least);
  EXPECT_LE(bytes_with(chunks), least + 2048);
}

TEST(LightCache, ServesThreadsAtOnce) {
  std::vector<LightChunks> islands;
  for (int i = 1; i <= 4; ++i) islands.push_back(heap(i));
  LightCache cache(bytes_with(islands[0]) + bytes_with(islands[3]));
  std::vector<std::jthread> threads;
  for (unsigned thread = 0; thread < 4; ++thread)
    threads.emplace_back([&, thread] {
      for (unsigned i = 0; i < 40; ++i) {
        const LightChunks& island = islands[(i + thread) % islands.size()];
        const auto found = cache.find(island, Kind::kSky);
        if (found) {
          EXPECT_EQ(found->skies.size(), light_of(island).skies.size());
        } else {
          cache.keep(island, Kind::kSky, {}, light_of(island));
        }
      }
    });
  threads.clear();
  EXPECT_EQ(cache.stats().found + cache.stats().missed, 160u);
  EXPECT_GT(cache.stats().found, 0u);
}

}  // namespace
}  // namespace skerry::world
