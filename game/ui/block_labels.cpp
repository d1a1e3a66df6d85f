// Blocks as people read them.
#include <algorithm>
#include <iterator>
#include <string>

#include "game/ui/screens.h"
#include "game/words/words.h"
#include "world/voxel/blocks.h"

namespace skerry::game::ui {
namespace {

/// In the order of world::block.
constexpr const char* kLabels[] = {
    word("Air"),
    word("Stone"),
    word("Mossy stone"),
    word("Cobble"),
    word("Gravel"),
    word("Dirt"),
    word("Grass"),
    word("Dry grass"),
    word("Snow"),
    word("Snowy grass"),
    word("Ice"),
    word("Sand"),
    word("Sandstone"),
    word("Red sand"),
    word("Red rock"),
    word("Banded red rock"),
    word("Clay"),
    word("Mud"),
    word("Basalt"),
    word("Lava"),
    word("Obsidian"),
    word("Marble"),
    word("Slate"),
    word("Limestone"),
    word("Coal ore"),
    word("Iron ore"),
    word("Copper ore"),
    word("Gold ore"),
    word("Crystal ore"),
    word("Blue crystal"),
    word("Violet crystal"),
    word("Glowstone"),
    word("Oak log"),
    word("Birch log"),
    word("Pine log"),
    word("Palm log"),
    word("Willow log"),
    word("Oak leaves"),
    word("Birch leaves"),
    word("Pine leaves"),
    word("Palm leaves"),
    word("Willow leaves"),
    word("Autumn leaves"),
    word("Blossom leaves"),
    word("Tall grass"),
    word("Fern"),
    word("Red flower"),
    word("Yellow flower"),
    word("Blue flower"),
    word("Reed"),
    word("Dead bush"),
    word("Glowing mushroom"),
    word("Glowing fern"),
    word("Heather"),
    word("Red mushroom cap"),
    word("Glowing mushroom cap"),
    word("Mushroom stem"),
    word("Mycelium"),
    word("Water"),
    word("Glass"),
    word("Planks"),
    word("Bricks"),
    word("Torch"),
    word("Lamp"),
    word("White glass"),
    word("Light grey glass"),
    word("Grey glass"),
    word("Black glass"),
    word("Brown glass"),
    word("Red glass"),
    word("Orange glass"),
    word("Yellow glass"),
    word("Lime glass"),
    word("Green glass"),
    word("Teal glass"),
    word("Sky blue glass"),
    word("Blue glass"),
    word("Violet glass"),
    word("Plum glass"),
    word("Pink glass"),
};
static_assert(std::size(kLabels) == world::block::kBuiltInCount);

/// Of Latin, Greek and Cyrillic letters of two bytes at most; others stay.
std::string lower(std::string_view text) {
  std::string out(text);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto lead = static_cast<unsigned char>(out[i]);
    if (lead >= 'A' && lead <= 'Z') out[i] = static_cast<char>(lead + ('a' - 'A'));
    if (lead < 0xc3 || lead > 0xd1 || i + 1 == out.size()) continue;
    unsigned code = (lead & 0x1fu) << 6 | (static_cast<unsigned char>(out[i + 1]) & 0x3fu);
    const bool latin = code >= 0xc0 && code <= 0xde && code != 0xd7;  // not the sign of times
    const bool greek = code >= 0x391 && code <= 0x3a9, cyrillic = code >= 0x410 && code <= 0x42f;
    if (latin || greek || cyrillic) code += 32;
    if (code >= 0x400 && code <= 0x40f) code += 80;
    out[i] = static_cast<char>(0xc0u | code >> 6);
    out[++i] = static_cast<char>(0x80u | (code & 0x3fu));
  }
  return out;
}

/// Whether every word of `wanted` occurs in `text`.
bool has_words(const std::string& text, std::string_view wanted) {
  while (!wanted.empty()) {
    const std::size_t end = std::min(wanted.find(' '), wanted.size());
    if (text.find(wanted.substr(0, end)) == std::string::npos) return false;
    wanted.remove_prefix(std::min(end + 1, wanted.size()));
  }
  return true;
}

}  // namespace

std::string block_label(world::BlockId block) {
  return tr(kLabels[block]);
}

std::vector<world::BlockId> find_blocks(std::string_view search) {
  const std::string wanted = lower(search);
  std::vector<world::BlockId> out;
  for (world::BlockId block = 1; block < world::block::kBuiltInCount; ++block)
    if (has_words(lower(block_label(block)), wanted) || has_words(lower(kLabels[block]), wanted))
      out.push_back(block);
  return out;
}

}  // namespace skerry::game::ui
