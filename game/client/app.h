// The program in its window: the world that is played, the screens, and how one leads to the other.
#pragma once
#include <volk.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/clock.h"
#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/platform/window.h"
#include "game/client/auto_quality.h"
#include "game/client/backdrop.h"
#include "game/client/play_loop.h"
#include "game/client/presenter.h"
#include "game/input/actions.h"
#include "game/input/hints.h"
#include "game/input/photo_camera.h"
#include "game/scene_file/options.h"
#include "game/sound/game_sound.h"
#include "game/ui/gui.h"
#include "game/ui/hud.h"
#include "game/ui/loading_screen.h"
#include "game/ui/screens.h"
#include "game/words/words.h"
#include "game/worlds/world_list.h"

namespace skerry::game {

class App {
 public:
  /// The window and the device outlive this. @param options of every world that is played.
  /// @param notes for the player, each a line.
  App(platform::Window& window, gpu::Device& device, const SceneOptions& options,
      const std::vector<std::string>& notes);

  /// Into the options' world, or to the title. Errors: the device cannot present to the surface, no
  /// memory, no such world.
  Result<void> start(VkSurfaceKHR surface, bool at_title);
  /// Until the window is closed. Errors: no memory.
  Result<void> run();

 private:
  // app.cpp: a frame.
  Result<bool> frame(const platform::InputFrame& input, double seconds);
  void act(const platform::InputFrame& input, double seconds);
  void sound(double seconds);
  void act_on_screens(const platform::InputFrame& input, const ActionFrame& actions);
  void pause_unattended(double seconds);
  void move_map(const platform::InputFrame& input, double seconds);
  void fly_photo_camera(const platform::InputFrame& input, const ActionFrame& actions,
                        double seconds);
  void follow_language();
  Result<void> show_new_images(const platform::InputFrame& input);
  Result<bool> draw(double seconds, const PlayLoop::Layout& layout);
  Result<bool> draw_first_frames(const PlayLoop::Layout& layout);
  Result<void> show_title_alone();
  Result<void> show_loading(const ui::LoadingFacts& facts);
  Result<bool> draw_backdrop(const PlayLoop::Layout& layout);
  Result<bool> show_again(const PlayLoop::Layout& layout);
  bool world_is_due(double seconds);
  ui::OverlayTriangles lay_out(VkExtent2D size, const platform::InputFrame& input, double seconds);
  ui::ScreenFacts screen_facts(const platform::InputFrame& input);
  void open(ui::Screen screen);

  // app_frames.cpp: when frames are drawn, and how well.
  const FrameSettings& frame_settings();
  double frame_rate();
  void wait_until_due();
  double still_wait_s();
  double budget_ms();
  void choose_quality(bool drawn);
  void begin_quality(SceneOptions& scene, Settings& settings);

  // app_wishes.cpp: what was asked for on a screen.
  Result<void> fulfil(const ui::Wishes& wishes);
  Result<void> play_as_asked();
  Result<void> play_as_left(const std::string& path, Result<std::unique_ptr<Session>> session);
  Result<void> play(const SceneOptions& asked, std::unique_ptr<SessionClient> session);
  Result<void> create_world(const ui::Wishes::NewWorld& wanted);
  bool save_world();
  void leave_world();
  void keep_picture();
  void follow_settings();
  void keep_settings();
  void list_again();
  void list_gallery();
  void read_next_picture();
  Result<void> enter_picture(const std::string& path);
  Result<void> to_title();
  Result<void> set_backdrop(Backdrop::View view, const std::string& seed_text);
  void draw_lots();
  void draw_name();
  void say(std::string line);

  platform::Window& window_;
  gpu::Device& device_;
  SceneOptions base_;  // of what is played next; settings follow the player's choice
  Bindings bindings_;
  Hints hints_;
  ui::Gui gui_;
  ui::Pictures pictures_;
  std::uint64_t pictures_shown_ = 0;  // their version on the device
  std::unique_ptr<Presenter> presenter_;
  std::unique_ptr<Backdrop> backdrop_;  // either this
  std::unique_ptr<PlayLoop> world_;     // or this
  std::optional<std::string> world_path_;
  ui::ScreenState screens_;
  ui::Wishes wishes_;
  ui::KnobCosts costs_;
  AutoQuality auto_quality_;
  const Language system_language_ = system_language();
  Language language_ = Language::kEnglish;                    // that is spoken
  Stopwatch clock_;                                           // since the program began
  double due_s_ = 0.0, began_s_ = 0.0, world_began_s_ = 0.0;  // by that clock
  double began_thread_s_ = 0.0;                               // see thread_seconds
  bool auto_before_ = false;  // the settings had the quality chosen when they changed last
  ui::Messages messages_;
  GameSound sound_;
  bool pressed_before_ = false;  // something on a screen was held down in the last frame
  std::vector<ui::WorldCard> cards_;
  std::vector<ui::PictureCard> gallery_;
  std::size_t pictures_read_ = 0;        // of the gallery
  std::optional<double> preview_due_s_;  // until the new world's seed is shown
  ui::MapFacts map_;                     // while it is shown
  PhotoCamera photo_;
  ui::PhotoSettings photo_settings_;
  bool in_photo_ = false;
  platform::HeldBack held_back_;
  // Frames left in which the world behind a screen is drawn in any case: after the screen has come
  // up, and after a knob was turned, until its cost is known.
  static constexpr int kSettlingFrames = 3;
  static constexpr int kMeasuringFrames = ui::KnobCosts::kSkipped + ui::KnobCosts::kFrames;
  int fresh_frames_ = 0;
  double since_drawn_s_ = 0.0;                                // since it was drawn
  static constexpr double kFirstFrames = 20.0;                // seconds, the most
  std::optional<double> first_frames_until_s_;                // see draw_first_frames()
  bool still_ = false;                                        // the last frame drew a screen alone
  bool settings_changed_ = false, bindings_changed_ = false;  // since they were saved
  bool hud_hidden_ = false;
  bool attended_ = false;  // the window has had the focus since the last pause that losing it made
  double unfocused_s_ = 0.0;  // for so long it has not had it
  bool back_ = false;         // this frame's input closes what is topmost
};

}  // namespace skerry::game
