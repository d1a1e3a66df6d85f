#pragma once
#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/platform/input.h"

struct GLFWwindow;

namespace skerry::platform {

struct WindowOptions {
  int width = 1280, height = 720;  ///< of the contents [screen coordinates]
  std::string title;
};

struct FramebufferSize {
  std::uint32_t width = 0, height = 0;  ///< pixels; 0 while minimised
  bool operator==(const FramebufferSize&) const = default;
};

/// What GLFW's callbacks gather for a window.
class WindowEvents {
 public:
  Input input;

  /// The window moved, changed its size, came, went or captured the pointer. About that time GLFW,
  /// the window manager and the server put the pointer to other places (a warp to the window's
  /// middle, a constraint to its contents), and nothing distinguishes their events from a hand's.
  /// They come before this is told, or after: what moved the pointer just now is taken back.
  void disturb(double now_s);
  /// The pointer is at a place of the window.
  void move_pointer(glm::dvec2 place, double now_s);
  /// What the mouse has done since the last poll counts as nothing.
  void drop_mouse();
  /// All events of a poll have been taken in.
  void end_poll(double now_s);

 private:
  // The shortest time, and the fewest polls, this one included, to either side of a disturbance.
  static constexpr int kPolls = 2;
  static constexpr double kSettling = 0.1;  // seconds
  int polls_left_ = 0;
  double settled_s_ = 0.0;
  struct Motion {
    glm::dvec2 delta{};
    double at_s = 0.0;
    int polls = 0;  // that have ended since
  };
  std::deque<Motion> recent_;  // oldest first
};

/// The program's one window. Main thread only.
class Window {
 public:
  /// Errors: no display (says so), no Vulkan loader, the display refuses the window.
  static Result<std::unique_ptr<Window>> create(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Instance extensions that surfaces on this display need.
  std::vector<const char*> vulkan_extensions() const;
  /// The caller destroys it, before the window.
  Result<VkSurfaceKHR> create_surface(VkInstance instance) const;

  /// Takes in what happened since the last call. @param wait_s waits up to so many seconds for
  /// something to happen; for when there is nothing to draw.
  InputFrame poll(double wait_s = 0.0);
  /// Answers the display while something takes long that no input can act on. Keys and characters
  /// are kept for the next poll() in their order; what the mouse does counts as nothing.
  void keep_answering();
  bool should_close() const;
  void close();
  /// Cancels close(), or the user's press of the window's close button.
  void stay_open();
  FramebufferSize framebuffer_size() const;
  bool focused() const;
  /// Refreshes a second of the monitor that shows most of the window; 60 where none says so.
  double refresh_hz() const;

  /// A captured pointer is hidden and only moves the view, unaccelerated where the display can.
  void capture_pointer(bool captured);
  bool pointer_captured() const { return captured_; }
  /// Between a window and the whole of its monitor, keeping the window's place and size for the way
  /// back.
  void toggle_fullscreen();
  void set_title(const std::string& title);
  /// UTF-8 text that was copied here or elsewhere; empty if it is no text.
  std::string clipboard() const;
  void set_clipboard(const std::string& text);

 private:
  explicit Window(GLFWwindow* handle);
  struct Placement {
    int x = 0, y = 0, width = 0, height = 0;
  };
  GLFWwindow* handle_;
  WindowEvents events_;
  bool captured_ = false;
  Placement windowed_;
};

}  // namespace skerry::platform
