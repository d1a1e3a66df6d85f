#include "game/session/session.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <thread>

#include "engine/core/clock.h"
#include "game/worlds/open_session.h"
#include "tests/folder.h"
#include "tests/game/session/seat.h"
#include "tests/world/made_islands.h"
#include "world/motion/motion.h"
#include "world/store/database.h"
#include "world/store/world_file.h"

namespace skerry::game {
namespace {

namespace fs = std::filesystem;
using world::IVec3;

/// A file with one island of our own: a plate, a neck, a smaller plate above.
struct Saved {
  Folder folder;
  fs::path path = folder / "w.skerry";
  std::uint64_t island = 77;
  IVec3 neck{0, 5, 0};

  Saved() {
    std::vector<IVec3> voxels = world::voxels_in({-8, 0, -8}, {9, 3, 9});
    for (const IVec3& v : world::voxels_in({0, 3, 0}, {1, 8, 1})) voxels.push_back(v);
    for (const IVec3& v : world::voxels_in({-3, 8, -3}, {4, 10, 4})) voxels.push_back(v);
    world::WorldInfo info{"Plates", "9", {}};
    info.desc.seed = 9;
    info.desc.generated = false;
    auto file = world::WorldFile::create(path, info);
    EXPECT_TRUE(file);
    auto transaction = (*file)->begin();
    world::IslandSpec spec;
    spec.id = island;
    spec.origin = world::blocks(100.0, 0.0, 0.0);
    transaction.put_island({spec, true, {}});
    for (const auto& [at, chunk] : world::chunks_from(voxels, world::block::kStone))
      transaction.put_chunk(island, at, chunk);
    EXPECT_TRUE(transaction.commit());
  }

  std::unique_ptr<Seat> open(const std::optional<Join>& join = Join{}) const {
    auto session = Session::open(path);
    EXPECT_TRUE(session) << session.error().message;
    if (!session) return nullptr;
    for (const IVec3& chunk : (*session)->world()->chunks(island, 0))
      (*session)->world()->ensure_chunk(island, chunk);
    return std::make_unique<Seat>(*std::move(session), join);
  }
};

SavedPlay at(const glm::dvec3& blocks) {
  SavedPlay play;
  play.eye.position = world::blocks(blocks.x, blocks.y, blocks.z);
  play.player.feet = world::blocks(blocks.x, blocks.y - 1.62, blocks.z);
  play.player.velocity = {0.1, -0.25, 1.0 / 3.0};
  play.player.yaw_deg = 12.34;
  play.player.island = 77;
  play.player.lattice = {1, 2, 3};
  play.time_of_day_s = 4321.0;
  play.world_time_s = 17.0 + 1.0 / 3.0;
  play.player.safe = Footing{77, {-4, 5, 1LL << 40}};
  play.hotbar.blocks[3] = world::block::kObsidian;
  play.hotbar.blocks[8] = world::kAir;
  play.hotbar.selected = 8;
  play.day_stands = true;
  return play;
}

/// Of all kinds of answers that are waiting, those of one.
template <class Kind>
std::vector<Kind> heard(Seat& session) {
  std::vector<Kind> found;
  for (const Answer& answer : session.receive())
    if (const auto* one = std::get_if<Kind>(&answer)) found.push_back(*one);
  return found;
}

EditVerdict verdict_of(Seat& session, std::uint64_t island, IVec3 voxel, world::BlockId block) {
  session.send(Edit{island, voxel, block});
  session.attend();
  return heard<EditAnswer>(session).back().verdict;
}

std::optional<SavedPlay> left_in(const Seat& session) {
  return session.joined()->play;
}

/// As whoever joins now is told.
std::optional<world::MotionState> motion_of(Seat& session, std::uint64_t island) {
  Seat observer(session.session(), std::nullopt);
  observer.send(Join{"observer"});
  observer.attend();
  std::optional<world::MotionState> found;
  for (const IslandsMoved& moved : heard<IslandsMoved>(observer))
    for (const world::MovingIsland& move : moved.moves)
      if (move.island == island) found = move.state;
  return found;
}

TEST(Session, ChecksReachKindAndRate) {
  const Saved saved;
  const auto session = saved.open();
  ASSERT_TRUE(session);
  const std::uint64_t id = saved.island;
  using V = EditVerdict;
  const world::BlockId lamp = world::block::kLamp;
  EXPECT_EQ(verdict_of(*session, id, {1, 3, 1}, lamp), V::kTooFar) << "nobody is there yet";
  session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  session->advance(0.2);
  EXPECT_EQ(verdict_of(*session, id, {1, 3, 1}, lamp), V::kDone);
  EXPECT_EQ(verdict_of(*session, id, {1, 3, 1}, world::block::kStone), V::kOccupied);
  EXPECT_EQ(verdict_of(*session, id, {2, 3, 1}, world::kAir), V::kEmpty);
  EXPECT_EQ(verdict_of(*session, id, {2, 3, 1}, world::block::kBuiltInCount), V::kNoSuchBlock);
  EXPECT_EQ(verdict_of(*session, 5, {2, 3, 1}, lamp), V::kNoSuchIsland);
  EXPECT_EQ(verdict_of(*session, id, {1, 14, 1}, lamp), V::kTooFar);
  EXPECT_EQ(verdict_of(*session, id, {1, INT32_MIN, 1}, lamp), V::kTooFar);
  // 8 blocks and not more, to the voxel's nearest point: from x = 1.5 to x = 9.
  EXPECT_EQ(verdict_of(*session, id, {9, 5, 1}, lamp), V::kDone);
  EXPECT_EQ(verdict_of(*session, id, {10, 5, 1}, lamp), V::kTooFar);
  int done = 0;
  for (int i = 0; i < 200; ++i)
    done += verdict_of(*session, id, {2, 4, 1}, i % 2 == 0 ? lamp : world::kAir) == V::kDone;
  EXPECT_EQ(done, static_cast<int>(kEditBurst) - 2);
  EXPECT_EQ(verdict_of(*session, id, {3, 4, 1}, lamp), V::kTooFast);
  session->advance(1.0);
  EXPECT_EQ(verdict_of(*session, id, {3, 4, 1}, lamp), V::kDone);
}

TEST(Session, AnswersMessagesInOrder) {
  const Saved saved;
  const auto session = saved.open(std::nullopt);
  session->send(Join{"me"});
  session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  session->send(Edit{saved.island, {1, 3, 1}, world::block::kLamp});
  session->send(ChunkWanted{saved.island, {0, 0, 0}});
  session->advance(1.0);
  const std::vector<Answer> answers = session->receive();
  ASSERT_EQ(answers.size(), 7u);
  const Joined& joined = std::get<Joined>(answers[0]);
  EXPECT_EQ(joined.world.name, "Plates");
  EXPECT_FALSE(joined.play);
  EXPECT_FALSE(joined.read_only);
  EXPECT_EQ(joined.changed.size(), 4u);  // the plate lies about the middle
  EXPECT_EQ(std::get<TimeIs>(answers[1]).world_time_s, 0.0);
  EXPECT_EQ(std::get<IslandIs>(answers[2]).spec.id, saved.island);
  EXPECT_TRUE(std::get<IslandIs>(answers[2]).added);
  EXPECT_TRUE(std::get<IslandsMoved>(answers[3]).moves.empty());
  EXPECT_EQ(std::get<EditAnswer>(answers[4]).verdict, EditVerdict::kDone);
  const ChunkChanges& changes = std::get<ChunkChanges>(answers[5]);
  // A ninth of each chunk's share of plate, neck and upper plate, and the lamp.
  EXPECT_EQ(changes.edits.size(), 9u * 9 * 3 + 5 + 4 * 4 * 2 + 1);
  EXPECT_EQ(std::get<TimeIs>(answers[6]).world_time_s, 1.0);
  EXPECT_TRUE(session->receive().empty());
}

TEST(Session, TellsNothingBeforeSomeoneJoins) {
  const Saved saved;
  const auto session = saved.open(std::nullopt);
  session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  session->send(Edit{saved.island, {1, 3, 1}, world::block::kLamp});
  session->send(Steer{saved.island, {0.0, 0.0, 1.0}, 0.0});
  session->advance(1.0);
  EXPECT_TRUE(session->receive().empty());
  EXPECT_EQ(session->world()->block_at(saved.island, {1, 3, 1}), world::kAir);
  EXPECT_FALSE(motion_of(*session, saved.island));
}

TEST(Session, EverythingComesBackExactly) {
  const Saved saved;
  SavedPlay play = at({101.5, 5.0, 1.5});
  std::optional<world::MotionState> moving;
  {
    const auto session = saved.open();
    session->send(PlayerMoved{play});
    session->send(Steer{saved.island, {0.3, 0.1, 0.9}, 0.5});
    session->advance(0.1);
    EXPECT_EQ(verdict_of(*session, saved.island, {1, 3, 1}, world::block::kTorch),
              EditVerdict::kDone);
    // The shape comes from the worker; then it flies.
    for (int i = 0; i < 400; ++i) {
      session->advance(0.01);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    play.world_time_s = 4.1;
    session->send(PlayerMoved{play});
    moving = motion_of(*session, saved.island);
    ASSERT_TRUE(moving);
    EXPECT_GT(moving->velocity.z, 0.5);
    ASSERT_TRUE(session->save());
    auto other = world::WorldFile::open(saved.path, world::WorldFile::Mode::kWrite);
    ASSERT_FALSE(other) << "two sessions write one world";
  }
  const auto session = saved.open();
  EXPECT_EQ(left_in(*session), play);
  EXPECT_EQ(session->world()->block_at(saved.island, {1, 3, 1}), world::block::kTorch);
  const auto found = motion_of(*session, saved.island);
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, *moving);
}

TEST(Session, WhatWasSaidLastIsSavedAndDecidesWhatIsInReach) {
  const Saved saved;
  {
    const auto session = saved.open();
    session->send(PlayerMoved{at({150.0, 5.0, 1.5})});
    session->advance(0.2);
    const auto verdict = [&] {
      return verdict_of(*session, saved.island, {1, 3, 1}, world::block::kLamp);
    };
    EXPECT_EQ(verdict(), EditVerdict::kTooFar);
    session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
    EXPECT_EQ(verdict(), EditVerdict::kDone);
    session->send(PlayerMoved{at({102.5, 5.0, 1.5})});
    ASSERT_TRUE(session->save());
    auto read = world::WorldFile::open(saved.path, world::WorldFile::Mode::kRead);
    ASSERT_TRUE(read);
    EXPECT_EQ(saved_play(**read), at({102.5, 5.0, 1.5}));
  }
}

TEST(Session, SavesWhileTheWorldStandsStill) {
  const Saved saved;
  const auto session = saved.open();
  session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  session->save_next();
  session->rest();
  const auto written = [&] {
    const auto read = world::WorldFile::open(saved.path, world::WorldFile::Mode::kRead);
    return read && saved_play(**read) == at({101.5, 5.0, 1.5});
  };
  for (int i = 0; i < 500 && !written(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(written());
}

TEST(Session, NonsenseInTheHandsLeavesThePlaceAlone) {
  const Saved saved;
  const SavedPlay play = at({101.5, 5.0, 1.5});
  {
    auto file = world::WorldFile::open(saved.path, world::WorldFile::Mode::kWrite);
    ASSERT_TRUE(file);
    auto transaction = (*file)->begin();
    put_plays(transaction, {{"", play}});
    transaction.put_value("habits", std::vector<std::byte>(11, std::byte{255}));
    ASSERT_TRUE(transaction.commit());
  }
  auto file = world::WorldFile::open(saved.path, world::WorldFile::Mode::kRead);
  ASSERT_TRUE(file);
  SavedPlay expected = play;
  expected.hotbar = {};
  expected.day_stands = false;
  expected.player.safe.reset();
  EXPECT_EQ(saved_play(**file), expected);
  EXPECT_EQ((*file)->damage().size(), 1u);
}

/// Solid blocks of all islands together.
std::size_t all_blocks(world::World& world) {
  std::size_t count = 0;
  for (const std::uint64_t id : world.added_islands())
    for (const IVec3& at : world.chunks(id, 0)) {
      const world::Chunk chunk = world.chunk_now(id, at);
      for (std::size_t i = 0; i < world::kChunkVoxels; ++i) count += chunk.at(i) != world::kAir;
    }
  return count;
}

TEST(Session, CuttingANeckMakesAnIslandThatIsSaved) {
  const Saved saved;
  std::size_t blocks = 0;
  std::uint64_t piece = 0;
  {
    const auto session = saved.open(Join{"me", true});
    session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
    session->advance(1.0);
    blocks = all_blocks(*session->world());
    ASSERT_EQ(verdict_of(*session, saved.island, saved.neck, world::kAir), EditVerdict::kDone);
    ASSERT_TRUE(session->save());
    bool sent = false;
    for (const Answer& answer : session->receive()) {
      sent |= std::holds_alternative<ChunkChanges>(answer);
      if (const auto* added = std::get_if<IslandIs>(&answer)) {
        piece = added->spec.id;
        EXPECT_TRUE(added->added);
        EXPECT_EQ(added->broken_off, saved.island);
        EXPECT_EQ(added->blocks, 2u + 7 * 7 * 2);
      }
    }
    EXPECT_FALSE(sent) << "the client reads the session's voxels";
    ASSERT_NE(piece, 0u);
    EXPECT_EQ(session->world()->added_islands().size(), 2u);
    EXPECT_EQ(all_blocks(*session->world()), blocks - 1);
  }
  const auto session = saved.open();
  EXPECT_EQ(session->world()->added_islands().size(), 2u);
  EXPECT_EQ(all_blocks(*session->world()), blocks - 1);
  EXPECT_TRUE(session->world()->island(piece));
  EXPECT_TRUE(session->receive().empty()) << "nothing is damaged";
}

TEST(Session, APartThatIsCutOffDriftsAwayUntilTheAirStopsIt) {
  const Saved saved;
  const auto session = saved.open(Join{"me", true});
  session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  double now_s = 1.0;
  session->advance(now_s);
  ASSERT_EQ(verdict_of(*session, saved.island, saved.neck, world::kAir), EditVerdict::kDone);
  ASSERT_TRUE(session->save());
  std::uint64_t piece = 0;
  for (const Answer& answer : session->receive())
    if (const auto* added = std::get_if<IslandIs>(&answer)) piece = added->spec.id;
  ASSERT_NE(piece, 0u);
  const auto apart = [&] {
    const auto old = session->world()->pose(saved.island, now_s);
    const auto now = session->world()->pose(piece, now_s);
    return glm::length(world::difference_blocks(now->origin, old->origin));
  };
  const double at_first = apart();
  const auto advance = [&](double seconds) {
    for (double s = 0.0; s < seconds; s += 0.25, now_s += 0.25) {
      session->advance(0.25);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));  // shapes come from another thread
    }
  };
  advance(5.0);
  EXPECT_GT(std::abs(apart() - at_first), 0.8);
  advance(60.0);
  EXPECT_LT(std::abs(apart() - at_first), 0.4 / world::kAirDrag + 0.1);
}

TEST(Session, AFullDiskIsToldAndLosesNothing) {
  const Saved saved;
  {
    const auto session = saved.open();
    session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
    session->advance(1.0);
    ASSERT_EQ(verdict_of(*session, saved.island, {1, 3, 1}, world::block::kLamp),
              EditVerdict::kDone);
    const auto before = std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit none{100, limit.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &none);
    const Result<void> failed = session->save();
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, before);
    ASSERT_FALSE(failed);
    EXPECT_NE(failed.error().message.find("cannot save"), std::string::npos);
    EXPECT_EQ(session->world()->block_at(saved.island, {1, 3, 1}), world::block::kLamp);
  }
  EXPECT_EQ(saved.open()->world()->block_at(saved.island, {1, 3, 1}), world::block::kLamp);
}

TEST(Session, AWorldOfASeedIsSavedNowhere) {
  SceneOptions options;
  options.seed_text = "4";
  const auto session = open_session(options);
  ASSERT_TRUE(session);
  EXPECT_TRUE((*session)->save());
  EXPECT_EQ((*session)->world()->seed(), 4u);
}

/// Chunk changes that were told, as blocks by voxel of the chunk.
std::map<std::uint32_t, world::BlockId> told_of(Seat& session, std::uint64_t island, IVec3 chunk) {
  std::map<std::uint32_t, world::BlockId> blocks;
  for (const ChunkChanges& changes : heard<ChunkChanges>(session))
    if (changes.island == island && changes.chunk == chunk)
      for (const world::VoxelEdit& edit : changes.edits)
        blocks.insert_or_assign(edit.index, edit.block);
  return blocks;
}

TEST(Session, AnEditReachesEveryClientOnce) {
  const Saved saved;
  const auto anna = saved.open(Join{"Anna"});
  Seat boris(anna->session(), Join{"Boris"}), here(anna->session(), Join{"here", true});
  Seat stranger(anna->session(), std::nullopt);
  anna->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  anna->attend();
  ASSERT_EQ(verdict_of(*anna, saved.island, {1, 3, 1}, world::block::kLamp), EditVerdict::kDone);
  const auto index = static_cast<std::uint32_t>(world::index_in_chunk({1, 3, 1}));
  const std::map<std::uint32_t, world::BlockId> lamp{{index, world::block::kLamp}};
  EXPECT_EQ(told_of(boris, saved.island, {0, 0, 0}), lamp);
  EXPECT_TRUE(told_of(*anna, saved.island, {0, 0, 0}).empty()) << "she made it";
  EXPECT_TRUE(told_of(here, saved.island, {0, 0, 0}).empty()) << "it reads the session's voxels";
  EXPECT_TRUE(stranger.receive().empty());
  // What is refused reaches nobody.
  ASSERT_NE(verdict_of(*anna, saved.island, {1, 3, 1}, world::block::kStone), EditVerdict::kDone);
  EXPECT_TRUE(boris.receive().empty());
}

TEST(Session, ClientsHaveReachesAndRatesOfTheirOwn) {
  const Saved saved;
  const auto anna = saved.open(Join{"Anna"});
  Seat boris(anna->session(), Join{"Boris"});
  anna->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  boris.send(PlayerMoved{at({150.0, 5.0, 1.5})});
  const auto lamp_by = [&](Seat& who, std::int32_t x) {
    return verdict_of(who, saved.island, {x, 3, 1}, world::block::kLamp);
  };
  EXPECT_EQ(lamp_by(boris, 1), EditVerdict::kTooFar);
  EXPECT_EQ(lamp_by(*anna, 1), EditVerdict::kDone);
  boris.send(PlayerMoved{at({101.5, 5.0, 1.5})});
  for (int i = 0; i < static_cast<int>(kEditBurst); ++i)
    verdict_of(*anna, saved.island, {2, 4, 1},
               i % 2 == 0 ? world::BlockId{world::block::kLamp} : world::kAir);
  EXPECT_EQ(lamp_by(*anna, 3), EditVerdict::kTooFast);
  EXPECT_EQ(lamp_by(boris, 3), EditVerdict::kDone);
  // Engines are set by who stands there.
  SavedPlay elsewhere = at({101.5, 5.0, 1.5});
  elsewhere.player.island = saved.island + 1;
  boris.send(PlayerMoved{elsewhere});
  boris.send(Steer{saved.island, {0.0, 0.0, 1.0}, 0.0});
  boris.advance(0.2);
  EXPECT_FALSE(motion_of(boris, saved.island));
  anna->send(Steer{saved.island, {0.0, 0.0, 1.0}, 0.0});
  anna->advance(0.2);
  EXPECT_TRUE(motion_of(boris, saved.island));
}

TEST(Session, EveryPlayerComesBackToTheirPlace) {
  const Saved saved;
  const SavedPlay alone = at({101.5, 5.0, 1.5}), anna = at({-7.0, 3.5, 1e6}), boris = at({0, 1, 2});
  {
    const auto session = saved.open();
    session->send(PlayerMoved{alone});
    Seat seat(session->session(), Join{"Anna"});
    seat.send(PlayerMoved{anna});
    Seat other(session->session(), Join{"Борис"});
    other.send(PlayerMoved{boris});
    session->attend();
  }
  for (int open = 0; open < 2; ++open) {  // the second time without having moved
    const auto session = saved.open();
    EXPECT_EQ(session->joined()->play, alone);
    EXPECT_EQ(Seat(session->session(), Join{"Anna"}).joined()->play, anna);
    EXPECT_EQ(Seat(session->session(), Join{"Борис"}).joined()->play, boris);
    EXPECT_FALSE(Seat(session->session(), Join{"Carl"}).joined()->play);
    EXPECT_TRUE(session->receive().empty()) << "nothing is damaged";
  }
}

TEST(Session, RefusesANameThatIsTakenOrTooLong) {
  const Saved saved;
  const auto anna = saved.open(Join{"Anna"});
  const auto refusal = [&](const std::string& name) {
    Seat seat(anna->session(), Join{name});
    const std::vector<Notice> notices = heard<Notice>(seat);
    return seat.joined() || notices.size() != 1 ? std::string() : notices[0].text;
  };
  EXPECT_EQ(refusal("Anna"), "the player 'Anna' is in this world already");
  EXPECT_NE(refusal(std::string(kMaxPlayerBytes + 1, 'x')).find("64 bytes"), std::string::npos);
  EXPECT_TRUE(refusal(std::string(kMaxPlayerBytes, 'x')).empty());
  {
    Seat boris(anna->session(), Join{"Boris"});
    EXPECT_TRUE(boris.joined());
  }
  EXPECT_TRUE(refusal("Boris").empty()) << "he has left";
}

TEST(Session, DamagedPlacesOfPlayersAreTold) {
  const Saved saved;
  const SavedPlay play = at({101.5, 5.0, 1.5});
  std::map<std::string, SavedPlay> plays{{"", play}};
  for (int i = 0; i < 9; ++i) plays[std::string(1, static_cast<char>('a' + i))] = play;
  std::vector<std::byte> whole;
  {
    auto file = world::WorldFile::open(saved.path, world::WorldFile::Mode::kWrite);
    auto transaction = (*file)->begin();
    put_plays(transaction, plays);
    ASSERT_TRUE(transaction.commit());
    whole = (*file)->value("players").value();
    EXPECT_EQ(saved_plays(**file), plays);
    EXPECT_TRUE((*file)->damage().empty());
  }
  // Any length that is too short, and one that is too long.
  for (std::size_t size = 0; size <= whole.size() + 1; size += size < 40 ? 1 : 37) {
    if (size == whole.size()) continue;
    std::vector<std::byte> bytes = whole;
    bytes.resize(size);
    auto file = world::WorldFile::open(saved.path, world::WorldFile::Mode::kWrite);
    auto transaction = (*file)->begin();
    transaction.put_value("players", bytes);
    ASSERT_TRUE(transaction.commit());
    const std::map<std::string, SavedPlay> read = saved_plays(**file);
    EXPECT_EQ((*file)->damage().size(), 1u) << size;
    for (const auto& [player, found] : read) EXPECT_EQ(found, plays.at(player));
  }
}

TEST(Session, APlaceFarFromTheMiddleOfAnIslandIsKept) {
  const Saved saved;
  SavedPlay play = at({101.5, 5.0, 1.5});
  play.player.lattice = LatticePos{std::int64_t{300} << 32, 0, -(std::int64_t{900'000} << 32)};
  {
    const auto session = saved.open();
    session->send(PlayerMoved{play});
    session->advance(1.0);
  }
  EXPECT_EQ(left_in(*saved.open()), play);
}

TEST(Session, AnIslandAheadOfTheWorldsTimeMovesAllTheSame) {
  const Saved saved;
  {
    auto file = world::WorldFile::open(saved.path, world::WorldFile::Mode::kWrite);
    auto transaction = (*file)->begin();
    world::IslandSpec spec;
    spec.id = saved.island;
    world::MotionState motion;
    motion.tick = 5'000'000;
    motion.velocity = {3.0, 0.0, 0.0};
    transaction.put_island({spec, true, motion});
    put_plays(transaction, {{"", at({101.5, 5.0, 1.5})}});
    ASSERT_TRUE(transaction.commit());
  }
  const auto session = saved.open();
  for (int i = 0; i < 200; ++i) {
    session->advance(0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const auto now = motion_of(*session, saved.island);
  ASSERT_TRUE(now);
  EXPECT_GT(world::difference_blocks(now->pose.origin, {}).x, 1.0);
}

TEST(Session, OnlyWhoStandsOnAnIslandSteersIt) {
  const Saved saved;
  const auto session = saved.open();
  session->send(Steer{saved.island, {0.0, 0.0, 1.0}, 0.0});
  session->advance(1.0);
  EXPECT_FALSE(motion_of(*session, saved.island)) << "nobody is there yet";
  SavedPlay play = at({101.5, 5.0, 1.5});
  play.player.island = saved.island + 1;
  session->send(PlayerMoved{play});
  session->send(Steer{saved.island, {0.0, 0.0, 1.0}, 0.0});
  session->advance(0.2);
  EXPECT_FALSE(motion_of(*session, saved.island)) << "the player is elsewhere";
  play.player.island = saved.island;
  session->send(PlayerMoved{play});
  session->send(Steer{saved.island, {0.0, 0.0, 1.0}, 0.0});
  session->advance(0.2);
  EXPECT_TRUE(motion_of(*session, saved.island));
}

TEST(Session, AnIslandThatIsDugAllTheTimeFliesAllTheSame) {
  const Saved saved;
  const auto session = saved.open();
  SavedPlay play = at({101.5, 5.0, 1.5});
  session->send(PlayerMoved{play});
  session->send(Steer{saved.island, {0.0, 0.0, 1.0}, 0.0});
  double now_s = 1.0;
  session->advance(now_s);
  for (int i = 0; i < 150; ++i) {
    const world::Pose pose = *session->world()->pose(saved.island, now_s);
    play.eye.position = world::moved(pose.origin, {1.5, 5.0, 1.5});
    session->send(PlayerMoved{play});
    ASSERT_EQ(verdict_of(*session, saved.island, {2, 3, 1},
                         i % 2 == 0 ? world::BlockId{world::block::kStone} : world::kAir),
              EditVerdict::kDone);
    session->advance(0.04);
    now_s += 0.04;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const auto now = motion_of(*session, saved.island);
  ASSERT_TRUE(now);
  EXPECT_GT(now->velocity.z, 0.5);
}

/// What edit number n does: lamps come, then go again. After fewer than 2 * kSpots more edits a
/// world is another one, so that a world says how many were made.
constexpr std::uint64_t kSpots = 60;
IVec3 spot_of(std::uint64_t n) {
  const auto i = static_cast<std::int32_t>(n % kSpots);
  return {1 + i % 6, 3, -3 + i / 6};
}
world::BlockId block_of(std::uint64_t n) {
  return n / kSpots % 2 == 0 ? world::BlockId{world::block::kLamp} : world::kAir;
}
/// What stands at a spot after so many edits.
world::BlockId block_after(std::uint64_t edits, std::uint64_t spot) {
  if (edits <= spot) return world::kAir;
  return block_of(spot + (edits - 1 - spot) / kSpots * kSpots);
}

/// Makes 100 edits a second, saves after each ten, and says how many are saved: `first` at once.
[[noreturn]] void play_for_ever(const Saved& saved, std::uint64_t first, int told) {
  const auto session = saved.open();
  if (!session || ::write(told, &first, sizeof first) != sizeof first) ::_exit(1);
  session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t n = first;; ++n) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(10 * (n - first)));
    session->advance(0.05);
    if (verdict_of(*session, saved.island, spot_of(n), block_of(n)) != EditVerdict::kDone)
      ::_exit(1);
    if (n % 10 != 9) continue;
    const std::uint64_t count = n + 1;
    if (!session->save() || ::write(told, &count, sizeof count) != sizeof count) ::_exit(1);
  }
}

/// How many edits a world holds, at least `least`; none: some of those are lost, or it is damaged.
std::optional<std::uint64_t> edits_in(const Saved& saved, std::uint64_t least) {
  auto file = world::WorldFile::open(saved.path, world::WorldFile::Mode::kRead);
  if (!file) return std::nullopt;
  const world::LoadedWorld loaded = world::load_world(**file);
  if (!(*file)->damage().empty()) return std::nullopt;
  std::array<world::BlockId, kSpots> blocks{};
  for (std::uint64_t spot = 0; spot < kSpots; ++spot) {
    const IVec3 v = spot_of(spot), c = world::chunk_of(v);
    blocks[spot] = loaded.world->chunk_now(saved.island, c)
                       .at(v.x & (world::kChunkEdge - 1), v.y & (world::kChunkEdge - 1),
                           v.z & (world::kChunkEdge - 1));
  }
  for (std::uint64_t edits = least; edits < least + 2 * kSpots; ++edits) {
    bool same = true;
    for (std::uint64_t spot = 0; spot < kSpots; ++spot)
      same = same && blocks[spot] == block_after(edits, spot);
    if (same) return edits;
  }
  return std::nullopt;
}

bool is_after(const Saved& saved, std::uint64_t edits) {
  return edits_in(saved, edits) == edits;
}

/// SKERRY_KILL_ROUNDS as in tests/world/store/kill_test.cpp.
TEST(SessionKillTest, WhatWasSavedOutlivesThePlay) {
  const char* asked = std::getenv("SKERRY_KILL_ROUNDS");
  const int rounds = asked ? std::atoi(asked) : 8;
  const Saved saved;
  std::uint64_t done = 0, acknowledged = 0;
  for (int round = 0; round < rounds; ++round) {
    int told[2];
    ASSERT_EQ(::pipe(told), 0);
    const pid_t child = ::fork();
    if (child == 0) play_for_ever(saved, done, told[1]);
    ::close(told[1]);
    std::uint64_t n = done;
    // Some are killed while they open the world; the others play, however busy the machine is.
    if (round % 4 != 0) {
      ASSERT_EQ(::read(told[0], &n, sizeof n), std::ssize(std::as_bytes(std::span(&n, 1))));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50'000 + 79'193 * round % 250'000));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    while (::read(told[0], &n, sizeof n) == sizeof n) acknowledged += n > done;
    ::close(told[0]);
    const std::optional<std::uint64_t> found = edits_in(saved, n);
    ASSERT_TRUE(found) << "round " << round << ": of " << n
                       << " edits that were saved some are lost";
    done = *found;
  }
  std::printf("%d kills: %llu single edits, %llu saves acknowledged, lost 0\n", rounds,
              static_cast<unsigned long long>(done), static_cast<unsigned long long>(acknowledged));
  EXPECT_GT(acknowledged, static_cast<std::uint64_t>(rounds) / 4) << "killed before it had saved";
}

/// Plays without saving, says so, and is busy with something else.
[[noreturn]] void play_and_stall(const Saved& saved, std::uint64_t edits, int told) {
  const auto session = saved.open();
  if (!session) ::_exit(7);
  session->send(PlayerMoved{at({101.5, 5.0, 1.5})});
  for (std::uint64_t n = 0; n < edits; ++n) {
    session->advance(1.0);
    if (verdict_of(*session, saved.island, spot_of(n), block_of(n)) != EditVerdict::kDone)
      ::_exit(8);
  }
  if (::write(told, &edits, sizeof edits) != sizeof edits) ::_exit(9);
  while (true) ::pause();
}

struct EndedPlay {
  int status = 0;
  double seconds = 0.0;  ///< from the signal on
};

/// @return the end of a play of so many edits that got a signal.
EndedPlay end_after_signal(const Saved& saved, std::uint64_t edits, int signal_number) {
  int told[2];
  EXPECT_EQ(::pipe(told), 0);
  const pid_t child = ::fork();
  if (child == 0) play_and_stall(saved, edits, told[1]);
  ::close(told[1]);
  std::uint64_t n = 0;
  EXPECT_EQ(::read(told[0], &n, sizeof n), std::ssize(std::as_bytes(std::span(&n, 1))));
  ::close(told[0]);
  const Stopwatch since_signal;
  ::kill(child, signal_number);
  EndedPlay ended;
  ::waitpid(child, &ended.status, 0);
  ended.seconds = since_signal.seconds();
  return ended;
}

TEST(SessionKillTest, ASignalToEndSavesFirstWhateverTheFrameIsAt) {
  for (const int signal_number : {SIGTERM, SIGINT, SIGHUP}) {
    const Saved saved;
    const auto [status, seconds] = end_after_signal(saved, 17, signal_number);
    EXPECT_LT(seconds, 2.0);  // what docs/saving.md promises
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal_number) << status;
    EXPECT_TRUE(is_after(saved, 17)) << signal_number;
  }
}

TEST(SessionKillTest, AnEndThatCannotSaveIsStatusOne) {
  const Saved saved;
  // Another writer, which does not finish.
  int code = 0;
  auto other = world::Database::open(saved.path.string(), SQLITE_OPEN_READWRITE, code);
  ASSERT_TRUE(other);
  ASSERT_EQ(other->run("BEGIN IMMEDIATE"), SQLITE_OK);
  const auto [status, seconds] = end_after_signal(saved, 3, SIGTERM);
  EXPECT_LT(seconds, 4.0);  // two for the save, and what a busy machine needs to end a process
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << status;
  ASSERT_EQ(other->run("ROLLBACK"), SQLITE_OK);
  other.reset();
  EXPECT_TRUE(is_after(saved, 0));
}

}  // namespace
}  // namespace skerry::game
