#include "engine/render/scene/block_textures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <test_paths.h>
#include "tools/textures/color.h"
#include "tools/textures/layers.h"
#include "tools/textures/noise.h"

namespace skerry::render {
namespace {

constexpr int kEdge = 32, kMips = 6, kLayers = 256;

struct Rgba {
  int r, g, b, a;
};

// A texel of the embedded file, found from the documented layout alone.
Rgba texel(int layer, int mip, int x, int y) {
  const std::span<const std::byte> texels = block_textures().texels;
  std::size_t offset = 0;
  for (int m = 0; m < mip; ++m)
    offset += static_cast<std::size_t>(kEdge >> m) * (kEdge >> m) * kLayers * 4;
  const int edge = kEdge >> mip;
  offset +=
      (static_cast<std::size_t>(layer) * edge * edge + static_cast<std::size_t>(y) * edge + x) * 4;
  const auto at = [&](std::size_t i) { return std::to_integer<int>(texels[offset + i]); };
  return {at(0), at(1), at(2), at(3)};
}

template <class Visit>
void for_texels(int layer, int mip, Visit&& visit) {
  for (int y = 0; y < kEdge >> mip; ++y)
    for (int x = 0; x < kEdge >> mip; ++x) visit(texel(layer, mip, x, y), x, y);
}

const std::vector<std::string>& names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> all;
    for (const textures::Layer& layer : textures::paint_layers()) all.push_back(layer.name);
    return all;
  }();
  return kNames;
}

bool ends_with_any(const std::string& name, std::initializer_list<const char*> ends) {
  return std::any_of(ends.begin(), ends.end(),
                     [&](const char* end) { return name.ends_with(end); });
}

// Plants stand alone; the other cut-outs tile.
bool is_plant(int layer) {
  static const std::set<std::string> kPlants = {
      "tall_grass",   "fern",  "flower_red", "flower_yellow", "flower_blue",
      "flower_white", "reed",  "dead_bush",  "glow_shroom",   "glow_fern",
      "heather",      "torch", "wheat",      "kelp"};
  return kPlants.contains(names()[layer]);
}
// Seen through: alpha says how much light the surface catches, it is no shape.
bool is_translucent(int layer) {
  return names()[layer] == "water" || names()[layer].ends_with("glass");
}
bool is_leaves(int layer) {
  return names()[layer].ends_with("_leaves");
}
bool is_cutout(int layer) {
  return is_plant(layer) || is_leaves(layer) ||
         ends_with_any(names()[layer], {"_lattice", "_grate"});
}

double linear(int coded) {
  const double c = coded / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
double luminance(const Rgba& t) {
  return 0.2126 * linear(t.r) + 0.7152 * linear(t.g) + 0.0722 * linear(t.b);
}

struct Light {
  double mean, deviation;
};
// Over the covered texels of a mip.
Light light_of(int layer, int mip) {
  double sum = 0, squares = 0, count = 0;
  for_texels(layer, mip, [&](const Rgba& t, int, int) {
    if (t.a < 128) return;
    sum += luminance(t);
    squares += luminance(t) * luminance(t);
    count += 1;
  });
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

// Share of a first mip's texels.
double coverage(int layer) {
  double covered = 0;
  for_texels(layer, 0, [&](const Rgba& t, int, int) { covered += t.a >= 128 ? 1 : 0; });
  return covered / (kEdge * kEdge);
}

// Alpha as a device filters it between four texels of a texture that repeats. @param u, v 0..1
double filtered_alpha(int layer, int mip, double u, double v) {
  const int edge = kEdge >> mip;
  const double x = u * edge - 0.5 + edge, y = v * edge - 0.5 + edge;
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const auto at = [&](int column, int row) {
    return texel(layer, mip, column % edge, row % edge).a / 255.0;
  };
  const double right = x - left, low = y - top;
  return (at(left, top) * (1.0 - right) + at(left + 1, top) * right) * (1.0 - low) +
         (at(left, top + 1) * (1.0 - right) + at(left + 1, top + 1) * right) * low;
}
// Share of a texture that is seen at a level between two mips.
double filtered_coverage(int layer, double level) {
  constexpr int kPlaces = 150;
  const int fine = static_cast<int>(level), coarse = std::min(fine + 1, kMips - 1);
  int covered = 0;
  for (int j = 0; j < kPlaces; ++j) {
    for (int i = 0; i < kPlaces; ++i) {
      const double u = (i + 0.5) / kPlaces, v = (j + 0.5) / kPlaces;
      double alpha = filtered_alpha(layer, fine, u, v);
      if (level > fine) alpha += (level - fine) * (filtered_alpha(layer, coarse, u, v) - alpha);
      covered += alpha >= 0.5 ? 1 : 0;
    }
  }
  return covered / static_cast<double>(kPlaces * kPlaces);
}

double mean_alpha(int layer, int mip) {
  double sum = 0;
  for_texels(layer, mip, [&](const Rgba& t, int, int) { sum += t.a; });
  return sum / ((kEdge >> mip) * (kEdge >> mip));
}

double difference(const Rgba& a, const Rgba& b) {
  if (a.a != b.a) return 255;  // an outline counts as the hardest edge
  return (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b)) / 3.0;
}

// Mean difference between column (or row) `line` and the next one; line 31 is the wrap-around edge.
double seam(int layer, bool rows, int line) {
  double sum = 0;
  for (int i = 0; i < kEdge; ++i) {
    const int next = (line + 1) % kEdge;
    sum += rows ? difference(texel(layer, 0, i, line), texel(layer, 0, i, next))
                : difference(texel(layer, 0, line, i), texel(layer, 0, next, i));
  }
  return sum / kEdge;
}
// A real seam is several times as hard as any line inside; one line in 32 is the hardest by chance.
bool wraps(int layer, bool rows) {
  double hardest = 0;
  for (int line = 0; line + 1 < kEdge; ++line) hardest = std::max(hardest, seam(layer, rows, line));
  return seam(layer, rows, kEdge - 1) <= 1.25 * hardest;
}

std::vector<std::byte> small_file() {
  std::vector<std::byte> file;
  for (const std::uint32_t word : {kBlockTexturesMagic, kBlockTexturesVersion, 3u, 4u})
    for (int shift = 0; shift < 32; shift += 8)
      file.push_back(static_cast<std::byte>(word >> shift));
  file.resize(file.size() + 3 * 4 * (16 + 4 + 1));
  return file;
}

}  // namespace

TEST(BlockTextures, HoldsAllLayersWithFullMipChains) {
  const BlockTextures textures = block_textures();
  EXPECT_EQ(textures.edge, 32u);
  EXPECT_EQ(textures.layers, 256u);
  EXPECT_EQ(textures.mips, 6u);
  EXPECT_EQ(textures.texels.size(), 256u * 4u * (1024u + 256u + 64u + 16u + 4u + 1u));
}

TEST(BlockTextures, HaveTheSameBytesFromEveryCompilerAndOptimisationLevel) {
  // FNV-1a of all texels. A new look means a new number here; anything else that changes it is a
  // bug.
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::byte byte : block_textures().texels)
    hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
  EXPECT_EQ(hash, 0xc5dbb2c7ec02a90u) << std::hex << "0x" << hash;
}

TEST(BlockTextures, AreWhatThePainterPaints) {
  const auto layers = textures::paint_layers();
  ASSERT_EQ(layers.size(), static_cast<std::size_t>(kLayers));
  for (int layer = 0; layer < kLayers; ++layer) {
    const auto& first = layers[layer].canvas.at(5, 9);
    const Rgba stored = texel(layer, 0, 5, 9);
    ASSERT_NEAR(stored.a, first.alpha * 255.0f, 0.51) << names()[layer];
    if (stored.a == 255) {
      ASSERT_NEAR(stored.r, first.color.r * 255.0f, 1.0) << names()[layer];
    }
  }
}

TEST(BlockTextures, OpaqueLayersAreOpaqueInEveryMip) {
  for (int layer = 0; layer < kLayers; ++layer) {
    if (is_cutout(layer) || is_translucent(layer)) continue;
    for (int mip = 0; mip < kMips; ++mip)
      for_texels(layer, mip, [&](const Rgba& t, int, int) {
        ASSERT_EQ(t.a, 255) << names()[layer] << " mip " << mip;
      });
  }
}

TEST(BlockTextures, CutOutsAreAllOrNothingInTheFirstMip) {
  for (int layer = 0; layer < kLayers; ++layer) {
    if (!is_cutout(layer)) continue;
    int holes = 0;
    for_texels(layer, 0, [&](const Rgba& t, int, int) {
      ASSERT_TRUE(t.a == 0 || t.a == 255) << names()[layer];
      holes += t.a == 0 ? 1 : 0;
    });
    EXPECT_GT(holes, 0) << names()[layer];
    EXPECT_LT(holes, kEdge * kEdge) << names()[layer];
  }
}

TEST(BlockTextures, AsMuchOfACutOutIsSeenAtEachLevelThatHasAShape) {
  for (int layer = 0; layer < kLayers; ++layer) {
    if (!is_cutout(layer)) continue;
    for (int mip = 1; mip < kMips - 1; ++mip) {
      EXPECT_NEAR(filtered_coverage(layer, mip), coverage(layer), 0.01)
          << names()[layer] << " mip " << mip;
      EXPECT_NEAR(filtered_coverage(layer, mip - 0.5), coverage(layer), 0.08)
          << names()[layer] << " before mip " << mip;
    }
    EXPECT_NEAR(mean_alpha(layer, kMips - 1), 255.0 * coverage(layer), 0.51) << names()[layer];
  }
}

TEST(BlockTextures, WaterAndPanesOfGlassLetNearlyAllLightThrough) {
  for (int layer = 0; layer < kLayers; ++layer) {
    if (!is_translucent(layer)) continue;
    for_texels(layer, 0, [&](const Rgba& t, int x, int y) {
      const bool frame = x == 0 || y == 0 || x == kEdge - 1 || y == kEdge - 1;
      if (frame && names()[layer] != "water") {
        ASSERT_EQ(t.a, 255) << names()[layer];
      } else {
        ASSERT_LE(t.a, 64) << names()[layer];
      }
    });
  }
}

TEST(BlockTextures, WaterAndGlassCatchTheSameLightInEveryMip) {
  for (int layer = 0; layer < kLayers; ++layer) {
    if (!is_translucent(layer)) continue;
    for (int mip = 1; mip < kMips; ++mip)
      EXPECT_NEAR(mean_alpha(layer, mip), mean_alpha(layer, 0), 0.51)
          << names()[layer] << " mip " << mip;
  }
}

TEST(BlockTextures, LeavesHaveAFifthToThreeTenthsOfHoles) {
  for (int layer = 0; layer < kLayers; ++layer) {
    if (!is_leaves(layer)) continue;
    EXPECT_GE(1.0 - coverage(layer), 0.2) << names()[layer];
    EXPECT_LE(1.0 - coverage(layer), 0.3) << names()[layer];
  }
}

TEST(BlockTextures, PlantsStandOnTheBottomRow) {
  for (int layer = 0; layer < kLayers; ++layer) {
    if (!is_plant(layer)) continue;
    int rooted = 0;
    for (int x = 0; x < kEdge; ++x) rooted += texel(layer, 0, x, kEdge - 1).a == 255 ? 1 : 0;
    EXPECT_GT(rooted, 0) << names()[layer];
  }
}

TEST(BlockTextures, ColoursBehindHolesLieAmongTheVisibleOnes) {
  // Filtering mixes them in at the outline: a black one would draw a dark fringe.
  for (int layer = 0; layer < kLayers; ++layer) {
    if (!is_cutout(layer)) continue;
    Rgba low{255, 255, 255, 0}, high{0, 0, 0, 0};
    for_texels(layer, 0, [&](const Rgba& t, int, int) {
      if (t.a == 0) return;
      low = {std::min(low.r, t.r), std::min(low.g, t.g), std::min(low.b, t.b), 0};
      high = {std::max(high.r, t.r), std::max(high.g, t.g), std::max(high.b, t.b), 0};
    });
    for (int mip = 0; mip < kMips; ++mip) {
      for_texels(layer, mip, [&](const Rgba& t, int, int) {
        ASSERT_TRUE(t.r >= low.r && t.g >= low.g && t.b >= low.b)
            << names()[layer] << " mip " << mip;
        ASSERT_TRUE(t.r <= high.r && t.g <= high.g && t.b <= high.b)
            << names()[layer] << " mip " << mip;
      });
    }
  }
}

TEST(BlockTextures, TileWithoutASeam) {
  for (int layer = 0; layer < kLayers; ++layer) {
    const std::string& name = names()[layer];
    // Slabs and plates are framed by a bevel: the joint between two blocks is meant to be seen.
    if (is_plant(layer) || ends_with_any(name, {"_polished", "_plate"})) continue;
    EXPECT_TRUE(wraps(layer, false)) << name << " has a seam between its right and its left edge";
    if (ends_with_any(name, {"grass_side", "snow_side", "mycelium_side"}))
      continue;  // end on dirt below
    EXPECT_TRUE(wraps(layer, true)) << name << " has a seam between its bottom and its top edge";
  }
}

TEST(BlockTextures, MeanLightIsTheSameInEveryMip) {
  for (int layer = 0; layer < kLayers; ++layer) {
    // Cut-outs keep their light only as far as the covered texels of a mip stand for all.
    // The last mip is one texel, rounded to 8 bits: half a step of sRGB is up to 0.0005 for dark
    // colours.
    if (is_plant(layer) || is_translucent(layer)) continue;
    const double mean = light_of(layer, 0).mean,
                 tolerance = (is_cutout(layer) ? 0.06 : 0.008) * mean + 0.0005;
    for (int mip = 1; mip < kMips; ++mip)
      EXPECT_NEAR(light_of(layer, mip).mean, mean, tolerance) << names()[layer] << " mip " << mip;
  }
}

TEST(BlockTextures, ContrastFallsFromMipToMip) {
  for (int layer = 0; layer < kLayers; ++layer) {
    if (is_cutout(layer) || is_translucent(layer)) continue;
    for (int mip = 1; mip < kMips; ++mip)
      EXPECT_LE(light_of(layer, mip).deviation, light_of(layer, mip - 1).deviation + 0.002)
          << names()[layer] << " mip " << mip;
  }
}

TEST(BlockTextures, GroundThatCoversFieldsShowsNoBlotches) {
  // Blotches of eight texels (mip 3) are what the eye finds again in the next block.
  const std::set<std::string> ground = {
      "stone", "gravel",     "dirt",          "grass_top", "dry_grass_top", "snow",
      "ice",   "sand",       "sandstone_top", "red_sand",  "red_rock",      "clay",
      "mud",   "basalt_top", "marble",        "slate",     "limestone",     "mycelium_top",
      "moss",  "peat",       "ash",           "salt"};
  int seen = 0;
  for (int layer = 0; layer < kLayers; ++layer) {
    if (!ground.contains(names()[layer])) continue;
    ++seen;
    const Light light = light_of(layer, 3);
    EXPECT_LT(light.deviation / light.mean, 0.08) << names()[layer];
  }
  EXPECT_EQ(seen, static_cast<int>(ground.size()));
}

TEST(BlockTextures, NoTwoLayersLookAlike) {
  // Judged at half size, as from a few blocks away.
  std::vector<std::vector<Rgba>> seen(kLayers);
  for (int layer = 0; layer < kLayers; ++layer)
    for_texels(layer, 1, [&](const Rgba& t, int, int) { seen[layer].push_back(t); });
  for (int a = 0; a < kLayers; ++a) {
    for (int b = a + 1; b < kLayers; ++b) {
      double sum = 0;
      for (std::size_t i = 0; i < seen[a].size(); ++i) sum += difference(seen[a][i], seen[b][i]);
      ASSERT_GT(sum / static_cast<double>(seen[a].size()), 2.0)
          << names()[a] << " and " << names()[b];
    }
  }
}

TEST(BlockTextures, AreAllListedInTheirDocument) {
  std::ifstream document(std::string(SKERRY_SOURCE_DIR) + "/docs/textures.md");
  std::stringstream text;
  text << document.rdbuf();
  for (int layer = 0; layer < kLayers; ++layer) {
    const std::string row = "| " + std::to_string(layer) + " | " + names()[layer] + " |";
    EXPECT_NE(text.str().find(row), std::string::npos) << "docs/textures.md lacks the row: " << row;
  }
}

TEST(BlockTextures, KeepTheirCoverageByItself) {
  const BlockTextures textures = block_textures();
  const std::vector<std::byte> all = linear_texels(textures), coverage = coverage_texels(textures);
  ASSERT_EQ(coverage.size() * 4, all.size());
  std::set<std::pair<std::byte, std::byte>> values;
  for (std::size_t half = 0; half < coverage.size(); half += 2) {
    values.emplace(coverage[half], coverage[half + 1]);
    ASSERT_EQ(coverage[half], all[half * 4 + 6]) << half;
    ASSERT_EQ(coverage[half + 1], all[half * 4 + 7]) << half;
  }
  EXPECT_GT(values.size(), 100u);  // mips have shares between none and all
}

TEST(BlockTextures, ReadsAFileOfAnotherSize) {
  const std::vector<std::byte> file = small_file();
  const auto parsed = parse_block_textures(file);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->layers, 3u);
  EXPECT_EQ(parsed->edge, 4u);
  EXPECT_EQ(parsed->mips, 3u);
  EXPECT_EQ(parsed->texels.data(), file.data() + 16);
  EXPECT_EQ(parsed->texels.size(), file.size() - 16);
}

TEST(BlockTextures, RejectsADamagedHeader) {
  for (std::size_t byte = 0; byte < 16; ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      std::vector<std::byte> file = small_file();
      file[byte] ^= static_cast<std::byte>(1 << bit);
      EXPECT_FALSE(parse_block_textures(file)) << "bit " << bit << " of byte " << byte;
    }
  }
}

TEST(BlockTextures, RejectsEveryOtherLength) {
  const std::vector<std::byte> file = small_file();
  for (std::size_t size = 0; size < file.size(); ++size)
    EXPECT_FALSE(parse_block_textures(std::span(file).first(size))) << size;
  std::vector<std::byte> longer = file;
  longer.push_back({});
  EXPECT_FALSE(parse_block_textures(longer));
}

TEST(TextureNoise, RepeatsAfterOneTileInEveryDirection) {
  for (const textures::Cells cells : {textures::Cells{2, 2}, {5, 3}, {8, 16}}) {
    for (int i = 0; i < 500; ++i) {
      const float x = textures::unit(i, 0, 1) * 32, y = textures::unit(i, 1, 1) * 32;
      for (const auto& [dx, dy] : {std::pair{32.0f, 0.0f}, {0.0f, 32.0f}, {-64.0f, 32.0f}}) {
        EXPECT_NEAR(textures::gradient_noise(x + dx, y + dy, cells, 7),
                    textures::gradient_noise(x, y, cells, 7), 1e-4);
        const auto here = textures::cellular(x, y, cells, 1.0f, 7);
        const auto there = textures::cellular(x + dx, y + dy, cells, 1.0f, 7);
        EXPECT_NEAR(there.nearest, here.nearest, 1e-4);
        EXPECT_NEAR(there.second, here.second, 1e-4);
      }
    }
  }
}

TEST(TextureNoise, HashBitsAreEvenAndNeighboursUnrelated) {
  // 2^16 points: each bit is set in half of them, and differs from its neighbour's in half; 4 sigma
  // is 512.
  for (int bit = 0; bit < 32; ++bit) {
    int set = 0, different = 0;
    for (std::uint32_t y = 0; y < 256; ++y) {
      for (std::uint32_t x = 0; x < 256; ++x) {
        const std::uint32_t here = textures::hash(x, y, 5) >> bit & 1u;
        set += static_cast<int>(here);
        different += static_cast<int>(here ^ (textures::hash(x + 1, y, 5) >> bit & 1u));
      }
    }
    EXPECT_NEAR(set, 32768, 512) << bit;
    EXPECT_NEAR(different, 32768, 512) << bit;
  }
}

TEST(TextureColor, LinearLightAgreesWithTheStandard) {
  for (int coded = 0; coded < 256; ++coded)
    EXPECT_NEAR(textures::linear_from_srgb(static_cast<std::uint8_t>(coded)), linear(coded), 1e-7)
        << coded;
}

TEST(TextureColor, EveryByteSurvivesTheWayToLinearLightAndBack) {
  for (int coded = 0; coded < 256; ++coded)
    EXPECT_EQ(
        textures::srgb_from_linear(textures::linear_from_srgb(static_cast<std::uint8_t>(coded))),
        coded);
  EXPECT_EQ(textures::srgb_from_linear(-1.0f), 0);
  EXPECT_EQ(textures::srgb_from_linear(2.0f), 255);
}

}  // namespace skerry::render
