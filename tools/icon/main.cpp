// Paints the program's icon from its own blocks: a small island, seen from above a corner.
//   skerry_icon FILE.png
#include <cmath>
#include <cstdio>
#include <vector>

#include "engine/core/log.h"
#include "engine/platform/image_file.h"
#include "game/ui/pictures.h"

namespace {

using namespace skerry;
namespace block = world::block;

constexpr int kEdge = 256;  // pixels

/// A block of the island: cells to the right front, to the left front, and up.
struct Cell {
  int right, left, up;
  world::BlockId type;
};

/// Far ones first, as they are painted. Rock tapers off below, grass and a tree are on top.
constexpr Cell kIsland[] = {
    {1, 1, -1, block::kStone},    {0, 0, 0, block::kStone}, {1, 0, 0, block::kStone},
    {0, 1, 0, block::kStone},     {1, 1, 0, block::kStone}, {2, 1, 0, block::kStone},
    {1, 2, 0, block::kStone},     {2, 2, 0, block::kStone}, {0, 0, 1, block::kGrass},
    {1, 0, 1, block::kGrass},     {2, 0, 1, block::kGrass}, {0, 1, 1, block::kGrass},
    {0, 2, 1, block::kGrass},     {1, 1, 1, block::kGrass}, {2, 1, 1, block::kGrass},
    {1, 2, 1, block::kGrass},     {2, 2, 1, block::kGrass}, {0, 0, 2, block::kOakLog},
    {0, 0, 3, block::kOakLeaves}, {2, 1, 2, block::kLamp}};

/// Straight alpha over straight alpha.
void blend(std::uint8_t* under, const std::uint8_t* over) {
  const double a = over[3] / 255.0, b = under[3] / 255.0 * (1.0 - a);
  if (a + b <= 0.0) return;
  for (int c = 0; c < 3; ++c)
    under[c] = static_cast<std::uint8_t>(std::lround((over[c] * a + under[c] * b) / (a + b)));
  under[3] = static_cast<std::uint8_t>(std::lround((a + b) * 255.0));
}

void paint(std::vector<std::uint8_t>& canvas, const Cell& cell) {
  // A cube's picture: its rhomb is 28 pixels to a side across and 14 down, its sides are 29 high.
  constexpr int kAcross = 28, kDown = 14, kTall = 29;
  constexpr int kX = (kEdge - game::ui::kBlockPictureEdge) / 2, kY = 122;
  const game::ui::Rgba picture = game::ui::block_picture(cell.type);
  const int left = kX + (cell.right - cell.left) * kAcross;
  const int top = kY + (cell.right + cell.left - 2) * kDown - cell.up * kTall + 29;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const int at_x = left + x, at_y = top + y;
      if (at_x < 0 || at_y < 0 || at_x >= kEdge || at_y >= kEdge) continue;
      blend(canvas.data() + 4 * (at_y * kEdge + at_x),
            picture.pixels.data() + 4 * (y * picture.width + x));
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: skerry_icon FILE.png\n", stderr);
    return 2;
  }
  std::vector<std::uint8_t> canvas(std::size_t{kEdge} * kEdge * 4);
  for (const Cell& cell : kIsland) paint(canvas, cell);
  const auto written = platform::write_png(arguments[1], {kEdge, kEdge, 4, canvas});
  if (written) return 0;
  log_error(written.error().message);
  return 1;
}
