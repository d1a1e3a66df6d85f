#pragma once
#include <volk.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/platform/window.h"
#include "game/actions.h"
#include "game/controls.h"
#include "game/options.h"
#include "game/overlay.h"
#include "game/player.h"
#include "game/presenter.h"
#include "game/scene_view.h"
#include "game/world_surroundings.h"

namespace skerry::game {

/// Seconds of play in one frame, however long it took.
inline constexpr double kLongestFrame = 0.25;

/// One run of the game. Private to game/play*.cpp: input is in play_input.cpp, what the overlay and
/// the title say in play_overlay.cpp.
class PlayLoop {
 public:
  /// The window, the device and the options' surface outlive this.
  PlayLoop(platform::Window& window, gpu::Device& device, const SceneOptions& options,
           std::unique_ptr<SceneView> view);

  /// Errors: the device cannot present to the surface, no memory.
  Result<void> start(VkSurfaceKHR surface);
  /// Plays until the window is closed. Errors: no memory.
  Result<void> run();

 private:
  void act(const platform::InputFrame& input, double seconds);
  void adapt_eye(double seconds);
  void act_on_pointer(const platform::InputFrame& input, const ActionFrame& actions);
  void act_on_picture(const platform::InputFrame& input, const ActionFrame& actions,
                      double seconds);
  void move(const platform::InputFrame& input, const ActionFrame& actions, double seconds);
  void use_hands(const ActionFrame& actions, double seconds);
  Result<bool> draw(double seconds);
  void take_screenshot();
  void note_frame(double seconds);
  OverlayTriangles overlay_triangles(double seconds);
  std::vector<std::string> overlay_lines() const;
  SceneView::Moment moment() const;

  platform::Window& window_;
  gpu::Device& device_;
  SceneOptions scene_;  // what F2 writes down; quality, time, camera and size follow the play
  std::unique_ptr<SceneView> view_;
  Player player_;
  WorldSurroundings around_;
  WorldEditor editor_;
  Interaction hands_;
  bool hands_free_ = false;  // captured, and no button held from before that
  DayClock day_;
  Bindings bindings_;
  std::optional<double> exposure_ev_;  // what the eye has adapted to by now; none before it saw
  Overlay overlay_;
  std::unique_ptr<Presenter> presenter_;
  bool overlay_shown_ = false;
  bool calibrating_ = false;
  bool culling_frozen_ = false;
  bool day_stands_ = false;
  bool screenshot_wanted_ = false;
  bool pointer_wanted_ = true;  // captured while the window has the focus
  std::vector<float> frame_ms_;
  double since_title_s_ = 0.0;
};

}  // namespace skerry::game
