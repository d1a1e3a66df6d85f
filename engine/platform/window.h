#pragma once
#include <vulkan/vulkan_core.h>

#include <cstdint>
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
  Input input_;
  bool captured_ = false;
  Placement windowed_;
};

}  // namespace skerry::platform
