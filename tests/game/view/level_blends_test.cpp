#include "game/sections/level_blends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace skerry::game {
namespace {

using world::SectionKey;

constexpr std::uint64_t kIsland = 7;
constexpr std::uint32_t kSteps = shared::kBlendSteps;

SectionKey at(std::int32_t level, std::int32_t x) {
  return {kIsland, {x, 0, 0}, level};
}
SectionKey far_at(std::int32_t level) {
  return {kIsland, {0, 0, 0}, level, true};
}

/// What is shown of a row of chunks along x, by step of the pattern. Sections that are not in
/// motion are shown in all pixels.
class Row {
 public:
  void choose(const std::vector<SectionKey>& came, const std::vector<SectionKey>& went) {
    blends_.change(kIsland, came, went);
    for (const SectionKey& key : came) shown_[key] = {};
    for (const SectionKey& key : went) shown_.at(key).goes = true;
    take();
  }
  void advance(double seconds) {
    blends_.advance(seconds);
    take();
    blends_.settle();
  }
  /// Which sections show a block in the pixels of a step.
  std::vector<SectionKey> seen(std::int32_t block_chunk, std::uint32_t step) const {
    std::vector<SectionKey> out;
    for (const auto& [key, shown] : shown_) {
      const bool here = key.far || block_chunk >> key.level == key.chunk.x;
      if (here && step >= shown.first && step < shown.end) out.push_back(key);
    }
    return out;
  }
  LevelBlends blends_;

 private:
  void take() {
    blends_.each_changed([&](const SectionKey& key, const LevelBlends::Shown& shown) {
      if (shown.goes && shown.none())
        shown_.erase(key);
      else
        shown_[key] = shown;
    });
  }
  std::map<SectionKey, LevelBlends::Shown> shown_;
};

void expect_one_each(const Row& row, std::int32_t chunks) {
  for (std::int32_t x = 0; x < chunks; ++x)
    for (std::uint32_t step = 0; step < kSteps; ++step)
      ASSERT_EQ(row.seen(x, step).size(), 1u) << x << " at " << step;
}

TEST(LevelBlends, PassFromOneLevelToTheOtherWithinTheirTime) {
  Row row;
  row.choose({at(1, 0)}, {});
  row.blends_.finish_all();
  row.advance(0.0);
  EXPECT_TRUE(row.blends_.idle());
  row.choose({at(0, 0), at(0, 1)}, {at(1, 0)});
  int frames = 0;
  std::uint32_t fine_before = 0;
  for (; !row.blends_.idle() && frames < 100; ++frames) {
    expect_one_each(row, 2);
    std::uint32_t fine = 0;
    for (std::uint32_t step = 0; step < kSteps; ++step)
      fine += row.seen(0, step).front().level == 0;
    EXPECT_GE(fine, fine_before);
    EXPECT_LE(fine - fine_before, 3u) << "64 steps in 30 frames";
    fine_before = fine;
    row.advance(1.0 / 60.0);
  }
  EXPECT_NEAR(frames, LevelBlends::kSeconds * 60.0, 2.0);
  EXPECT_EQ(row.seen(0, 0).front(), at(0, 0));
}

TEST(LevelBlends, WhatIsNewAppearsAndWhatHasNoSuccessorVanishes) {
  Row row;
  row.choose({far_at(5)}, {});
  EXPECT_TRUE(row.seen(0, 0).empty());
  row.advance(LevelBlends::kSeconds * 0.1);
  EXPECT_TRUE(row.seen(0, 0).empty());
  EXPECT_EQ(row.seen(0, kSteps - 1).size(), 1u);
  row.blends_.finish_all();
  row.advance(0.0);
  row.choose({}, {far_at(5)});
  row.advance(LevelBlends::kSeconds * 0.1);
  EXPECT_TRUE(row.seen(0, 0).empty());
  EXPECT_EQ(row.seen(0, kSteps - 1).size(), 1u);
}

TEST(LevelBlends, ALateFrameChangesAPartAlone) {
  Row row;
  row.choose({at(0, 0)}, {});
  row.advance(10.0);
  EXPECT_FALSE(row.blends_.idle());
}

TEST(LevelBlends, OnlyWhatGoesIsSaidTo) {
  LevelBlends::Shown shown;
  EXPECT_EQ(shown.packed(), 0u);
  shown.goes = true;
  EXPECT_EQ(shown.packed(), kSteps << 8 | shared::kBlendGoes);
  shown = {5, 5, false};
  EXPECT_EQ(shared::blend_first(shown.packed()), kSteps) << "no pixel has that step";
}

TEST(LevelBlends, AtHighFrameRatesAFrameChangesAPartOfTheSections) {
  constexpr int kCoarse = 200;
  std::vector<SectionKey> fine, coarse;
  for (int x = 0; x < kCoarse; ++x) coarse.push_back(at(1, x));
  for (int x = 0; x < 2 * kCoarse; ++x) fine.push_back(at(0, x));
  LevelBlends blends;
  blends.change(kIsland, coarse, {});
  blends.finish_all();
  blends.settle();
  blends.change(kIsland, fine, coarse);
  const auto changed = [&] {
    int count = 0;
    blends.each_changed([&](const SectionKey&, const LevelBlends::Shown&) { ++count; });
    return count;
  };
  EXPECT_EQ(changed(), 3 * kCoarse) << "all, once";
  EXPECT_EQ(changed(), 0);
  constexpr double kFrame = LevelBlends::kSeconds / kSteps / 10.0;  // ten to a step
  int most = 0, all = 0;
  for (int frame = 0; !blends.idle() && frame < 2000; ++frame) {
    blends.advance(kFrame);
    const int now = changed();
    most = std::max(most, now);
    all += now;
    blends.settle();
  }
  EXPECT_TRUE(blends.idle());
  EXPECT_EQ(all, 3 * kCoarse * static_cast<int>(kSteps)) << "each at each step";
  EXPECT_LE(most, 3 * kCoarse / 5) << "a tenth would be even";
  blends.change(kIsland, coarse, fine);
  changed();
  blends.repeat(at(0, 1));
  EXPECT_EQ(changed(), 1);
}

/// The levels at which a row of 16 chunks is drawn: a random cut of the tree above them.
void cut(const SectionKey& place, std::mt19937& random, std::vector<SectionKey>& out) {
  const bool split = place.level > 0 && random() % 3 != 0;
  if (!split) {
    out.push_back(place);
    return;
  }
  if (place.far && place.level > world::kLevelCount)
    return cut(far_at(place.level - 1), random, out);
  if (place.far) return cut(at(world::kLevelCount - 1, 0), random, out);
  cut(at(place.level - 1, 2 * place.chunk.x), random, out);
  cut(at(place.level - 1, 2 * place.chunk.x + 1), random, out);
}

// However often levels change again before they have arrived.
TEST(LevelBlends, EachPixelShowsOneLevelOfEachPlace) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    Row row;
    std::vector<SectionKey> chosen;
    cut(far_at(world::kLevelCount + 1), random, chosen);
    row.choose(chosen, {});
    row.blends_.finish_all();
    row.advance(0.0);
    for (int change = 0; change < 40; ++change) {
      std::vector<SectionKey> next, came, went;
      cut(far_at(world::kLevelCount + 1), random, next);
      for (const SectionKey& key : next)
        if (std::ranges::find(chosen, key) == chosen.end()) came.push_back(key);
      for (const SectionKey& key : chosen)
        if (std::ranges::find(next, key) == next.end()) went.push_back(key);
      row.choose(came, went);
      chosen = next;
      for (auto frames = random() % 12; frames != 0; --frames) {
        expect_one_each(row, 16);
        if (testing::Test::HasFatalFailure()) return;
        row.advance(1.0 / 30.0);
      }
    }
    for (int i = 0; i < 100; ++i) row.advance(1.0);
    EXPECT_TRUE(row.blends_.idle());
    for (std::int32_t x = 0; x < 16; ++x) {
      const std::vector<SectionKey> seen = row.seen(x, 0);
      ASSERT_EQ(seen.size(), 1u);
      EXPECT_NE(std::ranges::find(chosen, seen.front()), chosen.end());
    }
  }
}

}  // namespace
}  // namespace skerry::game
