#include "tools/measure/image.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "engine/platform/image_file.h"
#include "tests/folder.h"
#include "tools/measure/color.h"

namespace skerry::measure {
namespace {

Image all_bytes() {
  Image image{16, 16, {}};
  for (int i = 0; i < 256; ++i) {
    const auto byte = static_cast<std::uint8_t>(i);
    image.rgba.insert(image.rgba.end(), {byte, static_cast<std::uint8_t>(255 - i), std::uint8_t{7},
                                         std::uint8_t{255}});
  }
  return image;
}

TEST(Image, EveryByteComesBackFromLinearLight) {
  const Image image = all_bytes();
  const Picture picture = picture_from(image);
  EXPECT_NEAR(picture.pixels[128].x, 0.215861, 1e-6);  // ((128/255 + 0.055) / 1.055)^2.4
  EXPECT_EQ(shrink(image, 1).rgba, image.rgba);
}

TEST(Image, AFileHoldsTheImage) {
  const Folder folder;
  const std::filesystem::path path = folder / "image.png";
  const Image image = all_bytes();
  ASSERT_TRUE(write_image(path, image));
  const Result<platform::PngImage> read = platform::read_png(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->width, 16u);
  EXPECT_EQ(read->height, 16u);
  EXPECT_EQ(read->pixels, image.rgba);
}

TEST(Image, DifferenceIsAmplifiedPerChannel) {
  const Image a{1, 1, {10, 200, 30, 255}}, b{1, 1, {13, 100, 30, 255}};
  EXPECT_EQ(amplified_difference(a, b, 8).rgba, (std::vector<std::uint8_t>{24, 255, 0, 255}));
  EXPECT_EQ(amplified_difference(b, a, 8).rgba, amplified_difference(a, b, 8).rgba);
}

TEST(Image, HeatRisesInBrightness) {
  EXPECT_EQ(heat_color(0.0), (std::array<std::uint8_t, 3>{0, 0, 0}));
  EXPECT_EQ(heat_color(1.0), (std::array<std::uint8_t, 3>{255, 255, 255}));
  EXPECT_EQ(heat_color(7.0), heat_color(1.0));
  EXPECT_EQ(heat_color(std::numeric_limits<double>::quiet_NaN()), heat_color(0.0));
  double last = -1.0;
  for (int i = 0; i <= 10; ++i) {
    const auto color = heat_color(i / 10.0);
    const double lightness =
        lab_from_linear({linear_from_srgb(color[0] / 255.0), linear_from_srgb(color[1] / 255.0),
                         linear_from_srgb(color[2] / 255.0)})
            .x;
    EXPECT_GT(lightness, last);
    EXPECT_NEAR(lightness, 10.0 * i, 4.0);
    last = lightness;
  }
  const Image map = heat_map({2, 1, {0.0f, 1.0f}});
  EXPECT_EQ(map.rgba, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 255, 255}));
}

TEST(Image, ShrinkingAveragesLight) {
  // 3 x 2: a block of black and white, and a rest one pixel wide.
  Image image{3, 2, {}};
  for (const std::uint8_t grey : std::to_array<std::uint8_t>({255, 0, 0, 0, 255, 255}))
    image.rgba.insert(image.rgba.end(), {grey, grey, grey, 255});
  const Image small = shrink(image, 2);
  EXPECT_EQ(small.width, 2u);
  EXPECT_EQ(small.height, 1u);
  EXPECT_EQ(small.rgba, (std::vector<std::uint8_t>{188, 188, 188, 255, 188, 188, 188, 255}));
}

}  // namespace
}  // namespace skerry::measure
