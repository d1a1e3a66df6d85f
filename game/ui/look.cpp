#include "game/ui/look.h"

#include <imgui_internal.h>  // which way the keys go

#include <algorithm>
#include <cstring>
#include <utility>

#include "game/words/words.h"

namespace skerry::game::ui {
namespace {

constexpr float kLeastUnit = 0.62f, kMostUnit = 4.0f;  // pixels

struct Look {
  const Fonts* fonts = nullptr;
  float unit = 1.0f;
  std::size_t paste_room = 0;
  float foot = 0.0f;  // pixels that panels keep clear
};
Look look;  // ImGui's context is as global, and there is one of either

ImVec4 with_alpha(ImU32 packed, float alpha) {
  ImVec4 value = ImGui::ColorConvertU32ToFloat4(packed);
  value.w = alpha;
  return value;
}

void set_colours(ImGuiStyle& style) {
  ImGui::StyleColorsDark(&style);
  const auto set = [&](ImGuiCol which, const ImVec4& value) { style.Colors[which] = value; };
  set(ImGuiCol_Text, with_alpha(colour::kText, 1.0f));
  set(ImGuiCol_TextDisabled, with_alpha(colour::kFaint, 1.0f));
  set(ImGuiCol_WindowBg, ImGui::ColorConvertU32ToFloat4(colour::kPanel));
  set(ImGuiCol_ChildBg, ImVec4(0, 0, 0, 0));
  set(ImGuiCol_PopupBg, ImVec4(0.07f, 0.11f, 0.13f, 0.98f));
  set(ImGuiCol_Border, ImVec4(1, 1, 1, 0.09f));
  for (const ImGuiCol which : {ImGuiCol_FrameBg, ImGuiCol_Button})
    set(which, ImVec4(1, 1, 1, 0.075f));
  for (const ImGuiCol which :
       {ImGuiCol_FrameBgHovered, ImGuiCol_ButtonHovered, ImGuiCol_HeaderHovered})
    set(which, with_alpha(colour::kAccent, 0.26f));
  for (const ImGuiCol which :
       {ImGuiCol_FrameBgActive, ImGuiCol_ButtonActive, ImGuiCol_HeaderActive})
    set(which, with_alpha(colour::kAccent, 0.42f));
  set(ImGuiCol_Header, with_alpha(colour::kAccent, 0.20f));
  for (const ImGuiCol which : {ImGuiCol_CheckMark, ImGuiCol_PlotLines})
    set(which, with_alpha(colour::kAccent, 1.0f));
  // The value is written over the grab, and must read there.
  set(ImGuiCol_SliderGrab, ImVec4(0.13f, 0.33f, 0.31f, 1.0f));
  set(ImGuiCol_SliderGrabActive, ImVec4(0.17f, 0.42f, 0.39f, 1.0f));
  set(ImGuiCol_NavHighlight, with_alpha(colour::kAccent, 1.0f));
  set(ImGuiCol_TextSelectedBg, with_alpha(colour::kAccent, 0.40f));
  set(ImGuiCol_ScrollbarBg, ImVec4(0, 0, 0, 0));
  set(ImGuiCol_ScrollbarGrab, ImVec4(1, 1, 1, 0.18f));
  set(ImGuiCol_ScrollbarGrabHovered, ImVec4(1, 1, 1, 0.30f));
  set(ImGuiCol_ScrollbarGrabActive, ImVec4(1, 1, 1, 0.40f));
  set(ImGuiCol_Separator, ImVec4(1, 1, 1, 0.12f));
  set(ImGuiCol_ModalWindowDimBg, ImVec4(0.02f, 0.04f, 0.05f, 0.6f));
}

void set_sizes(ImGuiStyle& style, float u) {
  style.WindowPadding = ImVec2(28 * u, 24 * u);
  style.WindowRounding = 10 * u;
  style.ChildRounding = 6 * u;
  style.PopupRounding = 8 * u;
  style.FramePadding = ImVec2(14 * u, 7 * u);
  style.FrameRounding = 6 * u;
  style.ItemSpacing = ImVec2(10 * u, 8 * u);
  style.ItemInnerSpacing = ImVec2(8 * u, 6 * u);
  style.CellPadding = ImVec2(6 * u, 3 * u);
  style.ScrollbarSize = 12 * u;
  style.ScrollbarRounding = 6 * u;
  style.GrabMinSize = 14 * u;
  style.GrabRounding = 4 * u;
  style.WindowBorderSize = style.PopupBorderSize = 1.0f;
  style.WindowMinSize = ImVec2(1, 1);
}

}  // namespace

float unit() {
  return look.unit;
}

void begin_look(const Fonts& fonts, float width, float height, float scale) {
  const float usual = std::clamp(std::min(width / 1280.0f, height / 720.0f), kLeastUnit, kMostUnit);
  look = {&fonts, std::clamp(usual * scale, kLeastUnit, kMostUnit), 0, 0.0f};
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  set_colours(style);
  set_sizes(style, look.unit);
  ImGui::GetIO().FontDefault = fonts.at(TextSize::kBody, look.unit);
}

void push_size(TextSize size) {
  ImGui::PushFont(look.fonts->at(size, look.unit));
}

void pop_size() {
  ImGui::PopFont();
}

void text(std::string_view line) {
  ImGui::TextUnformatted(line.data(), line.data() + line.size());
}

void text_in(ImU32 colour, std::string_view line) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  text(line);
  ImGui::PopStyleColor();
}

void text_wrapped(ImU32 colour, std::string_view lines) {
  ImGui::PushTextWrapPos(0.0f);
  text_in(colour, lines);
  ImGui::PopTextWrapPos();
}

void heading(std::string_view line, std::string_view beside) {
  push_size(TextSize::kHeading);
  text(line);
  const float height = ImGui::GetTextLineHeight();
  pop_size();
  if (!beside.empty()) {
    ImGui::SameLine(0.0f, 20 * unit());
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 0.75f * (height - ImGui::GetTextLineHeight()));
    text_in(colour::kFaint, beside);
  }
  gap(6);
}

std::string shortened(const std::string& line, float width) {
  if (ImGui::CalcTextSize(line.c_str()).x <= width) return line;
  std::string out = line;
  while (!out.empty() && ImGui::CalcTextSize((out + "...").c_str()).x > width) do
      out.pop_back();
    while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xc0) == 0x80);
  return out + "...";
}

std::string in_lines(std::string_view words, float width) {
  std::string lines, line;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find_first_of(" +"), words.size() - 1) + 1;
    const std::string word(words.substr(0, end));
    words.remove_prefix(end);
    const auto shown = [](const std::string& text) {  // without the space at its end
      return text.ends_with(' ') ? text.substr(0, text.size() - 1) : text;
    };
    if (!line.empty() && ImGui::CalcTextSize(shown(line + word).c_str()).x > width) {
      lines += shown(line) + "\n";
      line.clear();
    }
    line += word;
  }
  return lines + line;
}

void gap(float units) {
  ImGui::Dummy(ImVec2(1.0f, units * unit()));
}

std::size_t paste_room() {
  return look.paste_room;
}

bool text_field(const char* id, char* text, std::size_t bytes, const char* hint) {
  // ImGui refuses a text that does not fit, as a whole.
  look.paste_room = bytes - 1 - std::min(bytes - 1, std::strlen(text));
  return ImGui::InputTextWithHint(id, hint, text, bytes, ImGuiInputTextFlags_EnterReturnsTrue);
}

namespace {

void append(char* text, std::size_t bytes, char character) {
  const std::size_t length = std::strlen(text);
  if (length + 1 >= bytes) return;
  text[length] = character;
  text[length + 1] = '\0';
}

/// The last character of UTF-8 goes as a whole.
void take_last(char* text) {
  std::size_t length = std::strlen(text);
  while (length > 0 && (static_cast<unsigned char>(text[length - 1]) & 0xc0) == 0x80) --length;
  if (length > 0) text[length - 1] = '\0';
}

}  // namespace

void letter_buttons(char* text, std::size_t bytes, bool& upper) {
  constexpr std::string_view kRows[] = {"1234567890", "qwertyuiop", "asdfghjkl'", "zxcvbnm-.,"};
  const float between = 4 * unit();
  const float all = ImGui::GetContentRegionAvail().x;
  const ImVec2 size(std::max(1.0f, (all - 9 * between) / 10), 30 * unit());
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(between, between));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.0f, 2 * unit()));
  for (const std::string_view row : kRows) {
    for (const char& letter : row) {
      if (&letter != row.data()) ImGui::SameLine();
      const bool letters = letter >= 'a' && letter <= 'z';
      const char shown[] = {upper && letters ? static_cast<char>(letter - 'a' + 'A') : letter, 0};
      if (ImGui::Button(shown, size)) append(text, bytes, shown[0]);
    }
  }
  const ImVec2 third(std::max(1.0f, (all - 2 * between) / 3), size.y);
  if (ImGui::Button(upper ? tr("small letters") : tr("CAPITALS"), third)) upper = !upper;
  ImGui::SameLine();
  if (ImGui::Button(tr("space"), third)) append(text, bytes, ' ');
  ImGui::SameLine();
  if (ImGui::Button(tr("delete"), third)) take_last(text);
  ImGui::PopStyleVar(2);
}

namespace {

/// Left -1, right 1, if such a key was pressed while the last item has the focus. ImGui would go to
/// another item with it.
int key_steps() {
  ImGuiContext& context = *ImGui::GetCurrentContext();
  if (!ImGui::IsItemFocused() || ImGui::IsItemActive()) return 0;
  if (!context.NavMoveSubmitted) return 0;
  const int steps = (context.NavMoveDir == ImGuiDir_Right) - (context.NavMoveDir == ImGuiDir_Left);
  if (steps != 0) ImGui::NavMoveRequestCancel();
  return steps;
}

constexpr ImGuiSliderFlags kSlide = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput;

/// What keys add to a value that was slid, too.
bool stepped_by(int change, int& value, int least, int most) {
  const int stepped = std::clamp(value + change, least, most);
  return std::exchange(value, stepped) != stepped;
}

}  // namespace

bool by_keys() {
  return ImGui::GetIO().NavVisible;
}

bool slide(const char* id, int& value, int least, int most, const char* format) {
  ImGui::SetNextItemWidth(-1.0f);
  const bool slid = ImGui::SliderInt(id, &value, least, most, format, kSlide);
  return stepped_by(key_steps(), value, least, most) || slid;
}

bool slide_by_eighths(const char* id, int& value, int least, int most, const char* format) {
  const int step = std::max(1, value / 8);
  ImGui::SetNextItemWidth(-1.0f);
  const bool slid =
      ImGui::SliderInt(id, &value, least, most, format, kSlide | ImGuiSliderFlags_Logarithmic);
  return stepped_by(key_steps() * step, value, least, most) || slid;
}

bool slide(const char* id, float& value, float least, float most, float step, const char* format) {
  ImGui::SetNextItemWidth(-1.0f);
  const bool slid = ImGui::SliderFloat(id, &value, least, most, format, kSlide);
  const float stepped = std::clamp(value + static_cast<float>(key_steps()) * step, least, most);
  return std::exchange(value, stepped) != stepped || slid;
}

bool button(const char* label, float width) {
  // Text keeps a readable size in small windows; better too wide a button than half a word.
  const float words =
      ImGui::CalcTextSize(label, nullptr, true).x + 2.0f * ImGui::GetStyle().FramePadding.x;
  const float pixels = width > 0.0f ? width * unit() : ImGui::GetContentRegionAvail().x;
  return ImGui::Button(label, ImVec2(std::max(pixels, words), 40 * unit()));
}

bool first_button(const char* label, float width) {
  ImVec4 accent = ImGui::ColorConvertU32ToFloat4(colour::kAccent);
  accent.w = 0.30f;
  ImGui::PushStyleColor(ImGuiCol_Button, accent);
  const bool pressed = button(label, width);
  ImGui::PopStyleColor();
  ImGui::SetItemDefaultFocus();
  // ImGui goes to it on the first key and presses it on the second.
  const bool first_key = !ImGui::GetIO().NavVisible && ImGui::IsWindowFocused() &&
                         !ImGui::IsAnyItemActive() && confirmed();
  return pressed || first_key;
}

bool danger_button(const char* label, float width) {
  ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.75f, 0.25f, 0.20f, 0.45f));
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, ImVec4(0.80f, 0.28f, 0.22f, 0.75f));
  const bool pressed = button(label, width);
  ImGui::PopStyleColor(2);
  return pressed;
}

void keep_foot_clear(float pixels) {
  look.foot = pixels;
}

void begin_panel(const char* id, Place place, float width, float height) {
  const ImVec2 whole = ImGui::GetIO().DisplaySize;
  const ImVec2 window(whole.x, whole.y - std::min(look.foot, 0.5f * whole.y));
  const float edge = 16 * unit();
  const ImVec2 size(std::max(1.0f, std::min(width * unit(), window.x - 2 * edge)),
                    std::max(1.0f, std::min(height * unit(), window.y - 2 * edge)));
  const bool left = place == Place::kLeft;
  const float x = left ? std::min(56 * unit(), std::max(edge, window.x - size.x - edge))
                       : 0.5f * (window.x - size.x);
  ImGui::SetNextWindowPos(ImVec2(x, 0.5f * (window.y - size.y)), ImGuiCond_Always);
  ImGui::SetNextWindowSize(size, ImGuiCond_Always);
  ImGui::Begin(id, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
}

void end_panel() {
  ImGui::End();
}

void begin_scroll(const char* id, float height) {
#if IMGUI_VERSION_NUM >= 19090
  ImGui::BeginChild(id, ImVec2(0.0f, height), ImGuiChildFlags_NavFlattened);
#else
  ImGui::BeginChild(id, ImVec2(0.0f, height), false, ImGuiWindowFlags_NavFlattened);
#endif
}

void end_scroll() {
  ImGui::EndChild();
}

void shade() {
  ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0, 0), ImGui::GetIO().DisplaySize,
                                                colour::kShade);
}

void cover() {
  ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0, 0), ImGui::GetIO().DisplaySize,
                                                colour::kNothing);
}

}  // namespace skerry::game::ui
