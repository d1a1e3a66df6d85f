#include "game/view/island_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <latch>
#include <map>
#include <memory>

#include "game/view/light_chunk.h"
#include "world/islands/world.h"
#include "world/light/face_records.h"

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
    light_.start(streamer_, [] { return IslandLight::Distances{}; });
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

}  // namespace
}  // namespace skerry::game
