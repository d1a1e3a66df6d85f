#include "engine/platform/png_plain.h"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace skerry::platform {
namespace {

/// What libpng reads, by its simplest way. None: it refuses the file.
std::optional<std::vector<std::uint8_t>> by_libpng(const std::string& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, file.data(), file.size()) == 0) return std::nullopt;
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  const bool read = png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) != 0;
  if (!read) return std::nullopt;
  return pixels;
}

std::string big_endian(std::uint32_t value) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift);
  return out;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  const auto crc =
      ::crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + checked +
         big_endian(static_cast<std::uint32_t>(crc));
}

/// A file of filtered rows as they are given.
struct File {
  std::uint32_t width = 0, height = 0;
  int channels = 4;
  std::string rows;
  std::size_t bytes_a_chunk = 1 << 20;
  std::string before, between, after;  ///< chunks among those of the pixels

  std::string bytes() const {
    uLongf size = compressBound(rows.size());
    std::string deflated(size, '\0');
    compress(reinterpret_cast<Bytef*>(deflated.data()), &size,
             reinterpret_cast<const Bytef*>(rows.data()), rows.size());
    deflated.resize(size);
    std::string pixels;
    for (std::size_t at = 0; at < size; at += bytes_a_chunk) {
      if (at > 0) pixels += between;
      pixels += chunk("IDAT", deflated.substr(at, bytes_a_chunk));
    }
    const std::string kind{8, static_cast<char>(channels == 4 ? 6 : 2), 0, 0, 0};
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", big_endian(width) + big_endian(height) + kind) +
           before + pixels + after + chunk("IEND", "");
  }
};

/// Rows of random bytes, each behind a random filter.
File random_file(std::mt19937& random, int channels) {
  File file;
  file.width = static_cast<std::uint32_t>(1 + random() % 40);
  file.height = static_cast<std::uint32_t>(1 + random() % 20);
  file.channels = channels;
  file.bytes_a_chunk = 1 + random() % 200;
  for (std::uint32_t y = 0; y < file.height; ++y) {
    file.rows += static_cast<char>(random() % 5);
    for (std::uint32_t i = 0; i < file.width * static_cast<std::uint32_t>(channels); ++i)
      file.rows += static_cast<char>(random());
  }
  return file;
}

TEST(PlainPng, EveryFilterIsReadAsLibpngReadsIt) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    const File file = random_file(random, round % 2 == 0 ? 3 : 4);
    const auto image = read_plain_png(file.bytes());
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, file.width);
    EXPECT_EQ(image->height, file.height);
    ASSERT_EQ(image->pixels, by_libpng(file.bytes()).value()) << round;
  }
}

TEST(PlainPng, AnotherKindAndWhatIsDamagedAreLeftToLibpng) {
  std::mt19937 random(3);
  File file = random_file(random, 3);
  ASSERT_TRUE(read_plain_png(file.bytes()));
  file.before = chunk("tEXt", std::string("Key\0text", 8)) + chunk("tIME", "1234567");
  const auto with_text = read_plain_png(file.bytes());
  ASSERT_TRUE(with_text);
  ASSERT_EQ(with_text->text.size(), 1u);
  EXPECT_TRUE(with_text->text[0].key == "Key" && with_text->text[0].text == "text");
  const std::string zero(1, '\0');
  for (const std::string& other :
       {chunk("tRNS", "123456"), chunk("zTXt", "Key" + zero + zero + "x"), chunk("PLTE", "123"),
        chunk("iTXt", "Key" + zero + "\x01" + zero + zero + zero + "x"), chunk("tEXt", "Key"),
        std::string("\0\0\0\4", 4) + "gAMAabcdCRC!"}) {
    file.before = other;
    EXPECT_FALSE(read_plain_png(file.bytes())) << other.substr(4, 4);
  }
  file.before.clear();
  file.bytes_a_chunk = 20;
  ASSERT_TRUE(read_plain_png(file.bytes()));
  file.between = chunk("tIME", "1234567");
  EXPECT_FALSE(read_plain_png(file.bytes())) << "pixels that lie apart";
  file.between.clear();
  file.rows[0] = 5;
  EXPECT_FALSE(read_plain_png(file.bytes())) << "no filter";
  file.rows[0] = 0;
  file.rows += 'x';
  EXPECT_FALSE(read_plain_png(file.bytes())) << "a byte too many";
  file.rows.resize(file.rows.size() - 2);
  EXPECT_FALSE(read_plain_png(file.bytes())) << "a byte too few";
}

TEST(PlainPng, NothingIsReadThatLibpngRefuses) {
  std::mt19937 random(4);
  const std::string whole = random_file(random, 4).bytes();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] ^= static_cast<char>(1 + random() % 255);
    EXPECT_FALSE(read_plain_png(damaged)) << at;
    EXPECT_FALSE(read_plain_png(whole.substr(0, at))) << at;
  }
}

}  // namespace
}  // namespace skerry::platform
