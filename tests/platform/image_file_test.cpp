#include "engine/platform/image_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "engine/platform/png_plain.h"
#include "tests/folder.h"

namespace skerry::platform {
namespace {

namespace fs = std::filesystem;

class ImageFile : public testing::Test {
 protected:
  const Folder dir_;
};

std::vector<std::uint8_t> random_bytes(std::size_t count) {
  std::mt19937 random(7);
  std::vector<std::uint8_t> bytes(count);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST_F(ImageFile, RgbaAndItsTextsComeBackAsWritten) {
  const auto pixels = random_bytes(37 * 19 * 4);
  const std::vector<PngText> text{{"Command", "skerry shot --seed 'a b'"},
                                  {"Seed", "bl\xc3\xa5skj\xc3\xa6r"}};
  ASSERT_TRUE(write_png(dir_ / "a.png", {37, 19, 4, pixels}, text));
  const auto image = read_png(dir_ / "a.png");
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 37u);
  EXPECT_EQ(image->height, 19u);
  EXPECT_EQ(image->pixels, pixels);
  ASSERT_EQ(image->text.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(image->text[i].key, text[i].key);
    EXPECT_EQ(image->text[i].text, text[i].text);
  }
}

TEST_F(ImageFile, RgbComesBackOpaque) {
  const auto pixels = random_bytes(5 * 3 * 3);
  ASSERT_TRUE(write_png(dir_ / "a.png", {5, 3, 3, pixels}));
  const auto image = read_png(dir_ / "a.png");
  ASSERT_TRUE(image) << image.error().message;
  for (std::size_t i = 0; i < 15; ++i) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(image->pixels[i * 4 + c], pixels[i * 3 + c]);
    EXPECT_EQ(image->pixels[i * 4 + 3], 255);
  }
}

TEST(EncodePng, WhatLibpngWroteIsReadByLibdeflate) {
  std::mt19937 random(2);
  for (const std::uint32_t channels : {3u, 4u}) {
    std::vector<std::uint8_t> pixels(331 * 210 * channels);
    for (std::size_t i = 0; i < pixels.size(); ++i)  // smooth in part, as pictures are
      pixels[i] = static_cast<std::uint8_t>(i % 7 == 0 ? random() : i / 50);
    const auto written = encode_png({331, 210, channels, pixels}, {});
    ASSERT_TRUE(written);
    const auto read =
        read_plain_png({reinterpret_cast<const char*>(written->data()), written->size()});
    ASSERT_TRUE(read);
    for (std::size_t i = 0; i < 331 * 210; ++i)
      for (std::size_t c = 0; c < 4; ++c)
        ASSERT_EQ(read->pixels[i * 4 + c], c < channels ? pixels[i * channels + c] : 255);
  }
}

TEST(EncodePng, ALargePictureTakesLittleMemoryBesideItsFile) {
  const std::vector<std::uint8_t> pixels(std::size_t{4096} * 4096 * 4);  // 64 MiB, 64 KiB as PNG
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t limit = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + (8u << 20);
    const rlimit most{limit, limit};
    if (::setrlimit(RLIMIT_AS, &most) != 0) ::_exit(2);
    ::_exit(encode_png({4096, 4096, 4, pixels}) ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "of 8 MiB";
}

TEST_F(ImageFile, TheFileSaysItIsSrgbAndTheSamePixelsGiveTheSameBytes) {
  const auto pixels = random_bytes(8 * 8 * 4);
  ASSERT_TRUE(write_png(dir_ / "a.png", {8, 8, 4, pixels}));
  ASSERT_TRUE(write_png(dir_ / "b.png", {8, 8, 4, pixels}));
  const auto a = read_text(dir_ / "a.png", 1 << 20);
  const auto b = read_text(dir_ / "b.png", 1 << 20);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(*a, *b);
  EXPECT_NE(a->find("sRGB"), std::string::npos);
}

TEST_F(ImageFile, AnUnwritablePathIsNamedAndNothingIsLeft) {
  const std::vector<std::uint8_t> pixels(4);
  const auto missing = write_png(dir_ / "no" / "a.png", {1, 1, 4, pixels});
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("no/a.png"), std::string::npos);
  EXPECT_NE(missing.error().message.find("No such file"), std::string::npos);
  const auto folder = write_png(dir_.path(), {1, 1, 4, pixels});
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().message.find("directory"), std::string::npos);
  const auto full = write_png("/dev/full/a.png", {1, 1, 4, pixels});
  EXPECT_FALSE(full);
  EXPECT_TRUE(fs::is_empty(dir_.path()));
}

TEST_F(ImageFile, EveryTruncationAndManyCorruptionsAreErrorsNotCrashes) {
  const auto pixels = random_bytes(16 * 16 * 4);
  ASSERT_TRUE(write_png(dir_ / "a.png", {16, 16, 4, pixels}));
  const auto whole = read_text(dir_ / "a.png", 1 << 20);
  ASSERT_TRUE(whole);
  for (std::size_t length = 0; length < whole->size(); ++length) {
    ASSERT_TRUE(write_text(dir_ / "cut.png", whole->substr(0, length)));
    ASSERT_FALSE(read_png(dir_ / "cut.png")) << length;
  }
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    std::string damaged = *whole;
    damaged[random() % damaged.size()] ^= static_cast<char>(1 + random() % 255);
    ASSERT_TRUE(write_text(dir_ / "bad.png", damaged));
    const auto image = read_png(dir_ / "bad.png");
    if (image) {
      EXPECT_EQ(image->pixels.size(), std::size_t{image->width} * image->height * 4);
    }
  }
}

/// The beginning of a PNG of RGBA8. libpng checks its limits after the chunk's CRC, so it is right.
std::string png_header(std::uint32_t width, std::uint32_t height) {
  std::string png("\x89PNG\r\n\x1a\n", 8);
  std::string ihdr = "IHDR";
  for (const std::uint32_t edge : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) ihdr += static_cast<char>(edge >> shift);
  ihdr += std::string("\x08\x06\x00\x00\x00", 5);
  std::uint32_t crc = ~0u;
  for (const char c : ihdr) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xEDB88320u : 0u);
  }
  crc = ~crc;
  png += std::string("\x00\x00\x00\x0d", 4) + ihdr;
  for (int shift = 24; shift >= 0; shift -= 8) png += static_cast<char>(crc >> shift);
  return png;
}

TEST_F(ImageFile, AHugeStatedSizeIsRefusedBeforeMemoryIsTaken) {
  const std::string end("\0\0\0\0IEND\xAE\x42\x60\x82", 12);
  ASSERT_TRUE(write_text(dir_ / "huge.png", png_header(65536, 65536) + end));
  const auto image = read_png(dir_ / "huge.png");
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("IHDR"), std::string::npos) << image.error().message;
}

TEST_F(ImageFile, AChunkLongerThanTheFileIsRefusedBeforeMemoryIsTaken) {
  ASSERT_TRUE(write_png(dir_ / "a.png", {2, 2, 4, random_bytes(16)}));
  std::string png = *read_text(dir_ / "a.png", 1 << 20);
  // Between the pixels and the end: text of 1.9 GB.
  png.insert(png.size() - 12, std::string("\x75\x30\x00\x25tEXtx", 9));
  ASSERT_TRUE(write_text(dir_ / "text.png", png));
  const auto image = read_png(dir_ / "text.png");
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("chunk"), std::string::npos) << image.error().message;
}

TEST_F(ImageFile, ASizeThatTheFileCannotHoldIsRefusedBeforeMemoryIsTaken) {
  // An empty chunk of rows and the end's, so that libpng has read all it wants to know.
  const std::string rest("\0\0\0\0IDAT\x35\xAF\x06\x1E\0\0\0\0IEND\xAE\x42\x60\x82", 24);
  ASSERT_TRUE(write_text(dir_ / "short.png", png_header(32768, 32768) + rest));
  const auto image = read_png(dir_ / "short.png");
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("too short"), std::string::npos) << image.error().message;
}

}  // namespace
}  // namespace skerry::platform
