#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace skerry::game::ui {

enum class Screen : std::uint8_t {
  kTitle,
  kWorlds,
  kNewWorld,
  kSettings,
  kControls,
  kPause,
  kPalette,
  kPhoto,
  kMap,
  kGallery,
};

/// Screens over one another; only the topmost is seen. None: the player has the world.
class ScreenStack {
 public:
  bool empty() const { return screens_.empty(); }
  std::size_t size() const { return screens_.size(); }
  std::optional<Screen> top() const {
    if (screens_.empty()) return std::nullopt;
    return screens_.back();
  }
  /// A screen that is open already comes to the top, what lay over it closes.
  void open(Screen screen) {
    for (std::size_t i = 0; i < screens_.size(); ++i)
      if (screens_[i] == screen) screens_.resize(i);
    screens_.push_back(screen);
  }
  /// Closes the topmost, if it may be: from the title there is no way back.
  void back() {
    if (!screens_.empty() && screens_.back() != Screen::kTitle) screens_.pop_back();
  }
  void clear() { screens_.clear(); }

 private:
  std::vector<Screen> screens_;
};

}  // namespace skerry::game::ui
