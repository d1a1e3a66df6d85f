// A gamepad that a test presses: preloaded before GLFW, it answers for its joystick layer. The file
// that SKERRY_TEST_PAD names holds what is pressed now: "button NUMBER" and "axis NUMBER VALUE",
// numbered as GLFW does; an empty file is a pad at rest, none is no pad. A line "state NUMBER"
// names what the file holds: once the program has read it, the file beside it, "....read", holds
// the number.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace {

std::string pad_path() {
  const char* path = std::getenv("SKERRY_TEST_PAD");
  return path ? path : "";
}

std::ifstream pad_file() {
  return std::ifstream(pad_path());
}

void tell_read(std::size_t state) {
  static std::size_t told = 0;
  if (state == told) return;
  told = state;
  const std::string path = pad_path() + ".read";
  std::ofstream(path + ".new") << state << '\n';
  std::rename((path + ".new").c_str(), path.c_str());
}

}  // namespace

extern "C" int glfwJoystickIsGamepad(int id) {
  return id == GLFW_JOYSTICK_1 && pad_file().good() ? GLFW_TRUE : GLFW_FALSE;
}

extern "C" int glfwGetGamepadState(int id, GLFWgamepadstate* state) {
  std::ifstream file = pad_file();
  if (id != GLFW_JOYSTICK_1 || !file) return GLFW_FALSE;
  std::fill(std::begin(state->buttons), std::end(state->buttons),
            static_cast<unsigned char>(GLFW_RELEASE));
  std::fill(std::begin(state->axes), std::end(state->axes), 0.0f);
  state->axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] = state->axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER] =
      -1.0f;
  std::string kind;
  std::size_t number = 0;
  while (file >> kind >> number) {
    float value = 0.0f;
    if (kind == "axis") file >> value;
    if (kind == "axis" && number < std::size(state->axes)) state->axes[number] = value;
    if (kind == "state") tell_read(number);
    if (kind == "button" && number < std::size(state->buttons)) state->buttons[number] = GLFW_PRESS;
  }
  return GLFW_TRUE;
}
