#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/gpu/device/device.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/render/frame/settings.h"

namespace skerry::game {

/// What the overlay shows. Points into the caller's data, for one frame.
struct OverlayFacts {
  struct Count {
    std::string_view name;
    std::uint64_t value = 0;
  };
  std::span<const float> frame_ms;     ///< recent frames, oldest first
  std::span<const std::string> lines;  ///< where, when and how, ready to read
  double gpu_ms = 0.0;
  std::span<const gpu::PassTime> passes;  ///< of the newest finished frame
  std::span<const Count> counts;
  std::span<const gpu::MemoryUse> memory;  ///< largest first
  bool numbers = true;                     ///< whether anything of the above is shown
  std::optional<render::DisplaySettings>
      calibration;              ///< the calibration screen (F9) is, with these
  std::string calibration_key;  ///< closes it, as people read it
};

/// The developer's overlay (F3) and the calibration screen, between ui::Gui::begin and
/// ui::Gui::end.
void show_overlay(const OverlayFacts& facts);

/// Median and the slowest hundredth of some frames [ms]; zeros for none.
struct FrameSpread {
  float median = 0.0f, slowest_1_percent = 0.0f;
};
FrameSpread spread_of_frames(std::span<const float> frame_ms);

}  // namespace skerry::game
