#include "engine/platform/window.h"

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <optional>

namespace skerry::platform {
namespace {

std::string last_problem() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

/// A key of ours and the keys of GLFW that are it.
struct KeyPair {
  Key key;
  int first, second = GLFW_KEY_UNKNOWN;
};
constexpr KeyPair kKeys[] = {
    {Key::kF1, GLFW_KEY_F1},
    {Key::kF2, GLFW_KEY_F2},
    {Key::kF3, GLFW_KEY_F3},
    {Key::kF4, GLFW_KEY_F4},
    {Key::kF5, GLFW_KEY_F5},
    {Key::kF6, GLFW_KEY_F6},
    {Key::kF7, GLFW_KEY_F7},
    {Key::kF8, GLFW_KEY_F8},
    {Key::kF9, GLFW_KEY_F9},
    {Key::kF10, GLFW_KEY_F10},
    {Key::kF11, GLFW_KEY_F11},
    {Key::kF12, GLFW_KEY_F12},
    {Key::kSpace, GLFW_KEY_SPACE},
    {Key::kShift, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT},
    {Key::kControl, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL},
    {Key::kAlt, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT},
    {Key::kTab, GLFW_KEY_TAB},
    {Key::kEnter, GLFW_KEY_ENTER, GLFW_KEY_KP_ENTER},
    {Key::kBackspace, GLFW_KEY_BACKSPACE},
    {Key::kEscape, GLFW_KEY_ESCAPE},
    {Key::kCapsLock, GLFW_KEY_CAPS_LOCK},
    {Key::kInsert, GLFW_KEY_INSERT},
    {Key::kDelete, GLFW_KEY_DELETE},
    {Key::kHome, GLFW_KEY_HOME},
    {Key::kEnd, GLFW_KEY_END},
    {Key::kPageUp, GLFW_KEY_PAGE_UP},
    {Key::kPageDown, GLFW_KEY_PAGE_DOWN},
    {Key::kUp, GLFW_KEY_UP},
    {Key::kDown, GLFW_KEY_DOWN},
    {Key::kLeft, GLFW_KEY_LEFT},
    {Key::kRight, GLFW_KEY_RIGHT},
    {Key::kMinus, GLFW_KEY_MINUS, GLFW_KEY_KP_SUBTRACT},
    {Key::kPlus, GLFW_KEY_EQUAL, GLFW_KEY_KP_ADD},
    {Key::kLeftBracket, GLFW_KEY_LEFT_BRACKET},
    {Key::kRightBracket, GLFW_KEY_RIGHT_BRACKET},
    {Key::kBackslash, GLFW_KEY_BACKSLASH},
    {Key::kSemicolon, GLFW_KEY_SEMICOLON},
    {Key::kApostrophe, GLFW_KEY_APOSTROPHE},
    {Key::kComma, GLFW_KEY_COMMA},
    {Key::kPeriod, GLFW_KEY_PERIOD},
    {Key::kSlash, GLFW_KEY_SLASH, GLFW_KEY_KP_DIVIDE},
    {Key::kGrave, GLFW_KEY_GRAVE_ACCENT},
};
constexpr Key kButtons[] = {Key::kMouseLeft, Key::kMouseRight, Key::kMouseMiddle, Key::kMouse4,
                            Key::kMouse5};

/// The key `steps` after `first` in the order of the enumeration.
Key key_after(Key first, int steps) {
  return static_cast<Key>(static_cast<int>(first) + steps);
}

std::optional<KeyPair> key_of(int glfw_key) {
  if (glfw_key >= GLFW_KEY_A && glfw_key <= GLFW_KEY_Z)
    return KeyPair{key_after(Key::kA, glfw_key - GLFW_KEY_A), glfw_key};
  if (glfw_key >= GLFW_KEY_0 && glfw_key <= GLFW_KEY_9)
    return KeyPair{key_after(Key::k0, glfw_key - GLFW_KEY_0), glfw_key};
  for (const KeyPair& pair : kKeys)
    if (glfw_key == pair.first || glfw_key == pair.second) return pair;
  return std::nullopt;
}

WindowEvents& events_of(GLFWwindow* handle) {
  return *static_cast<WindowEvents*>(glfwGetWindowUserPointer(handle));
}
Input& input_of(GLFWwindow* handle) {
  return events_of(handle).input;
}
void on_disturbance(GLFWwindow* handle, int) {
  events_of(handle).disturb(glfwGetTime());
}
void on_displacement(GLFWwindow* handle, int, int) {
  events_of(handle).disturb(glfwGetTime());
}

void on_key(GLFWwindow* handle, int key, int, int action, int) {
  const std::optional<KeyPair> known = key_of(key);
  if (!known) return;
  // Of two keys that are one to us, one may go up while the other is held.
  const int other = key == known->first ? known->second : known->first;
  const bool held = other != GLFW_KEY_UNKNOWN && glfwGetKey(handle, other) == GLFW_PRESS;
  input_of(handle).set_key(known->key, action != GLFW_RELEASE || held);
}

void on_button(GLFWwindow* handle, int button, int action, int) {
  if (button >= 0 && button < static_cast<int>(std::size(kButtons)))
    input_of(handle).set_key(kButtons[button], action != GLFW_RELEASE);
}

void on_character(GLFWwindow* handle, unsigned character) {
  input_of(handle).type(character);
}

void on_pointer(GLFWwindow* handle, double x, double y) {
  events_of(handle).move_pointer({x, y}, glfwGetTime());
}
void on_scroll(GLFWwindow* handle, double, double y) {
  input_of(handle).add_scroll(y);
}
void on_focus(GLFWwindow* handle, int focused) {
  if (!focused) input_of(handle).lose_focus();
  on_disturbance(handle, focused);
}

/// The first gamepad that has a known layout.
std::optional<PadState> pad_state() {
  static_assert(GLFW_GAMEPAD_BUTTON_LAST + 1 == 15 && GLFW_GAMEPAD_AXIS_LAST + 1 == 6);
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
    GLFWgamepadstate seen;
    if (!glfwJoystickIsGamepad(id) || !glfwGetGamepadState(id, &seen)) continue;
    PadState pad;
    for (std::size_t i = 0; i < pad.buttons.size(); ++i)
      pad.buttons[i] = seen.buttons[i] == GLFW_PRESS;
    std::copy(std::begin(seen.axes), std::end(seen.axes), pad.axes.begin());
    return pad;
  }
  return std::nullopt;
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

/// GLFW from 3.4 on looks for Wayland unasked, and where none runs libwayland writes a line of its
/// own to stderr.
void look_for_named_displays() {
#ifdef GLFW_PLATFORM
  if (!std::getenv("WAYLAND_DISPLAY")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
}

}  // namespace

void WindowEvents::disturb(double now_s) {
  polls_left_ = kPolls;
  settled_s_ = now_s + kSettling;
  for (const Motion& motion : recent_) input.take_back_motion(motion.delta);
  recent_.clear();
}

void WindowEvents::move_pointer(glm::dvec2 place, double now_s) {
  const bool settled = polls_left_ == 0 && now_s >= settled_s_;
  if (!settled) return input.place_pointer(place);
  recent_.push_back({input.move_pointer(place), now_s});
}

void WindowEvents::drop_mouse() {
  input.drop_mouse();
  recent_.clear();  // there is nothing left to take back
}

void WindowEvents::end_poll(double now_s) {
  polls_left_ = std::max(0, polls_left_ - 1);
  for (Motion& motion : recent_) ++motion.polls;
  while (!recent_.empty() && recent_.front().polls >= kPolls &&
         now_s - recent_.front().at_s > kSettling)
    recent_.pop_front();
}

Result<std::unique_ptr<Window>> Window::create(const WindowOptions& options) {
  look_for_named_displays();
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
  glfwSetWindowUserPointer(handle_, &events_);
  glfwSetKeyCallback(handle_, on_key);
  glfwSetCharCallback(handle_, on_character);
  glfwSetMouseButtonCallback(handle_, on_button);
  glfwSetCursorPosCallback(handle_, on_pointer);
  glfwSetScrollCallback(handle_, on_scroll);
  glfwSetWindowFocusCallback(handle_, on_focus);
  glfwSetWindowIconifyCallback(handle_, on_disturbance);
  glfwSetWindowMaximizeCallback(handle_, on_disturbance);
  glfwSetWindowPosCallback(handle_, on_displacement);
  glfwSetWindowSizeCallback(handle_, on_displacement);
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
  // A pad's owner may be busy in another window.
  if (focused()) events_.input.set_pad(pad_state());
  events_.end_poll(glfwGetTime());
  InputFrame frame = events_.input.take();
  int width = 0, height = 0;
  glfwGetWindowSize(handle_, &width, &height);
  const FramebufferSize pixels = framebuffer_size();
  if (width > 0 && height > 0) {
    const glm::dvec2 scale = glm::dvec2(pixels.width, pixels.height) / glm::dvec2(width, height);
    frame.pointer *= scale;
    for (InputEvent& event : frame.events) event.pointer *= scale;
  }
  return frame;
}

void Window::keep_answering() {
  glfwPollEvents();
  events_.drop_mouse();
}

bool Window::should_close() const {
  return glfwWindowShouldClose(handle_) != 0;
}
void Window::close() {
  glfwSetWindowShouldClose(handle_, GLFW_TRUE);
}
void Window::stay_open() {
  glfwSetWindowShouldClose(handle_, GLFW_FALSE);
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

double Window::refresh_hz() const {
  constexpr double kUsual = 60.0;
  GLFWmonitor* monitor = monitor_of(handle_);
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  return mode && mode->refreshRate > 0 ? mode->refreshRate : kUsual;
}

void Window::capture_pointer(bool captured) {
  if (captured == captured_) return;
  captured_ = captured;
  glfwSetInputMode(handle_, GLFW_CURSOR, captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  if (glfwRawMouseMotionSupported()) glfwSetInputMode(handle_, GLFW_RAW_MOUSE_MOTION, captured);
  events_.disturb(glfwGetTime());
  // GLFW tells of no place that it puts the pointer to itself, and motion counts from there.
  glm::dvec2 place{};
  glfwGetCursorPos(handle_, &place.x, &place.y);
  events_.input.place_pointer(place);
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

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(handle_);
  return text ? text : "";
}

void Window::set_clipboard(const std::string& text) {
  glfwSetClipboardString(handle_, text.c_str());
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(handle_, title.c_str());
}

}  // namespace skerry::platform
