// How our screens look: sizes that follow the window, colours, and the few widgets they are made
// of.
#pragma once
#include <imgui.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "game/ui/fonts.h"

namespace skerry::game::ui {

/// Pixels of one unit of layout: 1 in a window of 1280x720 at the usual scale.
float unit();

namespace colour {
inline constexpr ImU32 kText = IM_COL32(236, 240, 238, 255);
inline constexpr ImU32 kFaint = IM_COL32(168, 182, 184, 255);
inline constexpr ImU32 kAccent = IM_COL32(122, 204, 190, 255);
inline constexpr ImU32 kWarning = IM_COL32(240, 184, 96, 255);
inline constexpr ImU32 kPanel = IM_COL32(16, 26, 32, 226);
inline constexpr ImU32 kNothing = IM_COL32(16, 26, 32, 255);  // where there is no world
inline constexpr ImU32 kShade = IM_COL32(8, 14, 18, 150);
}  // namespace colour

/// For the frame between Gui::begin and Gui::end: where the functions below find fonts and scale.
/// @param fonts outlives the frame. @param width, height of the window [pixels]. @param scale of
/// everything, times the usual.
void begin_look(const Fonts& fonts, float width, float height, float scale);

void push_size(TextSize size);
void pop_size();

void text(std::string_view line);
void text_in(ImU32 colour, std::string_view line);
/// Broken into lines at the window's edge.
void text_wrapped(ImU32 colour, std::string_view lines);
/// @param beside said on the same line, in small and faint.
void heading(std::string_view line, std::string_view beside = {});
/// What fits into a width [pixels], with "..." for what does not.
std::string shortened(const std::string& line, float width);
/// Broken at spaces and after plus signs into lines no wider than that [pixels], as far as its
/// words allow.
std::string in_lines(std::string_view words, float width);
void gap(float units);

/// A line to type into, of `bytes` with the zero at its end. What is pasted and does not fit is
/// refused.
/// @return whether Enter was pressed in it.
bool text_field(const char* id, char* text, std::size_t bytes, const char* hint);
template <std::size_t kBytes>
bool text_field(const char* id, std::array<char, kBytes>& text, const char* hint = "") {
  return text_field(id, text.data(), kBytes, hint);
}
/// Letters as buttons, for who types with a gamepad: each appends to a text of `bytes` with the
/// zero at its end, if there is room. @param upper whether the letters are capitals; Shift turns it
/// over.
void letter_buttons(char* text, std::size_t bytes, bool& upper);
template <std::size_t kBytes>
void letter_buttons(std::array<char, kBytes>& text, bool& upper) {
  letter_buttons(text.data(), kBytes, upper);
}
/// Bytes that the field being shown has room for; for the clipboard.
std::size_t paste_room();

/// A button as wide as `width` units, or what is left with 0, and as its label needs at least.
/// @return whether it was pressed.
bool button(const char* label, float width = 0.0f);
/// The one that Enter, or its like on a gamepad, presses before another has been gone to.
bool first_button(const char* label, float width = 0.0f);
bool danger_button(const char* label, float width = 0.0f);

/// Sliders as wide as what is left. The keys that go left and right turn the one that has the
/// focus, without pressing it first. No number is typed into one. @param format of the value, as
/// printf takes it. @param step of a key. @return whether the value changed.
bool slide(const char* id, int& value, int least, int most, const char* format);
bool slide(const char* id, float& value, float least, float most, float step, const char* format);
/// For values of many sizes: a key goes by an eighth of the value.
bool slide_by_eighths(const char* id, int& value, int least, int most, const char* format);
/// Whether keys go through the widgets, so that hints about keys help.
bool by_keys();

/// Whether Enter, or its like on a gamepad, went down in this frame; between Gui::begin and end.
bool confirmed();

/// Enter counts as up until it is pressed again. A field that has just received the focus would
/// take a key that is still held, in a slow frame, for a repeated one.
void release_enter();

/// Panels of this frame keep so many pixels of the window's foot clear.
void keep_foot_clear(float pixels);

/// Where a panel stands.
enum class Place { kLeft, kMiddle };
/// A panel of at most so many units, never larger than the window. Call end_panel in any case.
void begin_panel(const char* id, Place place, float width, float height);
void end_panel();
/// A part that scrolls, of a panel; keys move into it and out of it.
void begin_scroll(const char* id, float height);
void end_scroll();

/// Darkens what is behind.
void shade();
/// Stands for the world behind screens while there is none.
void cover();

}  // namespace skerry::game::ui
