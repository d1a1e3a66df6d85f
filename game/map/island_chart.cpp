#include "game/map/island_chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/render/scene/block_textures.h"
#include "world/generate/columns.h"
#include "world/generate/shape.h"
#include "world/voxel/blocks.h"

namespace skerry::game {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kWater{58, 112, 168};
constexpr Colour kUnplanned{150, 146, 138};  // an outline
constexpr int kMostCells = 1024;             // each way, of an outline

/// The mean of a block's upper face.
std::vector<Colour> top_colours() {
  const render::BlockTextures textures = render::block_textures();
  const auto texels = static_cast<std::size_t>(textures.edge) * textures.edge;
  std::vector<Colour> colours;
  for (world::BlockId block = 0; block < world::block::kBuiltInCount; ++block) {
    const auto layer = static_cast<std::size_t>(world::block_types()[block].top);
    std::array<std::size_t, 3> sum{};
    for (std::size_t i = 0; i < texels; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += std::to_integer<std::size_t>(textures.texels[(layer * texels + i) * 4 + c]);
    Colour mean{};
    for (std::size_t c = 0; c < 3; ++c) mean[c] = static_cast<std::uint8_t>(sum[c] / texels);
    colours.push_back(mean);
  }
  return colours;
}

Colour colour_of(world::BlockId block) {
  static const std::vector<Colour> kColours = top_colours();
  return block == world::block::kWater ? kWater : kColours[block];
}

}  // namespace

const IslandChart::Cell* IslandChart::at(double x, double z) const {
  const int i = static_cast<int>(std::floor((x - low_x) / kStep));
  const int j = static_cast<int>(std::floor((z - low_z) / kStep));
  if (i < 0 || j < 0 || i >= cells_x || j >= cells_z) return nullptr;
  const Cell& cell = cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(cells_x) +
                           static_cast<std::size_t>(i)];
  return cell.height == kNoLand ? nullptr : &cell;
}

IslandChart chart_of(const world::IslandSpec& spec) {
  world::Shape shape = world::shape_of(spec);
  const world::Columns columns = world::build_columns(shape);
  const world::BiomeType& biome = world::biome_type(shape.biome);
  IslandChart chart;
  chart.low_x = chart.low_z = -columns.half;
  chart.cells_x = chart.cells_z = columns.edge / IslandChart::kStep;
  chart.cells.reserve(static_cast<std::size_t>(chart.cells_x) *
                      static_cast<std::size_t>(chart.cells_z));
  for (int j = 0; j < chart.cells_z; ++j) {
    for (int i = 0; i < chart.cells_x; ++i) {
      IslandChart::Cell& cell = chart.cells.emplace_back();
      const std::size_t column =
          columns.index(chart.low_x + i * IslandChart::kStep, chart.low_z + j * IslandChart::kStep);
      if (columns.top[column] == world::Columns::kNoGround) continue;
      const bool wet = columns.water[column] != world::Columns::kDry;
      const world::SkinId skin = columns.skins[column];
      const world::BlockId block = wet ? biome.liquid
                                   : skin == world::SkinId::kBare
                                       ? biome.rock[0]
                                       : world::kSkins[static_cast<std::size_t>(skin)].top;
      const Colour colour = colour_of(block);
      cell = {wet ? columns.water[column] : columns.top[column], colour[0], colour[1], colour[2]};
    }
  }
  return chart;
}

IslandChart outline_of(const world::IslandSpec& spec) {
  IslandChart chart;
  const auto cells = [](std::int32_t low, std::int32_t high) {
    return std::clamp((high - low) / IslandChart::kStep, 1, kMostCells);
  };
  chart.low_x = spec.box_min.x;
  chart.low_z = spec.box_min.z;
  chart.cells_x = cells(spec.box_min.x, spec.box_max.x);
  chart.cells_z = cells(spec.box_min.z, spec.box_max.z);
  const auto height = static_cast<std::int16_t>(std::clamp(spec.box_max.y, -20000, 20000));
  chart.cells.assign(
      static_cast<std::size_t>(chart.cells_x) * static_cast<std::size_t>(chart.cells_z),
      {height, kUnplanned[0], kUnplanned[1], kUnplanned[2]});
  return chart;
}

}  // namespace skerry::game
