#include "tools/skerry/compare/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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
  const Difference found{0.1, 0.2, 0.3, 40.0, 0.4, 50, 0.5, -0.6};
  const game::Tolerance at{0.1, 0.2, 0.3, 0.4, 8, 1, 0.5, 0.6};
  EXPECT_EQ(beyond(found, at), "");  // at the limit is within
  for (double game::Tolerance::*field :
       {&game::Tolerance::flip_mean, &game::Tolerance::flip_p99, &game::Tolerance::flip_max,
        &game::Tolerance::pixels_over, &game::Tolerance::pixels_rounded, &game::Tolerance::bias}) {
    game::Tolerance tighter = at;
    tighter.*field *= 0.999;
    EXPECT_NE(beyond(found, tighter), "");
  }
}

/// Of a picture, with so much added to each channel of every n-th pixel.
platform::PngImage with_added(const platform::PngImage& picture, std::size_t n, int by) {
  platform::PngImage out = picture;
  for (std::size_t i = 0; i < out.pixels.size(); i += 4 * n)
    for (std::size_t c = 0; c < 3; ++c)
      out.pixels[i + c] = static_cast<std::uint8_t>(out.pixels[i + c] + by);
  return out;
}

TEST(Verdict, APixelWithinOneCodeValueIsNoErrorOfFlip) {
  const platform::PngImage reference = plain(40, 20, 100);
  game::Expectations expected;
  for (const int by : {1, -1}) {
    const platform::PngImage actual = with_added(reference, 16, by);
    const Difference found = compare(reference, actual, expected).difference;
    EXPECT_EQ(found.flip_mean, 0.0);
    EXPECT_EQ(found.flip_max, 0.0);
    EXPECT_EQ(found.pixels_rounded, 1.0 / 16.0);
    EXPECT_EQ(found.bias, by / 16.0);
    EXPECT_EQ(found.largest, 1);
    EXPECT_FALSE(found.equal());  // it is another picture all the same
    EXPECT_TRUE(std::isfinite(found.psnr_db));
    EXPECT_EQ(beyond(found, expected.tolerance), "");
    game::Expectations strict = expected;
    strict.tolerance.code_values = 0;
    const Difference exact = compare(reference, actual, strict).difference;
    EXPECT_GT(exact.flip_mean, 0.0);
    EXPECT_EQ(exact.pixels_rounded, 0.0);
    EXPECT_EQ(exact.bias, 0.0);
  }
}

TEST(Verdict, APixelOffByMoreInOneChannelIsNotRounded) {
  const platform::PngImage reference = plain(40, 20, 100);
  platform::PngImage actual = with_added(reference, 4, 1);
  put(actual, 8, 3, 2, 102);  // is one of each fourth
  const Comparison found = compare(reference, actual, {});
  EXPECT_EQ(found.difference.pixels_rounded, 199.0 / 800.0);
  EXPECT_EQ(found.difference.bias, 199.0 / 800.0);
  EXPECT_GT(found.flip.errors[3 * 40 + 8], 0.0f);
  // By itself it gives the same error: what is rounded beside it adds nothing.
  platform::PngImage alone = reference;
  for (const int c : {0, 1}) put(alone, 8, 3, c, 101);
  put(alone, 8, 3, 2, 102);
  EXPECT_EQ(compare(reference, alone, {}).flip.errors, found.flip.errors);
}

TEST(Verdict, AWholePictureThatIsBrighterByLessThanACodeValueFails) {
  const platform::PngImage reference = plain(40, 20, 100);
  for (const int by : {1, -1}) {
    const auto message = [&](std::size_t n) {
      return beyond(compare(reference, with_added(reference, n, by), {}).difference, {});
    };
    EXPECT_EQ(message(10), "");
    EXPECT_EQ(message(8).rfind("bias", 0), 0u) << message(8);
  }
  // Both ways: no bias, but hardly a pixel is as it was.
  platform::PngImage both = with_added(reference, 1, 1);
  both = with_added(both, 2, -2);
  const Difference found = compare(reference, both, {}).difference;
  EXPECT_EQ(found.bias, 0.0);
  EXPECT_EQ(found.pixels_rounded, 1.0);
  EXPECT_EQ(beyond(found, {}).rfind("share of pixels off by at most 1", 0), 0u);
}

TEST(Verdict, TheBiasIsOfTheChannelThatHasMost) {
  const platform::PngImage reference = plain(40, 20, 100);
  platform::PngImage actual = reference;
  for (std::uint32_t x = 0; x < 40; ++x) {
    put(actual, x, 0, 0, 101);
    put(actual, x, 1, 1, 99);
    put(actual, x, 2, 1, 99);
  }
  EXPECT_EQ(compare(reference, actual, {}).difference.bias, -80.0 / 800.0);
}

TEST(Verdict, ARegionHasItsOwnCodeValues) {
  const platform::PngImage reference = plain(100, 60, 100);
  const platform::PngImage actual = with_added(reference, 2, 2);
  game::Expectations expected;
  game::Tolerance loose;
  loose.code_values = 2;
  loose.bias = 1.0;
  expected.regions = {{"left", {0, 0, 50, 60}, loose}};
  const Comparison found = compare(reference, actual, expected);
  ASSERT_EQ(found.parts.size(), 2u);
  EXPECT_EQ(found.parts[0].difference.pixels_rounded, 0.5);
  EXPECT_EQ(found.parts[0].difference.bias, 1.0);
  EXPECT_EQ(found.parts[1].difference.pixels_rounded, 0.0);
  EXPECT_EQ(found.flip.errors[30 * 100 + 20], 0.0f);
  EXPECT_GT(found.flip.errors[30 * 100 + 80], 0.0f);
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

TEST(Verdict, EachRegionIsJudgedByItsOwnTolerance) {
  const platform::PngImage reference = plain(100, 60, 100);
  platform::PngImage actual = reference;
  for (std::uint32_t x = 10; x < 20; ++x) put(actual, x, 30, 0, 140);  // 10 pixels in "left"
  put(actual, 80, 30, 0, 120);                                         // one elsewhere
  game::Expectations expected;
  expected.tolerance = {1.0, 1.0, 1.0, 0.001, 8};
  game::Tolerance loose = expected.tolerance;
  loose.pixels_over = 0.02;
  expected.regions = {{"left", {0, 0, 50, 60}, loose}, {"over it", {0, 0, 60, 60}, {}}};
  const Comparison found = compare(reference, actual, expected);
  ASSERT_EQ(found.parts.size(), 3u);
  EXPECT_EQ(found.parts[0].name, "left");
  EXPECT_DOUBLE_EQ(found.parts[0].difference.pixels_over, 10.0 / 3000.0);
  EXPECT_EQ(found.parts[0].difference.largest, 40);
  EXPECT_EQ(found.parts[1].difference.pixels_over, 0.0);  // 10 columns that "left" does not have
  EXPECT_EQ(found.parts[2].name, "elsewhere");
  EXPECT_DOUBLE_EQ(found.parts[2].difference.pixels_over, 1.0 / 2400.0);
  EXPECT_EQ(found.parts[2].difference.largest, 20);
  EXPECT_DOUBLE_EQ(found.difference.pixels_over, 11.0 / 6000.0);
  EXPECT_EQ(beyond(found.difference, found.parts, expected), "");
  expected.regions[0].tolerance.pixels_over = 0.003;
  EXPECT_EQ(beyond(found.difference, found.parts, expected).rfind("left: share", 0), 0u);
  expected.regions[0].tolerance.pixels_over = 1.0;
  expected.tolerance.pixels_over = 0.0;
  EXPECT_EQ(beyond(found.difference, found.parts, expected).rfind("elsewhere: share", 0), 0u);
}

platform::PngImage noise(std::uint32_t width, std::uint32_t height, unsigned seed) {
  platform::PngImage image = plain(width, height, 255);
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (i % 4 != 3) image.pixels[i] = static_cast<std::uint8_t>(random() % 256);
  return image;
}

TEST(Verdict, APictureIsFoundWithinTheStatedShift) {
  // Both are cut out of one larger picture.
  const platform::PngImage whole = noise(60, 50, 3);
  const auto cut = [&](int left, int top) {
    platform::PngImage out = plain(40, 30, 255);
    for (std::uint32_t y = 0; y < 30; ++y)
      for (std::uint32_t x = 0; x < 40; ++x)
        for (int c = 0; c < 3; ++c)
          put(out, x, y, c,
              whole.pixels[((y + static_cast<std::size_t>(top)) * 60 + x +
                            static_cast<std::size_t>(left)) *
                               4 +
                           static_cast<std::size_t>(c)]);
    return out;
  };
  const platform::PngImage reference = cut(8, 8);
  game::Expectations expected;
  for (const Shift at : {Shift{0, 0}, Shift{1, 0}, Shift{-3, 2}, Shift{3, 3}, Shift{0, -3}}) {
    platform::PngImage actual = cut(8 - at.dx, 8 - at.dy);
    expected.shift = 3;
    const Comparison found = compare(reference, actual, expected);
    EXPECT_EQ(found.shift, at);
    EXPECT_TRUE(found.difference.equal()) << at.dx << " " << at.dy;
    expected.shift = 0;
    const Comparison unmoved = compare(reference, actual, expected);
    EXPECT_EQ(unmoved.shift, std::nullopt);
    EXPECT_EQ(unmoved.difference.equal(), at == Shift{});
    // A pixel that is wrong is seen where it is in the reference.
    expected.shift = 3;
    put(actual, static_cast<std::uint32_t>(20 + at.dx), static_cast<std::uint32_t>(15 + at.dy), 0,
        static_cast<std::uint8_t>(reference.pixels[(15 * 40 + 20) * 4] ^ 0x80));
    const Comparison wrong = compare(reference, actual, expected);
    EXPECT_EQ(wrong.difference.largest, 128);
    EXPECT_EQ(std::max_element(wrong.flip.errors.begin(), wrong.flip.errors.end()) -
                  wrong.flip.errors.begin(),
              15 * 40 + 20);
  }
}

TEST(Verdict, OfEqualShiftsTheNearestIsTaken) {
  game::Expectations expected;
  expected.shift = 5;
  EXPECT_EQ(compare(plain(40, 20, 7), plain(40, 20, 90), expected).shift, Shift{});
}

TEST(Verdict, APictureBeyondTheStatedShiftIsDifferent) {
  platform::PngImage left = plain(40, 30, 0), right = left;
  for (std::uint32_t y = 0; y < 30; ++y) {
    put(left, 10, y, 0, 255);
    put(right, 14, y, 0, 255);
  }
  game::Expectations expected;
  expected.shift = 3;
  EXPECT_FALSE(compare(left, right, expected).difference.equal());
  expected.shift = 4;
  EXPECT_TRUE(compare(left, right, expected).difference.equal());
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
