#include "engine/platform/window.h"

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace skerry::platform {
namespace {

std::string last_problem() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

std::optional<Key> key_of(int glfw_key) {
  switch (glfw_key) {
    case GLFW_KEY_W:
      return Key::kW;
    case GLFW_KEY_A:
      return Key::kA;
    case GLFW_KEY_S:
      return Key::kS;
    case GLFW_KEY_D:
      return Key::kD;
    case GLFW_KEY_F:
      return Key::kF;
    case GLFW_KEY_L:
      return Key::kL;
    case GLFW_KEY_P:
      return Key::kP;
    case GLFW_KEY_T:
      return Key::kT;
    case GLFW_KEY_Y:
      return Key::kY;
    case GLFW_KEY_SPACE:
      return Key::kSpace;
    case GLFW_KEY_LEFT_SHIFT:
    case GLFW_KEY_RIGHT_SHIFT:
      return Key::kShift;
    case GLFW_KEY_LEFT_CONTROL:
    case GLFW_KEY_RIGHT_CONTROL:
      return Key::kControl;
    case GLFW_KEY_ESCAPE:
      return Key::kEscape;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      return Key::kMinus;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
      return Key::kPlus;
    case GLFW_KEY_LEFT_BRACKET:
      return Key::kLeftBracket;
    case GLFW_KEY_RIGHT_BRACKET:
      return Key::kRightBracket;
    case GLFW_KEY_F2:
      return Key::kF2;
    case GLFW_KEY_F3:
      return Key::kF3;
    case GLFW_KEY_F8:
      return Key::kF8;
    case GLFW_KEY_F9:
      return Key::kF9;
    case GLFW_KEY_UP:
      return Key::kUp;
    case GLFW_KEY_DOWN:
      return Key::kDown;
    case GLFW_KEY_LEFT:
      return Key::kLeft;
    case GLFW_KEY_RIGHT:
      return Key::kRight;
    case GLFW_KEY_F11:
      return Key::kF11;
    default:
      return std::nullopt;
  }
}

Input& input_of(GLFWwindow* handle) {
  return *static_cast<Input*>(glfwGetWindowUserPointer(handle));
}

void on_key(GLFWwindow* handle, int key, int, int action, int) {
  if (const auto known = key_of(key)) input_of(handle).set_key(*known, action != GLFW_RELEASE);
}

void on_button(GLFWwindow* handle, int button, int action, int) {
  if (button == GLFW_MOUSE_BUTTON_LEFT)
    input_of(handle).set_key(Key::kMouseLeft, action != GLFW_RELEASE);
}

void on_pointer(GLFWwindow* handle, double x, double y) {
  input_of(handle).move_pointer({x, y});
}
void on_scroll(GLFWwindow* handle, double, double y) {
  input_of(handle).add_scroll(y);
}
void on_focus(GLFWwindow* handle, int focused) {
  if (!focused) input_of(handle).lose_focus();
}

/// The monitor that shows most of the window.
GLFWmonitor* monitor_of(GLFWwindow* handle) {
  int x, y, width, height, count;
  glfwGetWindowPos(handle, &x, &y);
  glfwGetWindowSize(handle, &width, &height);
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  GLFWmonitor* best = nullptr;
  int best_area = -1;
  for (int i = 0; i < count; ++i) {
    int left, top;
    glfwGetMonitorPos(monitors[i], &left, &top);
    const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
    if (!mode) continue;
    const int across = std::max(0, std::min(x + width, left + mode->width) - std::max(x, left));
    const int down = std::max(0, std::min(y + height, top + mode->height) - std::max(y, top));
    if (across * down > best_area) {
      best = monitors[i];
      best_area = across * down;
    }
  }
  return best;
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(const WindowOptions& options) {
  if (!glfwInit()) {
    return Error{fmt::format(
        "cannot open a window: there is no display ({}); start it on a desktop, or draw a "
        "picture with 'skerry shot'",
        last_problem())};
  }
  // From here on the destructor of Window, or this function, ends GLFW.
  if (!glfwVulkanSupported()) {
    glfwTerminate();
    return Error{
        "cannot open a window: no Vulkan loader with window support was found; install libvulkan1 "
        "and a "
        "Vulkan driver (mesa-vulkan-drivers)"};
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  GLFWwindow* handle =
      glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
  if (!handle) {
    const std::string why = last_problem();
    glfwTerminate();
    return Error{
        fmt::format("cannot open a window of {}x{}: {}; try another --size, or draw a picture with "
                    "'skerry shot'",
                    options.width, options.height, why)};
  }
  return std::unique_ptr<Window>(new Window(handle));
}

Window::Window(GLFWwindow* handle) : handle_(handle) {
  glfwSetWindowUserPointer(handle_, &input_);
  glfwSetKeyCallback(handle_, on_key);
  glfwSetMouseButtonCallback(handle_, on_button);
  glfwSetCursorPosCallback(handle_, on_pointer);
  glfwSetScrollCallback(handle_, on_scroll);
  glfwSetWindowFocusCallback(handle_, on_focus);
}

Window::~Window() {
  glfwDestroyWindow(handle_);
  glfwTerminate();
}

std::vector<const char*> Window::vulkan_extensions() const {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  return {names, names + count};
}

Result<VkSurfaceKHR> Window::create_surface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  const VkResult result = glfwCreateWindowSurface(instance, handle_, nullptr, &surface);
  if (result == VK_SUCCESS) return surface;
  return Error{fmt::format("cannot draw into the window: {} (VkResult {}); choose another --device",
                           last_problem(), static_cast<int>(result))};
}

InputFrame Window::poll(double wait_s) {
  if (wait_s > 0.0) {
    glfwWaitEventsTimeout(wait_s);
  } else {
    glfwPollEvents();
  }
  return input_.take();
}

bool Window::should_close() const {
  return glfwWindowShouldClose(handle_) != 0;
}
void Window::close() {
  glfwSetWindowShouldClose(handle_, GLFW_TRUE);
}

FramebufferSize Window::framebuffer_size() const {
  // X11 keeps reporting the old size of an iconified window.
  if (glfwGetWindowAttrib(handle_, GLFW_ICONIFIED)) return {};
  int width = 0, height = 0;
  glfwGetFramebufferSize(handle_, &width, &height);
  return {static_cast<std::uint32_t>(std::max(0, width)),
          static_cast<std::uint32_t>(std::max(0, height))};
}

bool Window::focused() const {
  return glfwGetWindowAttrib(handle_, GLFW_FOCUSED) != 0;
}

void Window::capture_pointer(bool captured) {
  if (captured == captured_) return;
  captured_ = captured;
  glfwSetInputMode(handle_, GLFW_CURSOR, captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  if (glfwRawMouseMotionSupported()) glfwSetInputMode(handle_, GLFW_RAW_MOUSE_MOTION, captured);
  input_.forget_pointer();
}

void Window::toggle_fullscreen() {
  if (glfwGetWindowMonitor(handle_)) {
    glfwSetWindowMonitor(handle_, nullptr, windowed_.x, windowed_.y, windowed_.width,
                         windowed_.height, GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = monitor_of(handle_);
  if (!monitor) return;
  glfwGetWindowPos(handle_, &windowed_.x, &windowed_.y);
  glfwGetWindowSize(handle_, &windowed_.width, &windowed_.height);
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  glfwSetWindowMonitor(handle_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(handle_, title.c_str());
}

}  // namespace skerry::platform
