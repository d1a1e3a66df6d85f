#include "game/view/island_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <latch>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "game/view/light_chunk.h"
#include "game/view/materials.h"
#include "world/islands/world.h"
#include "world/light/base/face_records.h"

namespace skerry::game {
namespace {

using Sky = std::shared_ptr<const world::ChunkSky>;

/// The home island of seed 1 at coarse levels, with the light of the sky on it.
class LitIsland : public testing::Test {
 protected:
  LitIsland() {
    const world::StreamView view{world::moved(world_.origin(), {0.0, 60.0, 0.0})};
    streamer_.update(view, {.view_distance_blocks = 320.0, .detail_distance_blocks = 8.0});
    streamer_.wait_until_complete();
    while (!streamer_.complete())
      for (world::ReadySection& ready : streamer_.poll(~std::size_t{0}).ready)
        if (!ready.key.far) sections_.push_back(std::move(ready));
    for (const world::ReadySection& ready : sections_)
      light_.add(ready.key, light_chunk_of(ready, {}, {}));
    light_.start(
        streamer_, [] { return IslandLight::NearIslands{}; }, false);
    light_.wait();
    light_.poll_reach();
    poll();
  }
  /// @return how many chunks were said to have changed.
  int poll() {
    int changed = 0;
    for (const IslandLight::Found& found : light_.poll())
      for (const IslandLight::FoundChunk& chunk : found.chunks) {
        said_[{found.row.island, chunk.at, found.row.level}] = chunk.sky;
        changed += chunk.changed;
      }
    return changed;
  }
  /// All that can close a section.
  static std::vector<shared::Quad> seams_of(const world::ReadySection& section) {
    std::vector<shared::Quad> all;
    for (const auto& face : section.seams) all.insert(all.end(), face.begin(), face.end());
    return all;
  }
  static world::ChunkSky closed(const world::ChunkSky& sky, const std::vector<shared::Quad>& with) {
    return world::with_faces(sky, world::lit_faces(sky, with));
  }
  /// Sections with light that becomes another as they are closed.
  std::vector<const world::ReadySection*> to_close() const {
    std::vector<const world::ReadySection*> out;
    for (const world::ReadySection& section : sections_)
      if (const auto sky = said_.find(section.key); sky != said_.end())
        if (closed(*sky->second, seams_of(section)) != *sky->second) out.push_back(&section);
    return out;
  }

  world::World world_{{.seed = 1, .island_limit = 1}};
  Jobs jobs_{2};
  world::Streamer streamer_{world_, jobs_, world::StreamOf::kMeshesAndOccupancy};
  WorkerThreads threads_{1};
  IslandLight light_{threads_, IslandLight::Finds::kSky};
  std::vector<world::ReadySection> sections_;
  std::map<world::SectionKey, Sky> said_;  // as poll() last did
};

TEST_F(LitIsland, FacesThatCloseAChunkGetTheLightOfFacesNextToThem) {
  ASSERT_TRUE(light_.settled());
  const auto sections = to_close();
  ASSERT_GE(sections.size(), 2u);
  const std::map<world::SectionKey, Sky> before = said_;
  for (const world::ReadySection* section : sections)
    light_.close(section->key, seams_of(*section));
  EXPECT_FALSE(light_.settled());
  light_.wait();
  EXPECT_EQ(poll(), static_cast<int>(sections.size()));
  EXPECT_TRUE(light_.settled());
  for (const world::ReadySection* section : sections)
    EXPECT_EQ(*said_.at(section->key), closed(*before.at(section->key), seams_of(*section)));
}

TEST_F(LitIsland, WhereNoThreadIsFreeAChunkACallIsClosed) {
  const auto sections = to_close();
  ASSERT_GE(sections.size(), 6u);
  const std::map<world::SectionKey, Sky> before = said_;
  std::latch busy(1), free(1);
  threads_.submit([&] {
    busy.count_down();
    free.wait();
  });
  busy.wait();
  for (const world::ReadySection* section : sections)
    light_.close(section->key, seams_of(*section));
  int calls = 0, changed = 0, most = 0;
  for (; light_.guesses() && calls < 1000; ++calls) {
    const int now = poll();
    changed += now;
    most = std::max(most, now);
  }
  free.count_down();
  EXPECT_EQ(changed, static_cast<int>(sections.size()));
  EXPECT_LE(most, 1);
  EXPECT_LE(calls, 8 + static_cast<int>(sections.size()));
  for (const world::ReadySection* section : sections)
    EXPECT_EQ(*said_.at(section->key), closed(*before.at(section->key), seams_of(*section)));
}

TEST_F(LitIsland, TheLastOfTwoClosingsCounts) {
  const world::ReadySection& section = *to_close().front();
  const Sky before = said_.at(section.key);
  std::vector<shared::Quad> all = seams_of(section);
  light_.close(section.key, {all.begin(), all.begin() + 1});
  light_.close(section.key, all);
  light_.wait();
  poll();
  EXPECT_EQ(*said_.at(section.key), closed(*before, all));
}

/// The same island in full detail, with the light that its faces reflect.
class KeyedIsland : public testing::Test {
 protected:
  KeyedIsland() {
    const world::StreamView view{world::moved(world_.origin(), {0.0, 60.0, 0.0})};
    streamer_.update(view, {.view_distance_blocks = 320.0, .detail_distance_blocks = 320.0});
    streamer_.wait_until_complete();
    while (!streamer_.complete())
      for (world::ReadySection& ready : streamer_.poll(~std::size_t{0}).ready)
        if (!ready.key.far && ready.key.level == 0) sections_.push_back(std::move(ready));
    for (const world::ReadySection& ready : sections_)
      chunks_[ready.key.chunk] =
          std::make_shared<const world::LightChunk>(light_chunk_of(ready, {}, {}));
    row_ = sections_.front().key.row();
  }
  void fill(IslandLight& light) const {
    for (const world::ReadySection& ready : sections_)
      light.add(ready.key, light_chunk_of(ready, {}, {}));
  }
  IslandLight::Found look(IslandLight& light, std::optional<IslandLight::Key> key) {
    light.start(
        streamer_,
        [&] {
          return IslandLight::NearIslands{{row_, {.distance = 0.0, .keyed = true, .key = key}}};
        },
        true);
    light.wait();
    light.poll_reach();
    std::vector<IslandLight::Found> found = light.poll();
    EXPECT_EQ(found.size(), 1u);
    return found.empty() ? IslandLight::Found{} : std::move(found.front());
  }
  /// Whether that is what a look from nothing finds.
  bool is_right(const IslandLight::Found& found, const world::KeyDirections& keys) const {
    world::SkyTransfer right(chunks_, albedo_table(), world::BounceLight::kBounces, 0, keys);
    for (int octant = 0; octant < world::kOctants; ++octant) right.look(octant);
    right.spread_lamps();
    for (int step = 0; step < world::BounceLight::kSteps; ++step)
      for (int part = 0; part < world::BounceLight::kParts; ++part)
        right.follow_bounces(step, part);
    right.make_faces();
    return found.keys == keys && found.chunks.size() == right.faces().size() &&
           std::ranges::all_of(found.chunks, [&](const IslandLight::FoundChunk& chunk) {
             return *chunk.sky == *right.faces().at(chunk.at);
           });
  }

  world::World world_{{.seed = 1, .island_limit = 1}};
  Jobs jobs_{2};
  world::Streamer streamer_{world_, jobs_, world::StreamOf::kMeshesAndOccupancy};
  WorkerThreads threads_{2};
  std::vector<world::ReadySection> sections_;
  world::LightChunks chunks_;
  world::IslandLevel row_;
  const glm::vec3 morning_{0.8f, 0.6f, 0.0f}, noon_{0.0f, 0.8f, 0.6f};
};

TEST_F(KeyedIsland, IsFollowedFromWhereItIsAskedTo) {
  IslandLight light(threads_, IslandLight::Finds::kBounces);
  fill(light);
  EXPECT_TRUE(is_right(look(light, {}), {}));
  EXPECT_TRUE(is_right(look(light, {{0, morning_}}), {morning_, std::nullopt}));
  EXPECT_TRUE(is_right(look(light, {{1, noon_}}), {morning_, noon_}));
}

// What is cached depends on the direction alone, not on what was shown before.
TEST_F(KeyedIsland, WithACacheItIsFoundOncePerDirection) {
  world::LightCache cache(std::size_t{1} << 30);
  IslandLight light(threads_, IslandLight::Finds::kBounces, &cache);
  fill(light);
  EXPECT_TRUE(is_right(look(light, {{0, morning_}}), {morning_, std::nullopt}));
  EXPECT_TRUE(is_right(look(light, {{1, noon_}}), {noon_, std::nullopt}));
  EXPECT_EQ(cache.stats().found, 0u);
  EXPECT_TRUE(is_right(look(light, {{1, morning_}}), {morning_, std::nullopt}));
  EXPECT_EQ(cache.stats().found, 1u);
}

}  // namespace
}  // namespace skerry::game
