#include "tools/skerry/test/verdict.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skerry::tools {
namespace {

platform::PngImage plain(std::uint32_t width, std::uint32_t height, std::uint8_t value) {
  platform::PngImage image{width, height, {}, {}};
  image.pixels.assign(std::size_t{width} * height * 4, value);
  return image;
}

void put(platform::PngImage& image, std::uint32_t x, std::uint32_t y, int channel,
         std::uint8_t value) {
  image.pixels[(std::size_t{y} * image.width + x) * 4 + static_cast<std::size_t>(channel)] = value;
}

TEST(Verdict, EqualPicturesAreAtDistanceZero) {
  const platform::PngImage picture = plain(40, 20, 100);
  const Comparison same = compare(picture, picture, {});
  EXPECT_TRUE(same.difference.equal());
  EXPECT_EQ(same.difference.flip_mean, 0.0);
  EXPECT_EQ(same.difference.flip_max, 0.0);
  EXPECT_EQ(same.difference.pixels_over, 0.0);
  EXPECT_TRUE(std::isinf(same.difference.psnr_db));
  EXPECT_EQ(same.flip.errors.size(), 800u);
  EXPECT_EQ(beyond(same.difference, {0.0, 0.0, 0.0, 0.0, 0}), "");
}

TEST(Verdict, BlackAgainstWhiteIsAsFarAsPicturesCanBe) {
  const Comparison found = compare(plain(40, 20, 0), plain(40, 20, 255), {});
  EXPECT_EQ(found.difference.largest, 255);
  EXPECT_EQ(found.difference.pixels_over, 1.0);
  EXPECT_NEAR(found.difference.flip_mean, 1.0, 0.05);  // black to white is FLIP's largest error
  EXPECT_NEAR(found.difference.psnr_db, 0.0, 1e-9);    // error 1 against peak 1
  EXPECT_NE(beyond(found.difference, game::Tolerance{}), "");
}

TEST(Verdict, TheShareOfPixelsCountsThoseOverTheThresholdInOneChannel) {
  const platform::PngImage reference = plain(40, 20, 100);
  game::Expectations expected;
  expected.tolerance = {1.0, 1.0, 1.0, 4.0 / 800.0, 8};
  for (const int channel : {0, 1, 2}) {
    for (const int by : {8, -8, 9, -9}) {
      platform::PngImage actual = reference;
      for (std::uint32_t x = 0; x < 5; ++x)
        put(actual, x * 7, x, channel, static_cast<std::uint8_t>(100 + by));
      const Difference found = compare(reference, actual, expected).difference;
      EXPECT_EQ(found.largest, std::abs(by));
      EXPECT_EQ(found.pixels_over, std::abs(by) > 8 ? 5.0 / 800.0 : 0.0);
      EXPECT_EQ(beyond(found, expected.tolerance).empty(), std::abs(by) == 8);
    }
  }
}

TEST(Verdict, TheAmountOfEveryQuantityIsLimited) {
  const Difference found{0.1, 0.2, 0.3, 40.0, 0.4, 50};
  const game::Tolerance at{0.1, 0.2, 0.3, 0.4, 8};
  EXPECT_EQ(beyond(found, at), "");  // at the limit is within
  for (double game::Tolerance::*field :
       {&game::Tolerance::flip_mean, &game::Tolerance::flip_p99, &game::Tolerance::flip_max,
        &game::Tolerance::pixels_over}) {
    game::Tolerance tighter = at;
    tighter.*field *= 0.999;
    EXPECT_NE(beyond(found, tighter), "");
  }
}

TEST(Verdict, WhatIsMaskedDoesNotCount) {
  const platform::PngImage reference = plain(40, 20, 100);
  platform::PngImage actual = reference;
  for (std::uint32_t y = 5; y < 9; ++y) {
    for (std::uint32_t x = 10; x < 16; ++x) put(actual, x, y, 1, 255);
  }
  game::Expectations expected;
  expected.masks = {{10, 5, 6, 4}};
  EXPECT_TRUE(compare(reference, actual, expected).difference.equal());
  expected.masks = {{10, 5, 6, 3}};  // one row shows
  const Comparison seen = compare(reference, actual, expected);
  EXPECT_DOUBLE_EQ(seen.difference.pixels_over, 6.0 / (800.0 - 18.0));
  EXPECT_GT(seen.difference.flip_max, 0.1);
  EXPECT_EQ(seen.flip.errors[5 * 40 + 12], 0.0f);
  EXPECT_GT(seen.flip.errors[8 * 40 + 12], 0.1f);
}

TEST(Verdict, APictureIsBlackUnlessOneInAHundredPixelsCanBeSeen) {
  platform::PngImage picture = plain(40, 20, 15);
  for (std::uint32_t x = 0; x < 7; ++x) put(picture, x, 3, 2, 16);
  EXPECT_TRUE(is_black(picture));
  put(picture, 7, 3, 0, 16);
  EXPECT_FALSE(is_black(picture));
  EXPECT_TRUE(is_black(plain(1, 1, 0)));
}

}  // namespace
}  // namespace skerry::tools
