#include "game/openexr/read_exr.h"

#include <gtest/gtest.h>

#include <test_paths.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <random>
#include <string>
#include <utility>

#include "game/panorama/load_panorama.h"
#include "game/panorama/radiance_hdr.h"
#include "tests/folder.h"
#include "tests/game/openexr/sample_values.h"

namespace skerry::game {
namespace {

constexpr std::uint32_t kColumns = kSampleColumns, kRows = kSampleColumns / 2;

/// The folder of what samples.cpp writes.
const std::filesystem::path& samples() {
  static const Folder folder;
  static const bool made =
      std::system((SKERRY_BINARY_DIR "/skerry_exr_samples " + folder.path().string()).c_str()) == 0;
  EXPECT_TRUE(made);
  return folder.path();
}

std::string why(const std::string& name) {
  const Result<render::Panorama> read = read_exr(samples() / (name + ".exr"));
  return read ? "" : read.error().message;
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

glm::vec3 expected(std::uint32_t column, std::uint32_t row) {
  const int x = static_cast<int>(column), y = static_cast<int>(row);
  return {sample_value(x, y, 0), sample_value(x, y, 1), sample_value(x, y, 2)};
}

/// Largest difference of a file's texels from the samples', the black ones outside a box too.
float off_by(const std::string& name, std::uint32_t x0 = 0, std::uint32_t y0 = 0,
             std::uint32_t x1 = kColumns, std::uint32_t y1 = kRows) {
  const Result<render::Panorama> read = read_exr(samples() / (name + ".exr"));
  EXPECT_TRUE(read) << name << ": " << read.error().message;
  if (!read || read->columns != kColumns || read->rows != kRows) return 1e9f;
  float most = 0.0f;
  for (std::uint32_t y = 0; y < kRows; ++y)
    for (std::uint32_t x = 0; x < kColumns; ++x) {
      const bool inside = x >= x0 && x < x1 && y >= y0 && y < y1;
      const glm::vec3 off = glm::abs(read->at(x, y) - (inside ? expected(x, y) : glm::vec3(0.0f)));
      most = std::max({most, off.x, off.y, off.z});
    }
  return most;
}

TEST(ReadExr, KeepsTheTexelsOfEveryLosslessWayToStoreThem) {
  for (const char* name :
       {"none", "rle", "zips", "zip", "piz", "pxr24", "upwards", "tiled", "parts"})
    EXPECT_EQ(off_by(name), 0.0f) << name;
}

TEST(ReadExr, IsNearWhereTheFileIsLossy) {
  for (const char* name : {"dwaa", "dwab"}) {
    EXPECT_GT(off_by(name), 0.0f) << name;
    EXPECT_LT(off_by(name), 0.1f) << name;
  }
}

TEST(ReadExr, PutsTheDataWindowIntoTheDisplayWindow) {
  EXPECT_EQ(off_by("part", 3, 5, 41, 21), 0.0f);
  EXPECT_EQ(off_by("beyond"), 0.0f);
}

TEST(ReadExr, TakesOneChannelForAllThree) {
  const Result<render::Panorama> read = read_exr(samples() / "grey.exr");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->at(9, 4), glm::vec3(sample_value(9, 4, 0)));
}

TEST(ReadExr, WhatCannotBeCountsAsBlackOrBrightest) {
  const Result<render::Panorama> read = read_exr(samples() / "odd.exr");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->mended, 3u);
  EXPECT_EQ(read->at(1, 0), glm::vec3(0.0f, expected(1, 0).y, expected(1, 0).z));
  EXPECT_EQ(read->at(2, 0).y, render::kMostPanoramaRadiance);
  EXPECT_EQ(read->at(3, 0).z, 0.0f);
}

/// Columns: XYZ of red, green and blue of which white has Y = 1. Source: SMPTE RP 177.
glm::dmat3 xyz_of(glm::dvec2 red, glm::dvec2 green, glm::dvec2 blue, glm::dvec2 white) {
  const auto direction = [](glm::dvec2 c) { return glm::dvec3(c, 1.0 - c.x - c.y) / c.y; };
  const glm::dmat3 unscaled(direction(red), direction(green), direction(blue));
  const glm::dvec3 scale = glm::inverse(unscaled) * direction(white);
  return {unscaled[0] * scale.x, unscaled[1] * scale.y, unscaled[2] * scale.z};
}

TEST(ReadExr, TurnsOtherChromaticitiesIntoThoseOfRec709) {
  const Result<render::Panorama> read = read_exr(samples() / "aces.exr");
  ASSERT_TRUE(read) << read.error().message;
  const glm::dmat3 turn =
      glm::inverse(xyz_of({0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290})) *
      xyz_of({0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.077}, {0.32168, 0.33767});
  for (std::uint32_t x = 0; x < kColumns; ++x) {
    const glm::dvec3 want = glm::max(turn * glm::dvec3(expected(x, 7)), glm::dvec3(0.0));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(read->at(x, 7)[c], want[c], 2e-5) << x;
  }
}

TEST(ReadExr, SaysInOneLineWhatItDoesNotTake) {
  EXPECT_NE(why("cube").find("cube"), std::string::npos) << why("cube");
  EXPECT_NE(why("deep").find("flatten"), std::string::npos) << why("deep");
  EXPECT_NE(why("depth").find("no channels R, G and B"), std::string::npos) << why("depth");
  EXPECT_NE(why("chroma").find("RGB"), std::string::npos) << why("chroma");
  EXPECT_NE(why("wide").find("twice as wide"), std::string::npos) << why("wide");
  EXPECT_NE(why("huge").find("largest"), std::string::npos) << why("huge");
  EXPECT_NE(why("missing").find("check the path"), std::string::npos) << why("missing");
  const Result<render::Panorama> hdr = read_exr(SKERRY_SOURCE_DIR "/tests/scenes/evening.hdr");
  ASSERT_FALSE(hdr);
  EXPECT_NE(hdr.error().message.find("OpenEXR gave up"), std::string::npos) << hdr.error().message;
}

TEST(ReadExr, EveryCutFileIsRefused) {
  const Folder folder;
  // The last third of the tiled file holds smaller levels, which nobody asks for.
  const std::pair<const char*, std::size_t> cut[] = {{"zip", 8}, {"tiled", 5}, {"parts", 8}};
  for (const auto& [name, most] : cut) {
    const std::string whole = content_of(samples() / (std::string(name) + ".exr"));
    for (std::size_t eighths = 0; eighths < most; ++eighths) {
      std::ofstream(folder / "cut.exr", std::ios::binary)
          << whole.substr(0, whole.size() * eighths / 8);
      EXPECT_FALSE(read_exr(folder / "cut.exr")) << name << ' ' << eighths;
    }
  }
}

TEST(ReadExr, ADamagedFileIsRefusedOrReadAndHarmsNobody) {
  const Folder folder;
  std::mt19937 random(7);
  int refused = 0;
  for (const char* name : {"piz", "tiled", "parts", "dwaa", "part"}) {
    const std::string whole = content_of(samples() / (std::string(name) + ".exr"));
    for (int i = 0; i < 40; ++i) {
      std::string bytes = whole;
      // Half of them in the header, where lengths and windows are.
      const std::size_t reach =
          i % 2 == 0 ? std::min<std::size_t>(400, bytes.size()) : bytes.size();
      for (int bit = 0; bit < 1 + i % 5; ++bit)
        bytes[random() % reach] ^= static_cast<char>(1u << random() % 8);
      std::ofstream(folder / "damaged.exr", std::ios::binary) << bytes;
      const Result<render::Panorama> read = read_exr(folder / "damaged.exr");
      if (read) continue;
      ++refused;
      EXPECT_FALSE(read.error().message.empty());
      EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << read.error().message;
    }
  }
  EXPECT_GT(refused, 60);
}

TEST(ReadExr, OnePictureInTwoFormatsIsOneSky) {
  SceneOptions scene;
  scene.ambient = SKERRY_SOURCE_DIR "/tests/scenes/evening.hdr";
  const auto hdr = load_panorama(scene);
  scene.ambient = SKERRY_SOURCE_DIR "/tests/scenes/evening.exr";
  const auto exr = load_panorama(scene);
  ASSERT_TRUE(hdr) << hdr.error().message;
  ASSERT_TRUE(exr) << exr.error().message;
  // A byte of a shared exponent, and the half's rounding.
  for (double azimuth = 0.0; azimuth < 6.3; azimuth += 0.07)
    for (double y = -0.9; y < 1.0; y += 0.2) {
      const double across = std::sqrt(1.0 - y * y);
      const glm::dvec3 dir(across * std::cos(azimuth), y, across * std::sin(azimuth));
      const glm::dvec3 a = (*hdr)->radiance(dir), b = (*exr)->radiance(dir);
      const double brightest = std::max({b.x, b.y, b.z});
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], brightest / 128.0);
    }
}

}  // namespace
}  // namespace skerry::game
