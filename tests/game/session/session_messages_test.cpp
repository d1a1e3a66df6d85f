// Whether a client that has nothing but the messages has the same world.
#include <gtest/gtest.h>

#include <algorithm>

#include "game/worlds/open_session.h"
#include "tests/folder.h"
#include "tests/game/session/seat.h"
#include "tests/world/made_islands.h"
#include "world/islands/stored_voxels.h"
#include "world/store/world_file.h"
#include "world/voxel/hash.h"

namespace skerry::game {
namespace {

using world::IVec3;
using world::World;

/// Makes a world of its own from what it is told.
class RemoteClient {
 public:
  RemoteClient(const std::shared_ptr<Session>& session, const std::string& name)
      : session_(session, std::nullopt) {
    session_.send(Join{name});
    session_.attend();
    hear();
  }

  void hear() {
    for (const Answer& answer : session_.receive()) std::visit(*this, answer);
  }
  World& world() { return *world_; }
  double time_s() const { return time_s_; }
  std::size_t pieces() const { return pieces_; }

  void operator()(const Joined& joined) {
    world_ = std::make_unique<World>(joined.world.desc);
    for (const world::ChunkName& name : joined.changed)
      session_.send(ChunkWanted{name.island, name.chunk});
  }
  void operator()(const TimeIs& time) { time_s_ = time.world_time_s; }
  void operator()(const IslandIs& island) {
    if (island.added) {
      const std::map<IVec3, world::Chunk> nothing;
      EXPECT_TRUE(world_->add_island(island.spec, std::make_shared<world::StoredVoxels>(nothing)));
    } else {
      EXPECT_TRUE(world_->meet(island.spec.id, island.spec.origin));
    }
    pieces_ += island.broken_off != 0;
  }
  void operator()(const ChunkChanges& changes) {
    EXPECT_TRUE(world_->set_blocks(changes.island, changes.chunk, changes.edits));
  }
  void operator()(const EditAnswer& answer) {
    if (answer.verdict != EditVerdict::kDone) return;
    EXPECT_TRUE(world_->set_block(answer.edit.island, answer.edit.voxel, answer.edit.block));
  }
  void operator()(const IslandsMoved& moved) {
    for (const world::MovingIsland& move : moved.moves)
      EXPECT_TRUE(world_->move_island(move.island, move.state.tick, move.state.pose));
  }
  void operator()(const Notice& notice) { ADD_FAILURE() << notice.text; }

 private:
  Seat session_;
  std::unique_ptr<World> world_;
  double time_s_ = -1.0;
  std::size_t pieces_ = 0;
};

std::vector<world::BlockId> blocks_of(World& world, std::uint64_t island, IVec3 chunk) {
  std::vector<world::BlockId> blocks(world::kChunkVoxels);
  world.chunk_now(island, chunk).unpack(blocks);
  return blocks;
}

/// Voxels of all islands that are not as a seed makes them, and poses of the last third of a
/// second.
void expect_same(World& told, World& real, double time_s) {
  const std::vector<std::uint64_t> islands = real.changed_islands();
  ASSERT_EQ(told.changed_islands(), islands);
  for (const std::uint64_t id : islands) {
    for (World* world : {&told, &real})
      for (const IVec3& chunk : real.is_added(id) ? world->chunks(id, 0) : world->edited_chunks(id))
        ASSERT_EQ(blocks_of(told, id, chunk), blocks_of(real, id, chunk)) << id;
    for (double at_s = time_s - 0.33; at_s <= time_s; at_s += 0.007) {
      const auto pose = told.pose(id, at_s), expected = real.pose(id, at_s);
      ASSERT_TRUE(pose && expected);
      ASSERT_EQ(pose->origin, expected->origin) << id;
      ASSERT_EQ(pose->rotation, expected->rotation) << id;
    }
  }
}

/// Plays at random on the islands that there are: digs, builds, steers.
class Vandal {
 public:
  Vandal(const std::shared_ptr<Session>& session, std::uint64_t seed)
      : session_(session, Join{"vandal " + std::to_string(seed), true}), rng_(seed) {}

  void act(std::uint64_t island, IVec3 low, IVec3 high) {
    IVec3 voxel;
    for (int look = 0; look < 20; ++look) {
      voxel = {rng_.in(low.x, high.x), rng_.in(low.y, high.y), rng_.in(low.z, high.z)};
      session_.world()->ensure_chunk(island, world::chunk_of(voxel));
      if (world::is_solid(*session_.world()->block_at(island, voxel))) break;
    }
    SavedPlay play;
    const world::Pose pose = *session_.world()->pose(island, time_s_);
    play.eye.position =
        world::moved(pose.origin, pose.rotation * glm::dvec3{voxel.x, voxel.y + 2.0, voxel.z});
    play.player.island = island;
    session_.send(PlayerMoved{play});
    session_.send(Edit{island, voxel, world::kAir});
    voxel.y += rng_.in(0, 2);
    session_.send(Edit{island, voxel, world::block::kGlass});
    if (rng_.in(0, 9) == 0)
      session_.send(Steer{island,
                          {rng_.in(-1, 1) * 0.7, rng_.in(-1, 1) * 0.2, rng_.in(-1, 1) * 0.7},
                          rng_.in(-2, 2) * 0.5});
    const double passed_s = rng_.in(1, 90) / 1000.0;
    session_.advance(passed_s);
    time_s_ += passed_s;
  }
  void begin_at(double time_s) { time_s_ = time_s; }
  Seat& seat() { return session_; }
  double time_s() const { return time_s_; }

 private:
  Seat session_;
  world::Rng rng_;
  double time_s_ = 0.0;
};

struct Tower {
  Folder folder;
  std::filesystem::path path = folder / "tower.skerry";
  static constexpr std::uint64_t kIsland = 77;

  /// Floors on thin pillars: digging breaks it again and again.
  Tower() {
    std::vector<IVec3> voxels;
    for (int floor = 0; floor < 8; ++floor) {
      for (const IVec3& v : world::voxels_in({-1, 4 * floor, -1}, {2, 4 * floor + 1, 2}))
        voxels.push_back(v);
      for (const IVec3& v : world::voxels_in({0, 4 * floor + 1, 0}, {1, 4 * floor + 4, 1}))
        voxels.push_back(v);
    }
    world::WorldInfo info{"Tower", "9", {}};
    info.desc = world::empty_world();
    auto file = world::WorldFile::create(path, info);
    EXPECT_TRUE(file);
    auto transaction = (*file)->begin();
    world::IslandSpec spec;
    spec.id = kIsland;
    spec.origin = world::blocks(-300.0, 20.0, 7.5);
    transaction.put_island({spec, true, {}});
    for (const auto& [at, chunk] : world::chunks_from(voxels, world::block::kStone))
      transaction.put_chunk(kIsland, at, chunk);
    EXPECT_TRUE(transaction.commit());
  }
  std::shared_ptr<Session> open() const {
    auto session = Session::open(path);
    EXPECT_TRUE(session);
    return session ? *std::move(session) : nullptr;
  }
};

TEST(SessionMessages, AloneMakeTheSameIslandsHoweverTheyBreakAndFly) {
  const Tower tower;
  std::size_t pieces = 0;
  double time_s = 0.0;
  for (std::uint64_t play = 0; play < 3; ++play) {
    const auto session = tower.open();
    ASSERT_TRUE(session);
    // The second and the third join a world with a history, and one joins when much has happened.
    RemoteClient client(session, "far away");
    std::optional<RemoteClient> late;
    Vandal vandal(session, 100 + play);
    vandal.begin_at(client.time_s());
    EXPECT_EQ(client.time_s(), time_s);
    for (int i = 0; i < 200; ++i) {
      const std::vector<std::uint64_t> islands = session->world()->added_islands();
      const std::uint64_t island = islands[static_cast<std::size_t>(i) % islands.size()];
      const world::IslandSpec spec = *session->world()->island(island);
      vandal.act(island, spec.box_min, {spec.box_max.x, spec.box_max.y, spec.box_max.z});
      if (i % 7 == 0) client.hear();
      if (i == 120) late.emplace(session, "late");
      // Waits for what breaks.
      ASSERT_TRUE(i % 50 != 49 || session->save());
    }
    SavedPlay left;
    left.world_time_s = vandal.time_s();
    vandal.seat().send(PlayerMoved{left});
    session->attend();
    for (RemoteClient* remote : {&client, &*late}) {
      remote->hear();
      // What it asked for when it joined.
      session->attend();
      remote->hear();
      EXPECT_EQ(remote->time_s(), vandal.time_s());
      expect_same(remote->world(), *session->world(), vandal.time_s());
    }
    pieces += client.pieces();
    time_s = vandal.time_s();
  }
  EXPECT_GT(pieces, 10u);
}

TEST(SessionMessages, AloneMakeTheSameIslandOfASeed) {
  SceneOptions options;
  options.seed_text = "4";
  options.settings.world_islands = 3;
  options.settings.world_offset = {1'000'000, 0, -5};
  options.settings.world_time_s = 12.5;
  auto opened = open_session(options);
  ASSERT_TRUE(opened);
  const std::shared_ptr<Session> shared = *std::move(opened);
  Session& session = *shared;
  RemoteClient client(shared, "far away");
  EXPECT_EQ(client.time_s(), 12.5);
  EXPECT_TRUE(client.world().changed_islands().empty());
  const world::Spawn spawn = session.world()->spawn();
  // Both come near and generate it, each for itself.
  for (World* world : {session.world().get(), &client.world()})
    ASSERT_FALSE(world->islands_near(spawn.feet, 0.0, 0.0).empty());
  const world::Pose pose = world::pose_at(*session.world()->island(spawn.island), 0.0);
  const glm::dvec3 feet =
      glm::conjugate(pose.rotation) * world::difference_blocks(spawn.feet, pose.origin);
  const IVec3 ground{static_cast<int>(feet.x), static_cast<int>(feet.y), static_cast<int>(feet.z)};
  Vandal vandal(shared, 1);
  vandal.begin_at(12.5);
  for (int i = 0; i < 60; ++i)
    vandal.act(spawn.island, {ground.x - 3, ground.y - 4, ground.z - 3},
               {ground.x + 3, ground.y + 2, ground.z + 3});
  ASSERT_TRUE(session.save());
  session.advance(0.1);
  client.hear();
  EXPECT_EQ(client.time_s(), vandal.time_s() + 0.1);
  ASSERT_FALSE(session.world()->edited_chunks(spawn.island).empty());
  expect_same(client.world(), *session.world(), client.time_s());
}

}  // namespace
}  // namespace skerry::game
