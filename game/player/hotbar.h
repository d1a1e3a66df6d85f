#pragma once
#include <array>

#include "world/voxel/blocks.h"

namespace skerry::game {

inline constexpr int kHotbarSlots = 9;

/// The blocks at hand. An empty slot holds air: with it, nothing is placed.
struct Hotbar {
  std::array<world::BlockId, kHotbarSlots> blocks{
      world::block::kTorch,  world::block::kLamp,   world::block::kPlanks,
      world::block::kCobble, world::block::kBricks, world::block::kGlass,
      world::block::kDirt,   world::block::kOakLog, world::block::kGlowstone};
  int selected = 0;  ///< 0 .. kHotbarSlots - 1

  world::BlockId held() const { return blocks[static_cast<std::size_t>(selected)]; }
  /// Goes so many slots on, around the ends.
  void scroll(int slots);
  /// Brings a block into the hand: selects its slot, or else puts it into the selected one.
  void take(world::BlockId block);
  bool operator==(const Hotbar&) const = default;
};

}  // namespace skerry::game
