// What actions and the mouse mean. docs/controls.md lists them for players.
#pragma once
#include <glm/vec2.hpp>

#include "game/input/actions.h"
#include "game/player/interaction.h"
#include "game/player/player.h"
#include "game/scene_file/options.h"

namespace skerry::game {

/// What the actions say about the next ticks.
Intent intent_of(const ActionFrame& actions);

/// What is on after a press, where settings ask for that.
class Toggles {
 public:
  /// Once a frame. @param walking else keys of crouching and sprinting mean what they do held.
  void apply(const PlaySettings& settings, const ActionFrame& actions, bool walking,
             Intent& intent);

 private:
  bool sprints_ = false, crouches_ = false;
};

/// What the actions say about the hands.
HandIntent hand_intent_of(const ActionFrame& actions);

/// What turns the head during a frame.
struct LookInput {
  const ActionFrame* actions;
  const Bindings* bindings;
  glm::dvec2 pointer{};  ///< motion [pixels]; zero while the pointer is not captured
  double seconds = 0.0;
};

/// By how much yaw and pitch grow. @param fov_deg zooms: a narrower view turns slower.
glm::dvec2 turned_deg(const LookInput& input, double fov_deg);
void look(Player& player, const LookInput& input, double fov_deg);

/// View-distance steps: a fifth up or down, within what settings allow.
std::uint32_t stepped_view_distance(std::uint32_t blocks, int steps);

/// A display's settings after keys of the calibration screen: steps of 0.05 and 0.005.
render::DisplaySettings stepped_display(render::DisplaySettings display, int peak_steps,
                                        int black_steps);

/// The next level up or down; the ends stay.
Quality stepped_quality(Quality quality, int steps);

/// Time of day as it runs or a held key turns it, in whole seconds, wrapped at midnight, so that a
/// screenshot's command can name the time exactly. No pixel that is not at an edge of a shadow or
/// of a disc changes by more than 2 of 255 in such a step.
class DayClock {
 public:
  explicit DayClock(int time_of_day_s) : shown_s_(time_of_day_s), exact_s_(time_of_day_s) {}
  void turn(double seconds);
  int time_of_day_s() const { return shown_s_; }

 private:
  int shown_s_;     // 0 .. 86399
  double exact_s_;  // 0 .. 86400
};

}  // namespace skerry::game
