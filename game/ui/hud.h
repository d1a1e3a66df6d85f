// What lies over the world while it is played.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "game/ui/pictures.h"
#include "game/ui/place_mark.h"

namespace skerry::game::ui {

/// What the display shows; for one frame.
struct HudFacts {
  std::span<const world::BlockId> hotbar;  ///< empty: none
  int selected = 0;
  double yaw_deg = 0.0;  ///< docs/conventions.md
  int time_of_day_s = 0;
  std::string place;  ///< coordinates, ready to read
  /// At the helm of an island.
  struct Steering {
    std::string island;
    double speed = 0.0;  ///< blocks/s
    bool held = false;   ///< it is driven, and something holds it
  };
  std::optional<Steering> steering;
  /// A place to find again, on the compass.
  struct Mark {
    PlaceKind kind = PlaceKind::kWaypoint;
    std::string name;          ///< as it is shown
    double bearing_deg = 0.0;  ///< clockwise from north
    double blocks = 0.0;       ///< away
  };
  std::vector<Mark> marks;
  std::optional<std::string> hint;  ///< a key that a new player may want to know
  bool torch = false;               ///< one is in the hand
  bool numbers = false;             ///< the overlay is on, which shows time and place, too
  bool choosing = false;            ///< a screen lies over the middle
  double hidden = 0.0;              ///< how much of the world black covers, 0 .. 1: after a fall
  std::size_t islands_to_come = 0;  ///< tasks left until the neighbourhood is there
  std::size_t shaders_to_come = 0;  ///< programs left until no view needs another
};

/// Lines that say what happened, for a while.
class Messages {
 public:
  static constexpr double kShown = 6.0, kFading = 1.0;  ///< seconds
  static constexpr std::size_t kMost = 5;
  /// The same line as the last one only lasts longer.
  void say(std::string line);
  void pass(double seconds);
  struct Line {
    std::string text;
    double age_s = 0.0;
    /// 1 while it is shown, falling to 0 while it fades.
    double strength() const;
  };
  std::span<const Line> lines() const { return lines_; }

 private:
  std::vector<Line> lines_;  // oldest first
};

/// Degrees clockwise from north at which a heading of so much yaw looks, 0 .. 360.
double bearing_deg(double yaw_deg);

void show_hud(const HudFacts& facts, const Pictures& pictures);
/// Above the hotbar's place, or at the window's foot where screens are. @return the height that
/// they take from the foot, for screens to keep clear of [pixels]; 0 while the world is played.
float show_messages(const Messages& messages, bool over_screens);

}  // namespace skerry::game::ui
