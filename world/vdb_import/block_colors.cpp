#include "world/vdb_import/block_colors.h"

#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

namespace skerry::world {
namespace {

// Means of the painted textures in linear light; a test holds them against the textures.
constexpr std::array<BlockColor, 30> kColors = {{
    {block::kStone, {139, 136, 131}},
    {block::kStoneMossy, {123, 127, 106}},
    {block::kDirt, {123, 94, 71}},
    {block::kSnow, {225, 232, 238}},
    {block::kIce, {176, 208, 220}},
    {block::kSand, {216, 197, 152}},
    {block::kSandstone, {202, 177, 130}},
    {block::kRedSand, {182, 121, 82}},
    {block::kRedRock, {157, 92, 68}},
    {block::kRedRockBanded, {162, 108, 81}},
    {block::kClay, {160, 153, 146}},
    {block::kMud, {98, 81, 68}},
    {block::kBasalt, {87, 85, 90}},
    {block::kObsidian, {42, 36, 52}},
    {block::kMarble, {215, 212, 207}},
    {block::kSlate, {103, 112, 121}},
    {block::kLimestone, {196, 185, 162}},
    {block::kOakLog, {112, 90, 70}},
    {block::kBirchLog, {204, 198, 186}},
    {block::kPalmLog, {148, 128, 99}},
    {block::kWillowLog, {111, 106, 93}},
    {block::kOakLeaves, {108, 133, 68}},
    {block::kBirchLeaves, {145, 158, 83}},
    {block::kPineLeaves, {83, 110, 81}},
    {block::kAutumnLeaves, {185, 128, 68}},
    {block::kBlossomLeaves, {214, 171, 179}},
    {block::kMushroomCapRed, {174, 106, 94}},
    {block::kMushroomStem, {207, 197, 177}},
    {block::kPlanks, {167, 133, 90}},
    {block::kBricks, {159, 110, 94}},
}};

double linear_from(std::uint32_t coded) {
  const double c = coded / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

glm::dvec3 oklab(std::uint32_t r8, std::uint32_t g8, std::uint32_t b8) {
  const double r = linear_from(r8), g = linear_from(g8), b = linear_from(b8);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

}  // namespace

std::span<const BlockColor> block_colors() {
  return kColors;
}

BlockId nearest_block(std::uint32_t packed) {
  static const std::array<glm::dvec3, kColors.size()> places = [] {
    std::array<glm::dvec3, kColors.size()> out{};
    for (std::size_t i = 0; i < kColors.size(); ++i)
      out[i] = oklab(kColors[i].srgb[0], kColors[i].srgb[1], kColors[i].srgb[2]);
    return out;
  }();
  const glm::dvec3 wanted = oklab(packed >> 16 & 255u, packed >> 8 & 255u, packed & 255u);
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec3 d = places[i] - wanted;
    const double distance = d.x * d.x + d.y * d.y + d.z * d.z;
    if (distance < least) {
      least = distance;
      best = i;
    }
  }
  return kColors[best].id;
}

}  // namespace skerry::world
