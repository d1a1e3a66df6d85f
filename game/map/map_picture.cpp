#include "game/map/map_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace skerry::game {
namespace {

constexpr float kNone = -1e9f;  // height where there is no land

/// What is seen from above, pixel by pixel.
struct Surface {
  explicit Surface(int pixels)
      : edge(pixels),
        heights(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels), kNone),
        colours(heights.size()) {}
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(edge) +
           static_cast<std::size_t>(x);
  }
  float height(int x, int y) const {
    return x < 0 || y < 0 || x >= edge || y >= edge ? kNone : heights[index(x, y)];
  }

  int edge;
  std::vector<float> heights;  // blocks above the middle
  std::vector<IslandChart::Cell> colours;
};

/// From the lattice's origin to its farthest corner [blocks].
double reach_of(const IslandChart& chart) {
  const double x =
      std::max(std::abs(chart.low_x), std::abs(chart.low_x + chart.cells_x * IslandChart::kStep));
  const double z =
      std::max(std::abs(chart.low_z), std::abs(chart.low_z + chart.cells_z * IslandChart::kStep));
  return std::hypot(x, z);
}

void put(Surface& surface, const MapLand& land, double radius) {
  const double pixel = 2.0 * radius / surface.edge;  // blocks
  const double reach = reach_of(*land.chart);
  const auto bounds = [&](double middle) {
    const auto at = [&](double blocks) {
      return static_cast<int>(
          std::clamp(std::floor((blocks + radius) / pixel), 0.0, double(surface.edge)));
    };
    return std::pair(at(middle - reach), std::min(surface.edge, at(middle + reach) + 1));
  };
  const auto [x0, x1] = bounds(land.at.x);
  const auto [y0, y1] = bounds(land.at.y);
  const double cosine = std::cos(land.heading_rad), sine = std::sin(land.heading_rad);
  for (int y = y0; y < y1; ++y) {
    const double south = (y + 0.5) * pixel - radius - land.at.y;
    for (int x = x0; x < x1; ++x) {
      const double east = (x + 0.5) * pixel - radius - land.at.x;
      // Back from the world into the lattice.
      const IslandChart::Cell* cell =
          land.chart->at(east * cosine - south * sine, east * sine + south * cosine);
      if (!cell) continue;
      const std::size_t at = surface.index(x, y);
      const auto height = static_cast<float>(land.up + cell->height);
      if (height <= surface.heights[at]) continue;
      surface.heights[at] = height;
      surface.colours[at] = *cell;
    }
  }
}

/// How light a pixel is: by height, by slope, and dark where land ends.
float light_at(const Surface& surface, int x, int y, float pixel) {
  constexpr float kCliff = 24.0f;  // blocks that part one island from another below it
  const float here = surface.height(x, y);
  const float tall = std::clamp(here / 160.0f, -1.0f, 1.0f);
  const auto ends = [&](int dx, int dy) { return surface.height(x + dx, y + dy) < here - kCliff; };
  if (ends(1, 0) || ends(-1, 0) || ends(0, 1) || ends(0, -1)) return 0.45f;
  const auto rise = [&](int dx, int dy) {
    const float from = surface.height(x - dx, y - dy), to = surface.height(x + dx, y + dy);
    return from < here - kCliff || to < here - kCliff ? 0.0f : (to - from) / (2.0f * pixel);
  };
  const float lit = std::clamp((rise(1, 0) + rise(0, 1)) * 0.5f, -0.4f, 0.4f);
  return std::clamp(0.9f + 0.25f * tall + lit, 0.4f, 1.5f);
}

}  // namespace

ui::Rgba draw_map(std::span<const MapLand> lands, double radius, int edge) {
  Surface surface(edge);
  for (const MapLand& land : lands) put(surface, land, radius);
  ui::Rgba out{edge, edge, std::vector<std::uint8_t>(surface.heights.size() * 4)};
  const auto pixel = static_cast<float>(2.0 * radius / edge);
  for (int y = 0; y < edge; ++y) {
    for (int x = 0; x < edge; ++x) {
      const std::size_t at = surface.index(x, y);
      if (surface.heights[at] == kNone) continue;
      const float light = light_at(surface, x, y, pixel);
      const IslandChart::Cell& cell = surface.colours[at];
      std::uint8_t* to = &out.pixels[at * 4];
      for (const std::uint8_t channel : {cell.red, cell.green, cell.blue})
        *to++ = static_cast<std::uint8_t>(std::min(255.0f, static_cast<float>(channel) * light));
      *to = 255;
    }
  }
  return out;
}

}  // namespace skerry::game
