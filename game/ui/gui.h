// Dear ImGui, fed with our input and drawn by our pass.
#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/platform/input.h"
#include "game/ui/fonts.h"
#include "game/ui/triangles.h"

struct ImGuiContext;

namespace skerry::game::ui {

/// A frame of the window, as screens see it.
struct GuiFrame {
  std::uint32_t width = 0, height = 0;          ///< of the picture [pixels]
  double seconds = 0.0;                         ///< since the frame before
  const platform::InputFrame* input = nullptr;  ///< null: the keys mean the world, not the screens
  float scale = 1.0f;                           ///< times the usual sizes
  /// Shown while another frame is still being made, without keys: those that were pressed wait.
  bool between = false;
};

/// Where copied text goes and comes from.
struct Clipboard {
  std::function<std::string()> read;
  std::function<void(const std::string&)> write;
};

/// The beginning of a text, cut between characters, up to `max_bytes` or the end of its first line.
std::string pasted_text(std::string_view text, std::size_t max_bytes);

/// ImGui's context, fonts and input. Only its core is used: packaged builds of its Vulkan backend
/// call Vulkan through prototypes, which cannot be linked together with volk's function pointers of
/// the same names, and its shape is one draw anyway. Between begin() and end(), functions that show
/// something call ImGui.
class Gui {
 public:
  /// @param clipboard without functions: a text copied here can be pasted here only.
  explicit Gui(Clipboard clipboard = {});
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  FontAtlas font() const;
  /// Text that will be shown, or is typed, and may have characters beyond Latin. What is pasted is
  /// known.
  void expect(std::string_view text) { fonts_.want(text); }
  void expect(const platform::InputFrame& input);
  /// Gives font() the characters that are expected; between frames. @return whether it is another
  /// now.
  bool fit_font();
  void begin(const GuiFrame& frame);
  OverlayTriangles end();
  /// Why nothing was pasted since the last call, for the player; empty: nothing was refused.
  std::string take_refusal();
  /// Whether a button, slider or the like was held down in the last frame.
  bool pressed() const { return pressed_; }
  /// Whether the keys go into a text field, as of the last frame.
  bool typing() const;

 private:
  friend struct ClipboardCalls;
  /// Enter may open a screen: it is drawn in the next frame, and has its focus in the one after
  /// that. A field that Tab goes to takes no characters in the frame in which it gets the focus.
  static constexpr int kFramesOfFocus = 3;
  void feed(const platform::InputFrame& input);
  void release_all();

  ImGuiContext* context_;
  Clipboard clipboard_;
  std::string clipboard_text_;              // what was asked for or copied last
  bool refused_ = false;                    // it was too long for its field
  std::deque<platform::InputEvent> queue_;  // that no frame has read yet
  int rest_ = 0;  // frames in which nothing is pressed: the focus is on its way
  Fonts fonts_;
  bool pressed_ = false;
  float scale_ = 1.0f;  // stays while a slider is moved, or it would move away from the pointer
  bool fed_ = true;  // in the last frame; before the first, so that keys are mapped whatever comes
};

}  // namespace skerry::game::ui
