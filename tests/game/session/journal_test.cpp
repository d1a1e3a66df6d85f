#include "game/session/journal.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "game/session/session.h"
#include "tests/folder.h"
#include "tests/game/session/seat.h"
#include "tests/world/made_islands.h"
#include "world/store/database.h"
#include "world/store/world_file.h"

namespace skerry::game {
namespace {

Journal some_journal() {
  Journal journal;
  journal.waypoints.push_back({"Skarholm 1", {7, {-1, 2, 3LL << 40}, world::blocks(1, -2, 3)}});
  journal.waypoints.push_back({"\xe5\xb3\xb6", {std::nullopt, {0, 0, 0}, world::blocks(-9, 8, 7)}});
  journal.home = Spot{~std::uint64_t{0}, {4, 5, 6}, {}};
  journal.found = {0x3ff, 5, 212, -87};
  return journal;
}

std::optional<Journal> after_bytes(const Journal& journal) {
  world::ByteWriter out;
  encode_journal(journal, out);
  world::ByteReader in(out.bytes());
  std::optional<Journal> read = decode_journal(in);
  EXPECT_TRUE(!read || in.done());
  return read;
}

TEST(Journal, ComesBackFromBytes) {
  EXPECT_EQ(after_bytes(Journal{}), Journal{});
  EXPECT_EQ(after_bytes(some_journal()), some_journal());
}

TEST(Journal, OneThatIsCutShortOrTooLargeIsNone) {
  world::ByteWriter out;
  encode_journal(some_journal(), out);
  for (std::size_t size = 0; size < out.bytes().size(); ++size) {
    world::ByteReader in(out.bytes().first(size));
    EXPECT_FALSE(decode_journal(in)) << size;
  }
  Journal many;
  many.waypoints.resize(kMaxWaypoints);
  EXPECT_TRUE(fits_file(many));
  many.waypoints.emplace_back();
  EXPECT_FALSE(fits_file(many));
  EXPECT_FALSE(after_bytes(many));
  Journal named;
  named.waypoints.push_back({std::string(kMaxWaypointBytes + 1, 'x'), {}});
  EXPECT_FALSE(fits_file(named));
  Journal far;
  far.home = Spot{};
  far.home->place.x = (world::kMaxBlock + 1) * world::kUnitsPerBlock;
  EXPECT_FALSE(after_bytes(far));
}

/// A saved world of a seed.
struct Kept {
  Folder folder;
  std::filesystem::path path = folder / "w.skerry";

  Kept() {
    world::WorldInfo info{"Kept", "5", {}};
    info.desc.seed = 5;
    EXPECT_TRUE(world::WorldFile::create(path, info));
  }
  std::unique_ptr<Seat> open(const std::string& player = "") const {
    auto session = Session::open(path);
    EXPECT_TRUE(session);
    return std::make_unique<Seat>(*std::move(session), Join{player, true});
  }
};

TEST(Journal, IsKeptWithTheWorldAndByPlayer) {
  const Kept kept;
  Journal other = some_journal();
  other.waypoints.pop_back();
  {
    const auto alone = kept.open();
    EXPECT_EQ(alone->joined()->journal, Journal{});
    Seat second(alone->session(), Join{"Ann", true});
    alone->send(KeepJournal{some_journal()});
    second.send(KeepJournal{other});
    alone->attend();
    ASSERT_TRUE(alone->save());
  }
  EXPECT_EQ(kept.open()->joined()->journal, some_journal());
  EXPECT_EQ(kept.open("Ann")->joined()->journal, other);
  EXPECT_EQ(kept.open("Bob")->joined()->journal, Journal{});
}

TEST(Journal, WhatNoFileMayHoldIsNotKept) {
  const Kept kept;
  {
    const auto alone = kept.open();
    alone->send(KeepJournal{some_journal()});
    Journal many;
    many.waypoints.resize(kMaxWaypoints + 1);
    alone->send(KeepJournal{many});
    alone->attend();
  }
  EXPECT_EQ(kept.open()->joined()->journal, some_journal());
}

TEST(Journal, ADamagedOneIsToldAndTheWorldIsPlayed) {
  const Kept kept;
  {
    auto file = world::WorldFile::open(kept.path, world::WorldFile::Mode::kWrite);
    ASSERT_TRUE(file);
    auto transaction = (*file)->begin();
    put_journals(transaction, {{"", some_journal()}});
    world::ByteWriter nonsense;
    nonsense.u32(1);
    nonsense.text("");
    nonsense.u32(~0u);
    transaction.put_value("journals", nonsense.bytes());
    ASSERT_TRUE(transaction.commit());
  }
  const auto alone = kept.open();
  EXPECT_EQ(alone->joined()->journal, Journal{});
  const std::vector<Answer> heard = alone->receive();
  ASSERT_FALSE(heard.empty());
  const auto* notice = std::get_if<Notice>(&heard.front());
  ASSERT_TRUE(notice);
  EXPECT_NE(notice->text.find("waypoints"), std::string::npos) << notice->text;
}

}  // namespace
}  // namespace skerry::game
