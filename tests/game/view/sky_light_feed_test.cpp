#include "game/view/sky_light_feed.h"

#include <algorithm>
#include <random>
#include <set>

#include "engine/gpu/transfer/uploader.h"
#include "shaders/shared/frame.h"
#include "tests/gpu/test_device.h"

namespace skerry::game {
namespace {

using Texels = std::vector<glm::uvec4>;
using Islands = std::map<world::IslandLevel, SkyLightFeed::NearIsland>;
using Place = std::array<int, 3>;

constexpr std::uint64_t kTexelBytes = sizeof(glm::uvec4);
constexpr std::uint32_t kChunkTexels = 2 * shared::kIndirectBrickTexels + 900;
// The store takes half of a budget.
constexpr std::uint64_t kStoreTexels = shared::kIndirectFirst + 23'552;
constexpr std::uint64_t kBudget = 2 * kStoreTexels * kTexelBytes;

/// Two bricks with masks and records of random bits; each mask names a record of the chunk.
std::shared_ptr<const world::ChunkSky> random_chunk(std::mt19937& random,
                                                    std::uint32_t texels = kChunkTexels) {
  auto sky = std::make_shared<world::ChunkSky>();
  sky->table.resize(512);
  sky->table[random() % 256] = 1;
  sky->table[256 + random() % 256] = 2;
  for (std::uint32_t i = 0; i < texels; ++i)
    sky->texels.emplace_back(random(), random(), random(), random());
  const std::uint32_t masks = 2 * shared::kIndirectBrickTexels;
  for (std::uint32_t i = 0; i < masks; ++i) {
    sky->texels[i].z = masks + static_cast<std::uint32_t>(random() % (texels - masks));
    sky->texels[i].w = masks + static_cast<std::uint32_t>(random() % (texels - masks));
  }
  return sky;
}

class LightOfManyIslands : public gpu::GpuTest {
 protected:
  LightOfManyIslands() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    uploader_ = std::make_unique<gpu::Uploader>(device(), gpu::UploadPath::kUpdateBuffer);
    auto made = render::IndirectStore::create(device(), budget_);
    ASSERT_TRUE(made) << made.error().message;
    store_ = *std::move(made);
  }
  void TearDown() override {
    store_.reset();
    uploader_.reset();
    GpuTest::TearDown();
  }

  /// An island of a row of chunks from `low` on, all of them new.
  IslandLight::Found island(std::uint64_t id, int low, int chunks) {
    IslandLight::Found found{{id}, {}};
    for (int z = 0; z < chunks; ++z)
      found.chunks.push_back({{-1, 0, low + z}, random_chunk(random_), true});
    return found;
  }
  /// What the feed has put so far gets to the GPU. @return whether there is more.
  bool frame(const Islands& islands, std::uint64_t most_bytes = UINT64_MAX) {
    const bool more = feed_.hand_over(*store_, *uploader_, islands, most_bytes);
    device().run_now([&](VkCommandBuffer commands) { uploader_->record(commands, UINT64_MAX); });
    store_->collect();
    return more;
  }
  /// @return frames it took.
  int settle(const Islands& islands, std::uint64_t most_bytes = UINT64_MAX) {
    int frames = 1;
    while (frame(islands, most_bytes) && frames < 1000) ++frames;
    EXPECT_LT(frames, 1000);
    return frames;
  }
  Texels texels() { return contents<glm::uvec4>(store_->texels()); }
  static bool lit(const Texels& all, std::uint32_t slot) { return all[slot].w == 1; }
  std::set<std::uint32_t> lit_slots() {
    const Texels all = texels();
    std::set<std::uint32_t> slots;
    for (std::uint32_t slot = 0; slot < shared::kMaxIslands; ++slot)
      if (lit(all, slot)) slots.insert(slot);
    return slots;
  }
  static int field(std::uint32_t word, int shift) {
    return static_cast<int>(word << (22 - shift)) >> 22;  // ten bits, two's complement
  }
  /// Where a chunk's table is; 0: outside the island's grid.
  static std::uint32_t table_of(const Texels& all, std::uint32_t slot, Place chunk) {
    const glm::uvec4 grid = all[slot];
    std::uint32_t index = 0;
    for (const int axis : {1, 0, 2}) {
      const int at = chunk[axis] - field(grid.x, 10 * axis);
      const int size = static_cast<int>(grid.y >> (8 * axis) & 255u);
      if (at < 0 || at >= size) return 0;
      index = index * static_cast<std::uint32_t>(size) + static_cast<std::uint32_t>(at);
    }
    return grid.z + index * shared::kIndirectTableTexels;
  }
  static std::uint32_t brick(const Texels& all, std::uint32_t table, std::size_t i) {
    return all[table + i / 4][static_cast<int>(i % 4)];
  }
  /// Texels of a chunk in the store that are not what the chunk says, by the layout of
  /// shaders/shared/indirect.h.
  static int wrong(const Texels& all, std::uint32_t slot, const IslandLight::FoundChunk& chunk) {
    const std::uint32_t table = table_of(all, slot, {chunk.at.x, chunk.at.y, chunk.at.z});
    if (!lit(all, slot) || table == 0) return 1;
    int count = 0;
    for (std::size_t i = 0; i < chunk.sky->table.size(); ++i) {
      const std::uint32_t has = chunk.sky->table[i], got = brick(all, table, i);
      count += (has == 0) != (got == 0);
      if (has == 0 || got == 0) continue;
      for (std::uint32_t k = 0; k < shared::kIndirectBrickTexels; ++k) {
        const glm::uvec4 want = chunk.sky->texels[(has - 1) * shared::kIndirectBrickTexels + k];
        const glm::uvec4 is = all[got + k];
        count += is.x != want.x || is.y != want.y || all[is.z] != chunk.sky->texels[want.z] ||
                 all[is.w] != chunk.sky->texels[want.w];
      }
    }
    return count;
  }
  static int wrong(const Texels& all, std::uint32_t slot, const IslandLight::Found& found) {
    int count = 0;
    for (const IslandLight::FoundChunk& chunk : found.chunks) count += wrong(all, slot, chunk);
    return count;
  }

  std::mt19937 random_{5};
  render::MemoryBudget budget_{kBudget};
  std::unique_ptr<gpu::Uploader> uploader_;
  std::unique_ptr<render::IndirectStore> store_;
  SkyLightFeed feed_;
};

TEST_F(LightOfManyIslands, SpreadOverFramesIsShownWhenAllOfItIsThere) {
  const Islands islands{{{7}, {3, 10.0}}};
  const IslandLight::Found old = island(7, -2, 4), now = island(7, -3, 6);
  feed_.add(old);
  EXPECT_EQ(settle(islands), 1);
  EXPECT_EQ(wrong(texels(), 3, old), 0);
  feed_.add(now);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(frame(islands, 1));
    EXPECT_EQ(wrong(texels(), 3, old), 0) << "frame " << i;
  }
  settle(islands, 1);
  EXPECT_EQ(wrong(texels(), 3, now), 0);
  EXPECT_TRUE(feed_.idle());
}

TEST_F(LightOfManyIslands, AnEditIsShownAtOnceAndWhatIsGoneIsDropped) {
  const Islands islands{{{7}, {3, 10.0}}};
  IslandLight::Found found = island(7, 0, 5);
  feed_.add(found);
  settle(islands);
  const std::uint64_t before = store_->bytes_in_use();
  for (IslandLight::FoundChunk& chunk : found.chunks) chunk.changed = false;
  const world::IVec3 gone = found.chunks[1].at;
  found.chunks[2] = {found.chunks[2].at, random_chunk(random_), true};
  found.chunks.erase(found.chunks.begin() + 1);
  feed_.add(found);
  EXPECT_FALSE(frame(islands, 1u << 20));
  const Texels all = texels();
  EXPECT_EQ(wrong(all, 3, found), 0);
  const std::uint32_t table = table_of(all, 3, {gone.x, gone.y, gone.z});
  ASSERT_NE(table, 0u);
  for (std::size_t i = 0; i < 512; ++i) ASSERT_EQ(brick(all, table, i), 0u);
  EXPECT_EQ(store_->bytes_in_use(), before - kChunkTexels * kTexelBytes);
}

// Finds arrive while the ones before are still being put; chunks that only an unfinished one
// changed must not be lost.
TEST_F(LightOfManyIslands, WhateverInterruptsTheLastFindIsShown) {
  for (int round = 0; round < 40; ++round) {
    const Islands islands{{{7}, {3, 10.0}}};
    IslandLight::Found found = island(7, 0, 4);
    for (int edit = 0; edit < 12; ++edit) {
      feed_.add(found);
      for (int i = static_cast<int>(random_() % 4); i > 0; --i) frame(islands, random_() % 40000);
      for (IslandLight::FoundChunk& chunk : found.chunks) {
        chunk.changed = random_() % 3 == 0;
        if (chunk.changed) chunk.sky = random_chunk(random_);
      }
      // Now and then the island's box changes, or back.
      if (random_() % 3 == 0 && found.chunks.size() > 3)
        found.chunks.pop_back();
      else if (random_() % 3 == 0)
        found.chunks.push_back(
            {{-1, 0, static_cast<int>(found.chunks.size())}, random_chunk(random_), true});
    }
    feed_.add(found);
    settle(islands, 1000);
    ASSERT_EQ(wrong(texels(), 3, found), 0) << "round " << round;
  }
}

/// Islands of four chunks, `count` of them, each farther than the one before.
Islands row_of_islands(std::uint32_t count) {
  Islands islands;
  for (std::uint32_t i = 0; i < count; ++i)
    islands[world::IslandLevel{100 + i}] = {i, 100.0 * (i + 1)};
  return islands;
}

TEST_F(LightOfManyIslands, WithoutRoomTheFarthestAreDark) {
  Islands islands = row_of_islands(12);
  const std::uint64_t room = store_->bytes_left();
  std::map<std::uint64_t, IslandLight::Found> found;
  // The farthest come first: they have to give way.
  for (std::uint32_t i = 12; i-- > 0;) {
    feed_.add(found[100 + i] = island(100 + i, 0, 4));
    settle(islands, 30000);
  }
  const std::uint64_t each = 4 * (kChunkTexels + shared::kIndirectTableTexels) * kTexelBytes;
  const std::size_t fit = room / each;
  ASSERT_GE(fit, 3u);
  ASSERT_LT(fit, 10u);
  std::set<std::uint32_t> nearest;
  for (std::uint32_t i = 0; i < fit; ++i) nearest.insert(i);
  EXPECT_EQ(lit_slots(), nearest);
  EXPECT_TRUE(feed_.refusal().has_value());
  EXPECT_FALSE(feed_.refusal().has_value());
  for (const std::uint32_t slot : nearest)
    EXPECT_EQ(wrong(texels(), slot, found.at(100 + slot)), 0) << slot;

  // The camera goes to the other end.
  for (auto& [id, near] : islands) near.distance = 1300.0 - near.distance;
  settle(islands, 30000);
  std::set<std::uint32_t> other;
  for (std::uint32_t i = 0; i < fit; ++i) other.insert(11 - i);
  EXPECT_EQ(lit_slots(), other);
  for (const std::uint32_t slot : other)
    EXPECT_EQ(wrong(texels(), slot, found.at(100 + slot)), 0) << slot;

  // One that leaves makes room for the nearest of the dark ones.
  feed_.remove(world::IslandLevel{111});
  store_->end_island(*uploader_, 11);
  islands.erase(world::IslandLevel{111});
  settle(islands);
  settle(islands);
  other.erase(11);
  other.insert(static_cast<std::uint32_t>(11 - fit));
  EXPECT_EQ(lit_slots(), other);
}

TEST_F(LightOfManyIslands, ComesToAnEndHoweverTheRoomIsCut) {
  std::uniform_int_distribution<std::uint32_t> any_size(kChunkTexels - 800, kChunkTexels + 3000);
  for (int round = 0; round < 60; ++round) {
    Islands islands;
    for (std::uint64_t id = 0; id < 8; ++id) {
      // Chunks that differ, so that what they leave behind fits few others.
      IslandLight::Found found{{id}, {}};
      for (int z = 0, chunks = 1 + static_cast<int>(random_() % 6); z < chunks; ++z)
        found.chunks.push_back({{0, 0, z}, random_chunk(random_, any_size(random_)), true});
      feed_.add(std::move(found));
      islands[{id}] = {static_cast<std::uint32_t>(id), static_cast<double>(random_() % 200)};
      if (id % 3 == 2) settle(islands);
    }
    ASSERT_LT(settle(islands), 1000) << round;
    for (std::uint64_t id = 0; id < 8; id += 1 + random_() % 2) {
      store_->end_island(*uploader_, static_cast<std::uint32_t>(id));
      feed_.remove({id});
    }
  }
}

TEST_F(LightOfManyIslands, ACameraThatGoesToAndFroMakesNoneBlink) {
  Islands islands = row_of_islands(12);
  for (const auto& [row, near] : islands) feed_.add(island(row.island, 0, 4));
  settle(islands);
  const std::set<std::uint32_t> before = lit_slots();
  for (int i = 0; i < 20; ++i) {
    // Neighbours change places.
    for (auto& [id, near] : islands) near.distance += (near.slot + i) % 2 == 0 ? 60.0 : -60.0;
    settle(islands);
    ASSERT_EQ(lit_slots(), before) << i;
  }
}

TEST_F(LightOfManyIslands, TakenBackItIsPutNearestFirst) {
  Islands islands = row_of_islands(12);
  // Lit by chance: the far half first.
  for (std::uint32_t i = 12; i-- > 6;) feed_.add(island(100 + i, 0, 4));
  settle(islands);
  for (auto& [id, near] : islands) near.distance = 1000.0 + near.slot;  // none gives way
  for (std::uint32_t i = 0; i < 6; ++i) feed_.add(island(100 + i, 0, 4));
  settle(islands);
  const std::size_t fit = lit_slots().size();
  EXPECT_FALSE(lit_slots().contains(0));
  feed_.take_back(*store_, *uploader_);
  frame({});
  settle(islands);
  std::set<std::uint32_t> nearest;
  for (std::uint32_t i = 0; i < fit; ++i) nearest.insert(i);
  EXPECT_EQ(lit_slots(), nearest);
}

}  // namespace
}  // namespace skerry::game
