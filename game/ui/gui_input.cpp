// Our input as ImGui takes it.
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <iterator>
#include <optional>
#include <vector>

#include "game/ui/gui.h"
#include "game/ui/look.h"

namespace skerry::game::ui {
namespace {

using platform::InputEvent;
using platform::InputFrame;
using platform::Key;

/// Keys of text fields and navigation.
struct GuiKey {
  Key ours;
  ImGuiKey theirs;
};
constexpr GuiKey kGuiKeys[] = {
    {Key::kTab, ImGuiKey_Tab},
    {Key::kLeft, ImGuiKey_LeftArrow},
    {Key::kRight, ImGuiKey_RightArrow},
    {Key::kUp, ImGuiKey_UpArrow},
    {Key::kDown, ImGuiKey_DownArrow},
    {Key::kPageUp, ImGuiKey_PageUp},
    {Key::kPageDown, ImGuiKey_PageDown},
    {Key::kHome, ImGuiKey_Home},
    {Key::kEnd, ImGuiKey_End},
    {Key::kInsert, ImGuiKey_Insert},
    {Key::kDelete, ImGuiKey_Delete},
    {Key::kBackspace, ImGuiKey_Backspace},
    {Key::kSpace, ImGuiKey_Space},
    {Key::kEnter, ImGuiKey_Enter},
    {Key::kEscape, ImGuiKey_Escape},
    {Key::kA, ImGuiKey_A},
    {Key::kC, ImGuiKey_C},
    {Key::kV, ImGuiKey_V},
    {Key::kX, ImGuiKey_X},
    {Key::kY, ImGuiKey_Y},
    {Key::kZ, ImGuiKey_Z},
};
constexpr Key kButtons[] = {Key::kMouseLeft, Key::kMouseRight, Key::kMouseMiddle};

std::optional<ImGuiKey> gui_key(Key key) {
  const auto found = std::find_if(std::begin(kGuiKeys), std::end(kGuiKeys),
                                  [key](const GuiKey& known) { return known.ours == key; });
  if (found == std::end(kGuiKeys)) return std::nullopt;
  return found->theirs;
}

std::optional<int> mouse_button(Key key) {
  const auto found = std::find(std::begin(kButtons), std::end(kButtons), key);
  if (found == std::end(kButtons)) return std::nullopt;
  return static_cast<int>(found - std::begin(kButtons));
}

/// Of a key, a button or a character.
bool is_press(const InputEvent& event) {
  if (event.key == Key::kNone) return true;
  return event.down && (gui_key(event.key) || mouse_button(event.key));
}

bool moves_focus(const InputEvent& event) {
  return event.down && (event.key == Key::kEnter || event.key == Key::kTab);
}

}  // namespace

#if IMGUI_VERSION_NUM >= 18700

namespace {

constexpr GuiKey kPadKeys[] = {
    {Key::kPadA, ImGuiKey_GamepadFaceDown},
    {Key::kPadB, ImGuiKey_GamepadFaceRight},
    {Key::kPadX, ImGuiKey_GamepadFaceLeft},
    {Key::kPadY, ImGuiKey_GamepadFaceUp},
    {Key::kPadLeft, ImGuiKey_GamepadDpadLeft},
    {Key::kPadRight, ImGuiKey_GamepadDpadRight},
    {Key::kPadUp, ImGuiKey_GamepadDpadUp},
    {Key::kPadDown, ImGuiKey_GamepadDpadDown},
    {Key::kPadLeftBumper, ImGuiKey_GamepadL1},
    {Key::kPadRightBumper, ImGuiKey_GamepadR1},
    {Key::kPadLeftStickLeft, ImGuiKey_GamepadLStickLeft},
    {Key::kPadLeftStickRight, ImGuiKey_GamepadLStickRight},
    {Key::kPadLeftStickUp, ImGuiKey_GamepadLStickUp},
    {Key::kPadLeftStickDown, ImGuiKey_GamepadLStickDown},
};

}  // namespace

/// ImGui has a queue of its own, and shows a frame no more of it than a frame can tell apart.
void Gui::feed(const InputFrame& input) {
  ImGuiIO& io = ImGui::GetIO();
  const auto point = [&](glm::dvec2 at) {
    io.AddMousePosEvent(static_cast<float>(at.x), static_cast<float>(at.y));
  };
  queue_.insert(queue_.end(), input.events.begin(), input.events.end());
  rest_ = std::max(0, rest_ - 1);
  while (!queue_.empty()) {
    const InputEvent event = queue_.front();
    if (rest_ > 0 && is_press(event)) break;
    queue_.pop_front();
    if (moves_focus(event)) rest_ = kFramesOfFocus;
    if (event.key == Key::kNone) io.AddInputCharacter(static_cast<unsigned>(event.character));
    if (event.key == Key::kControl) io.AddKeyEvent(ImGuiMod_Ctrl, event.down);
    if (event.key == Key::kShift) io.AddKeyEvent(ImGuiMod_Shift, event.down);
    if (event.key == Key::kAlt) io.AddKeyEvent(ImGuiMod_Alt, event.down);
    if (const auto key = gui_key(event.key)) io.AddKeyEvent(*key, event.down);
    if (const auto button = mouse_button(event.key)) {
      point(event.pointer);
      io.AddMouseButtonEvent(*button, event.down);
    }
  }
  // A key that was let go while no screen was fed, as when a world is left, comes without an event.
  if (queue_.empty())
    for (const GuiKey& key : kGuiKeys)
      if (!input.down(key.ours)) io.AddKeyEvent(key.theirs, false);
  point(input.pointer);
  io.AddMouseWheelEvent(0.0f, static_cast<float>(input.scroll));
  for (const GuiKey& key : kPadKeys)
    io.AddKeyAnalogEvent(key.theirs, input.down(key.ours) || input.pressed(key.ours),
                         input.value(key.ours));
}

bool confirmed() {
  return ImGui::IsKeyPressed(ImGuiKey_Enter, false) ||
         ImGui::IsKeyPressed(ImGuiKey_GamepadFaceDown, false);
}

void release_enter() {
  ImGui::GetIO().AddKeyEvent(ImGuiKey_Enter, false);
}

void Gui::release_all() {
  ImGuiIO& io = ImGui::GetIO();
  queue_.clear();
  for (const ImGuiKey modifier : {ImGuiMod_Ctrl, ImGuiMod_Shift, ImGuiMod_Alt})
    io.AddKeyEvent(modifier, false);
  for (const GuiKey& key : kGuiKeys) io.AddKeyEvent(key.theirs, false);
  for (int i = 0; i < static_cast<int>(std::size(kButtons)); ++i) io.AddMouseButtonEvent(i, false);
  feed({});
  io.AddMousePosEvent(-FLT_MAX, -FLT_MAX);
}

#else  // ImGui of Debian 12

namespace {

constexpr struct {
  Key ours;
  ImGuiNavInput theirs;
} kPadInputs[] = {
    {Key::kPadA, ImGuiNavInput_Activate},
    {Key::kPadB, ImGuiNavInput_Cancel},
    {Key::kPadY, ImGuiNavInput_Input},
    {Key::kPadLeft, ImGuiNavInput_DpadLeft},
    {Key::kPadRight, ImGuiNavInput_DpadRight},
    {Key::kPadUp, ImGuiNavInput_DpadUp},
    {Key::kPadDown, ImGuiNavInput_DpadDown},
    {Key::kPadLeftBumper, ImGuiNavInput_TweakSlow},
    {Key::kPadRightBumper, ImGuiNavInput_TweakFast},
    {Key::kPadLeftStickLeft, ImGuiNavInput_DpadLeft},
    {Key::kPadLeftStickRight, ImGuiNavInput_DpadRight},
    {Key::kPadLeftStickUp, ImGuiNavInput_DpadUp},
    {Key::kPadLeftStickDown, ImGuiNavInput_DpadDown},
};

}  // namespace

namespace {

bool is_modifier(Key key) {
  return key == Key::kControl || key == Key::kShift || key == Key::kAlt;
}

/// What a frame of this ImGui has taken in already. It keeps no queue: in a frame it reads first
/// the characters, then the keys, all with the modifiers that are down at the frame's beginning,
/// a key that goes down and up within the frame was never pressed, and one that goes up and down
/// again was held on.
struct TakenIn {
  bool characters = false, press = false, click = false;
  std::vector<Key> released;

  /// Whether the frame would read the event as if it had come before, or never.
  bool has_room_for(const InputEvent& event, const ImGuiIO& io) const {
    if (event.key == Key::kNone) return !press && !click;
    if (is_modifier(event.key)) return !characters && !press;
    if (mouse_button(event.key)) return !click && !press;
    if (const auto key = gui_key(event.key))
      return event.down ? !press && !click && !has_released(event.key)
                        : !press || !io.KeysDown[*key];
    return true;
  }
  bool has_released(Key key) const {
    return std::find(released.begin(), released.end(), key) != released.end();
  }
  void note(const InputEvent& event) {
    if (!event.down) released.push_back(event.key);
    characters |= event.key == Key::kNone;
    press |= event.down && gui_key(event.key).has_value();
    click |= mouse_button(event.key).has_value();
  }
};

void take_in(const InputEvent& event, ImGuiIO& io) {
  if (event.key == Key::kNone) io.AddInputCharacter(static_cast<unsigned>(event.character));
  if (event.key == Key::kControl) io.KeyCtrl = event.down;
  if (event.key == Key::kShift) io.KeyShift = event.down;
  if (event.key == Key::kAlt) io.KeyAlt = event.down;
  if (const auto key = gui_key(event.key)) {
    io.KeysDown[*key] = event.down;
    // Later versions do so themselves.
    if (event.key == Key::kEnter && event.down && !io.WantTextInput)
      io.NavInputs[ImGuiNavInput_Activate] = 1.0f;
  }
  if (const auto button = mouse_button(event.key)) {
    io.MouseDown[*button] = event.down;
    io.MousePos = ImVec2(static_cast<float>(event.pointer.x), static_cast<float>(event.pointer.y));
  }
}

/// Letters are keys to ImGui as parts of chords only.
bool means_nothing(const InputEvent& event, bool control) {
  return event.key >= Key::kA && event.key <= Key::kZ && event.down && !control;
}

}  // namespace

void Gui::feed(const InputFrame& input) {
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = ImVec2(static_cast<float>(input.pointer.x), static_cast<float>(input.pointer.y));
  io.MouseWheel += static_cast<float>(input.scroll);
  for (const GuiKey& key : kGuiKeys) io.KeyMap[key.theirs] = key.theirs;
  for (const auto& pad : kPadInputs)
    if (input.down(pad.ours) || input.pressed(pad.ours)) io.NavInputs[pad.theirs] = 1.0f;
  queue_.insert(queue_.end(), input.events.begin(), input.events.end());
  rest_ = std::max(0, rest_ - 1);
  TakenIn taken;
  while (!queue_.empty()) {
    const InputEvent event = queue_.front();
    if (rest_ > 0 && is_press(event)) break;
    const bool skipped = means_nothing(event, io.KeyCtrl);
    if (!skipped && !taken.has_room_for(event, io)) break;
    queue_.pop_front();
    if (skipped) continue;
    if (moves_focus(event)) rest_ = kFramesOfFocus;
    take_in(event, io);
    taken.note(event);
  }
  // A key that was let go while no screen was fed, as when a world is left, comes without an event.
  if (!queue_.empty() || taken.press) return;
  for (const GuiKey& key : kGuiKeys)
    if (!input.down(key.ours)) io.KeysDown[key.theirs] = false;
}

bool confirmed() {
  return ImGui::GetIO().NavInputsDownDuration[ImGuiNavInput_Activate] == 0.0f;
}

void release_enter() {
  ImGui::GetIO().KeysDown[ImGuiKey_Enter] = false;
}

void Gui::release_all() {
  ImGuiIO& io = ImGui::GetIO();
  queue_.clear();
  io.KeyCtrl = io.KeyShift = io.KeyAlt = false;
  std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
  std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
  feed({});
  io.MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
}

#endif

}  // namespace skerry::game::ui
