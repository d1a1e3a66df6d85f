// Our input as ImGui takes it.
#include <imgui.h>

#include <cfloat>
#include <iterator>

#include "game/ui/gui.h"
#include "game/ui/look.h"

namespace skerry::game::ui {
namespace {

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

/// Down, or tapped between two frames.
bool held(const InputFrame& input, Key key) {
  return input.down(key) || input.pressed(key);
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

void Gui::feed(const InputFrame& input) {
  ImGuiIO& io = ImGui::GetIO();
  io.AddMousePosEvent(static_cast<float>(input.pointer.x), static_cast<float>(input.pointer.y));
  for (int i = 0; i < static_cast<int>(std::size(kButtons)); ++i)
    io.AddMouseButtonEvent(i, held(input, kButtons[i]));
  io.AddMouseWheelEvent(0.0f, static_cast<float>(input.scroll));
  io.AddKeyEvent(ImGuiMod_Ctrl, input.down(Key::kControl));
  io.AddKeyEvent(ImGuiMod_Shift, input.down(Key::kShift));
  io.AddKeyEvent(ImGuiMod_Alt, input.down(Key::kAlt));
  for (const GuiKey& key : kGuiKeys) io.AddKeyEvent(key.theirs, held(input, key.ours));
  for (const GuiKey& key : kPadKeys)
    io.AddKeyAnalogEvent(key.theirs, held(input, key.ours), input.value(key.ours));
  for (const char32_t character : input.text)
    io.AddInputCharacter(static_cast<unsigned>(character));
}

bool confirmed() {
  return ImGui::IsKeyPressed(ImGuiKey_Enter, false) ||
         ImGui::IsKeyPressed(ImGuiKey_GamepadFaceDown, false);
}

void Gui::release_all() {
  feed({});
  ImGui::GetIO().AddMousePosEvent(-FLT_MAX, -FLT_MAX);
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

void Gui::feed(const InputFrame& input) {
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = ImVec2(static_cast<float>(input.pointer.x), static_cast<float>(input.pointer.y));
  for (std::size_t i = 0; i < std::size(kButtons); ++i) io.MouseDown[i] = held(input, kButtons[i]);
  io.MouseWheel += static_cast<float>(input.scroll);
  io.KeyCtrl = input.down(Key::kControl);
  io.KeyShift = input.down(Key::kShift);
  io.KeyAlt = input.down(Key::kAlt);
  for (const GuiKey& key : kGuiKeys) {
    io.KeyMap[key.theirs] = key.theirs;
    io.KeysDown[key.theirs] = held(input, key.ours);
  }
  for (const auto& pad : kPadInputs)
    if (held(input, pad.ours)) io.NavInputs[pad.theirs] = 1.0f;
  // Later versions do so themselves.
  if (input.pressed(Key::kEnter) && !io.WantTextInput) io.NavInputs[ImGuiNavInput_Activate] = 1.0f;
  for (const char32_t character : input.text)
    io.AddInputCharacter(static_cast<unsigned>(character));
}

bool confirmed() {
  return ImGui::GetIO().NavInputsDownDuration[ImGuiNavInput_Activate] == 0.0f;
}

void Gui::release_all() {
  feed({});
  ImGui::GetIO().MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
}

#endif

}  // namespace skerry::game::ui
