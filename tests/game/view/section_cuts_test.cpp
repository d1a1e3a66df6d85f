#include "game/sections/section_cuts.h"

#include <gtest/gtest.h>

namespace skerry::game {
namespace {

using world::SectionKey;

/// Islands in a row along x, each with two chunks of level 0 and the one of level 1 that has both.
class SectionCutsTest : public testing::Test {
 protected:
  static constexpr double kApart = 1000.0;
  SectionCutsTest() {
    for (const std::uint64_t island : {1u, 2u, 3u})
      for (const SectionKey& key : keys_of(island)) add(key);
  }
  static std::vector<SectionKey> keys_of(std::uint64_t island) {
    return {{island, {0, 0, 0}, 0}, {island, {1, 0, 0}, 0}, {island, {0, 0, 0}, 1}};
  }
  void add(const SectionKey& key) {
    const std::int32_t edge = 64 << key.level, x = key.chunk.x * edge;
    cuts_.add(key, {{x, 0, 0}, {x + edge, edge, edge}});
    shown_[key] = true;
  }
  void choose(double camera_x, bool keep = true) {
    calls_ = 0;
    view_.keep = keep;
    view_.camera_in = [camera_x](std::uint64_t island) {
      return glm::dvec3(camera_x - kApart * static_cast<double>(island), 0.0, 0.0);
    };
    cuts_.choose(view_, [this](const SectionKey& key, bool shown, std::uint8_t) {
      ++calls_;
      shown_.at(key) = shown;
    });
  }
  bool is_fine(std::uint64_t island) const {
    const auto keys = keys_of(island);
    EXPECT_EQ(shown_.at(keys[0]), shown_.at(keys[1]));
    EXPECT_NE(shown_.at(keys[0]), shown_.at(keys[2]));
    return shown_.at(keys[0]);
  }

  SectionCuts cuts_;
  SectionCuts::View view_{.nearest_of = [](std::uint64_t) {
    return std::vector{0.0, 100.0, 200.0, 400.0, 800.0};
  }};
  std::map<SectionKey, bool> shown_;
  int calls_ = 0;
};

TEST_F(SectionCutsTest, DrawsWhatIsNearFine) {
  choose(2000.0);
  EXPECT_FALSE(is_fine(1));
  EXPECT_TRUE(is_fine(2));
  EXPECT_FALSE(is_fine(3));
  choose(2000.0);
  EXPECT_EQ(calls_, 0) << "nothing has changed";
}

TEST_F(SectionCutsTest, GivesEachIslandItsOwnLimits) {
  view_.nearest_of = [](std::uint64_t island) {
    return std::vector{0.0, island == 3 ? 2000.0 : 100.0, 2000.0, 4000.0, 8000.0};
  };
  choose(2000.0);
  EXPECT_FALSE(is_fine(1));
  EXPECT_TRUE(is_fine(3)) << "1,000 blocks away";
}

TEST_F(SectionCutsTest, CutsOneIslandACallWhileTheCameraMoves) {
  choose(2000.0);
  choose(3000.0);  // the second is farthest beyond what its cut allows
  EXPECT_FALSE(is_fine(2));
  EXPECT_FALSE(is_fine(3)) << "left for later";
  for (int i = 0; i < 2; ++i) choose(3000.0);
  EXPECT_TRUE(is_fine(3));
  choose(1000.0, false);
  EXPECT_TRUE(is_fine(1));
  EXPECT_FALSE(is_fine(3)) << "all at once where no state is kept";
}

TEST_F(SectionCutsTest, LeavesOutLevelsThatAreStillComing) {
  view_.coming = {{2, 0}};
  choose(2000.0);
  EXPECT_FALSE(is_fine(2));
  view_.coming.clear();
  choose(2000.0);
  EXPECT_TRUE(is_fine(2));
}

TEST_F(SectionCutsTest, DrawsWhatIsLeftOfAnIsland) {
  choose(2000.0);
  const SectionKey coarse = keys_of(1)[2];
  cuts_.remove(coarse);
  shown_.erase(coarse);
  choose(2000.0);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(shown_.at(keys_of(1)[static_cast<std::size_t>(i)]));
  for (const SectionKey& key : keys_of(3)) cuts_.remove(key);
  choose(3000.0);
}

}  // namespace
}  // namespace skerry::game
