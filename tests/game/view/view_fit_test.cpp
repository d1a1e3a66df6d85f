#include "game/view/view_fit.h"

#include <gtest/gtest.h>

namespace skerry::game {
namespace {

constexpr ViewFit::Distances kAsked{1000.0, 200.0};
const world::WorldPos kHere{}, kFar = {500 * world::kUnitsPerBlock, 0, 0};

TEST(ViewFit, ShowsWhatIsAskedUntilMemoryRunsOut) {
  ViewFit fit;
  EXPECT_EQ(fit.of(kAsked), kAsked);
  for (int i = 0; i < 1000; ++i) fit.settled(0.99, kAsked, kHere);
  EXPECT_EQ(fit.of(kAsked), kAsked);
}

TEST(ViewFit, DetailGivesWayBeforeDistanceAndBothEnd) {
  ViewFit fit;
  ViewFit::Distances before = kAsked;
  int steps = 0;
  while (fit.lower(kAsked, kHere)) {
    const ViewFit::Distances now = fit.of(kAsked);
    EXPECT_LE(now.view_blocks, before.view_blocks);
    EXPECT_LE(now.detail_blocks, before.detail_blocks);
    EXPECT_NE(now, before);
    if (now.view_blocks < kAsked.view_blocks) {
      EXPECT_EQ(now.detail_blocks, 50.0);
    }
    before = now;
    ASSERT_LT(++steps, 100);
  }
  EXPECT_EQ(before, (ViewFit::Distances{ViewFit::kLeast, 50.0}));
  EXPECT_FALSE(fit.lower(kAsked, kHere));
  EXPECT_EQ(fit.of(kAsked), before);
}

TEST(ViewFit, NeverShowsMoreThanIsAsked) {
  for (const double view : {32.0, 33.0, 100.0, 16384.0})
    for (const double detail : {32.0, 40.0, 4096.0}) {
      const ViewFit::Distances asked{view, detail};
      ViewFit fit;
      do {
        EXPECT_LE(fit.of(asked).view_blocks, view);
        EXPECT_LE(fit.of(asked).detail_blocks, detail);
      } while (fit.lower(asked, kHere));
    }
}

TEST(ViewFit, RisesOnlyElsewhereAndWhenMemoryIsRoomyForLong) {
  ViewFit fit;
  ASSERT_TRUE(fit.lower(kAsked, kHere));
  const ViewFit::Distances low = fit.of(kAsked);
  for (int i = 0; i < 1000; ++i) fit.settled(0.1, kAsked, kHere);
  EXPECT_EQ(fit.of(kAsked), low) << "it ran out here";
  for (int i = 0; i < 1000; ++i) fit.settled(i % 50 == 0 ? 0.6 : 0.1, kAsked, kFar);
  EXPECT_EQ(fit.of(kAsked), low) << "never calm for long enough";
  for (int i = 0; i < ViewFit::kCalmFrames; ++i) fit.settled(0.1, kAsked, kFar);
  EXPECT_EQ(fit.of(kAsked), kAsked);
}

TEST(ViewFit, DoesNotSwingWhereMemoryIsShort) {
  // A world that needs memory by the square of the view distance, and more than there is.
  ViewFit fit;
  int changes = 0;
  for (int frame = 0; frame < 20000; ++frame) {
    const ViewFit::Distances shown = fit.of(kAsked);
    const double used = shown.view_blocks * shown.view_blocks * 3e-6 * shown.detail_blocks / 200.0;
    if (used > 1.0) {
      fit.lower(kAsked, kHere);
    } else {
      fit.settled(used, kAsked, kHere);
    }
    changes += fit.of(kAsked) != shown;
  }
  EXPECT_LT(changes, 20);
}

}  // namespace
}  // namespace skerry::game
