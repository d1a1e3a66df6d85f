#pragma once
#include <volk.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/platform/window.h"
#include "game/client/helm.h"
#include "game/client/presenter.h"
#include "game/client/session_client.h"
#include "game/input/actions.h"
#include "game/input/controls.h"
#include "game/map/map_maker.h"
#include "game/map/wayfinder.h"
#include "game/player/player.h"
#include "game/player/world_surroundings.h"
#include "game/scene_file/options.h"
#include "game/sound/play_sounds.h"
#include "game/ui/hud.h"
#include "game/ui/map_facts.h"
#include "game/ui/overlay.h"
#include "game/view/scene_view.h"

namespace skerry::game {

/// Most seconds of play in one frame: a machine that slept does not play on. Any frame that was
/// drawn is shorter, so that play keeps up with the clock however late frames are.
inline constexpr double kLongestFrame = 2.0;

/// Where photo mode looks from, and how.
struct PhotoView {
  CameraPlace eye;
  double fov_deg = 70.0;
  int time_of_day_s = 0;
  std::optional<double> exposure_ev;  ///< none: what the eye has adapted to
};

/// What the game is shown on.
struct Machine {
  platform::Window& window;
  gpu::Device& device;
  Presenter& presenter;
};

/// A world while it is played. Private to game/app* and game/play*: input is in play_input.cpp,
/// what the overlay, the title and the display say in play_overlay.cpp, the map in play_map.cpp.
class PlayLoop {
 public:
  /// All but the options, the session and its view outlive this.
  PlayLoop(const Machine& machine, const Bindings& bindings, const SceneOptions& options,
           std::unique_ptr<SessionClient> session, std::unique_ptr<SceneView> view);

  /// A frame's input, and what it does to the world.
  void act(const platform::InputFrame& input, double seconds);
  /// A frame in which the world stands still.
  void rest(double seconds);
  /// Takes in what streams and draws. @param layout what lies over the picture of that size.
  /// @return whether there was a window to draw to. Errors: no memory.
  using Layout = std::function<ui::OverlayTriangles(VkExtent2D)>;
  Result<bool> draw(const Layout& layout);
  /// What the next draw() shows.
  SceneView::Moment moment() const;

  /// Blocks until the world is saved as it is. Errors: those of its file; the play may go on.
  Result<void> save();
  /// The next picture drawn is saved, with the command that draws it again.
  void want_screenshot();
  /// Looks from elsewhere; none: from the player's eye.
  void set_photo(const std::optional<PhotoView>& photo) { photo_ = photo; }

  /// What settings change: scene().quality, fov_deg, and settings().
  SceneOptions& scene() { return scene_; }
  Settings& settings() { return view_->settings(); }
  SceneView& view() { return *view_; }
  Hotbar& hotbar() { return hands_.hotbar(); }
  const DayClock& day() const { return day_; }
  std::optional<double> exposure_ev() const { return exposure_ev_; }
  /// Neither flying nor swimming nor at a helm: the keys that walk and jump do so.
  bool on_foot() const;

  /// Whether keys have changed settings since the last call.
  bool take_settings_changed() { return std::exchange(settings_changed_, false); }
  /// Lines for the player since the last call.
  std::vector<std::string> take_messages() { return std::exchange(said_, {}); }

  /// What is heard of the last frame, which took so long. Once a frame.
  SoundFrame sound_frame(double seconds);
  /// What the overlay says of sound.
  void set_sound_line(std::string line) { sound_line_ = std::move(line); }

  /// The world's name and seed, short enough for a title.
  std::string world_label() const;

  void note_frame(double seconds);
  /// What the overlay says of how the quality was chosen; empty: it was named.
  void set_quality_line(std::string line) { quality_line_ = std::move(line); }
  /// F3 and F9, if they are on; between ui::Gui::begin and end.
  void show_numbers() const;
  /// Good until the next frame.
  ui::HudFacts hud() const;

  /// Once a frame while the map is open. @param radius blocks from its middle to an edge.
  /// @param shift of its middle from the player: blocks east and south. @return a
  /// new picture of it, if there is one.
  std::optional<ui::Rgba> take_map(double radius, glm::dvec2 shift);
  /// What lies over the picture that was taken last.
  ui::MapFacts map_facts() const;
  /// What was asked for on the map.
  void fulfil(const ui::MapWishes& wishes);

 private:
  void adapt_eye(double seconds);
  void act_on_picture(const platform::InputFrame& input, const ActionFrame& actions,
                      double seconds);
  void calibrate(const platform::InputFrame& input, const ActionFrame& actions,
                 render::DisplaySettings& display);
  void move(const platform::InputFrame& input, const ActionFrame& actions, double seconds);
  Intent steer(const ActionFrame& actions, const Intent& intent, bool pad);
  void go_on(double seconds, const Intent& intent);
  std::optional<world::Pose> helm_pose() const;
  PlayMoment sound_moment(double seconds) const;
  void hear_session();
  void use_hands(const ActionFrame& actions, double seconds);
  void act_on_places(const ActionFrame& actions);
  void mark_place();
  void travel_to(const Wayfinder::Place& place);
  void keep_journal();
  void ask_for_map(double radius, world::WorldPos middle);
  std::vector<ui::HudFacts::Mark> compass_marks() const;
  void tell_session();
  void take_screenshot();
  std::vector<std::string> overlay_lines() const;

  platform::Window& window_;
  gpu::Device& device_;
  Presenter& presenter_;
  const Bindings* bindings_;
  SceneOptions scene_;  // what F2 writes down; quality, time, camera and size follow the play
  std::unique_ptr<SessionClient> session_;
  std::unique_ptr<SceneView> view_;
  Player player_;
  WorldSurroundings around_;
  Wayfinder wayfinder_;
  MapMaker map_maker_;
  MapMaker::Map map_;         // the last one taken, without its picture
  bool map_taken_ = false;    // there is one
  double map_asked_s_ = 0.0;  // the world's time then
  glm::dvec2 map_view_{};     // what it is to show, from its middle [blocks]
  Helm helm_;
  Toggles toggles_;
  Interaction hands_;
  bool hands_free_ = false;  // captured, and no button held from before that
  DayClock day_;
  std::optional<double> exposure_ev_;  // what the eye has adapted to by now; none before it saw
  std::optional<PhotoView> photo_;
  bool overlay_shown_ = false;
  bool calibrating_ = false;
  bool culling_frozen_ = false;
  bool day_stands_ = false;
  bool rests_ = false;  // the last frame did
  bool screenshot_wanted_ = false;
  bool settings_changed_ = false;
  std::vector<std::string> said_;
  std::string quality_line_, sound_line_;
  PlaySounds sounds_;
  std::vector<float> frame_ms_;
  double since_title_s_ = 0.0;
  double frame_s_ = 0.0;  // that the last frame took
};

}  // namespace skerry::game
