#include "game/ui/screens.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>

#include "game/ui/look.h"
#include "game/words/words.h"

namespace skerry::game::ui {

void show_screens(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  const std::optional<Screen> top = state.stack.top();
  if (!top) return;
  switch (*top) {
    case Screen::kTitle:
      show_title(state, facts, wishes);
      break;
    case Screen::kWorlds:
      show_worlds(state, facts, wishes);
      break;
    case Screen::kNewWorld:
      show_new_world(state, facts, wishes);
      break;
    case Screen::kSettings:
      show_settings(state, facts, wishes);
      break;
    case Screen::kControls:
      show_controls(state, facts, wishes);
      break;
    case Screen::kPause:
      show_pause(state, facts, wishes);
      break;
    case Screen::kPalette:
      show_palette(state, facts, wishes);
      break;
    case Screen::kPhoto:
      show_photo(state, facts, wishes);
      break;
    case Screen::kMap:
      show_map(state, facts, wishes);
      break;
    case Screen::kGallery:
      show_gallery(state, facts, wishes);
      break;
  }
  state.fresh = state.stack.top() != top;
  if (state.fresh) release_enter();
}

bool goes_back(const ScreenState& state, const platform::InputFrame& input) {
  const bool takes_pad = state.listening && state.listening->pad;
  return input.pressed(platform::Key::kEscape) ||
         (input.pressed(platform::Key::kPadB) && !takes_pad);
}

void take_keys(const ScreenState& state, const platform::InputFrame& input, ScreenFacts& facts) {
  using platform::Key;
  const bool takes_pad = state.listening && state.listening->pad;
  const Key control = control_of(takes_pad ? Key::kPadA : Key::kA);
  facts.pad = input.pad;
  facts.pressed = Key::kNone;
  facts.control_up = false;
  facts.control = input.was_down(control);
  for (const platform::InputEvent& event : input.events) {
    if (event.key == control) facts.control = event.down;
    if (event.key == control || event.key == Key::kNone || !event.down) continue;
    facts.pressed = event.key;
    return;
  }
  facts.control = input.down(control);
  facts.control_up = input.released(control);
}

void go_back(ScreenState& state) {
  if (state.listening) {
    state.listening.reset();
    return;
  }
  const bool popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId);
  if (popup) return;
  state.stack.back();
  state.fresh = true;
}

std::string seed_from(std::uint64_t entropy) {
  constexpr std::uint64_t kSeeds = 1'000'000'000;
  return fmt::format("{}", entropy % kSeeds);
}

std::string ago(std::int64_t seconds) {
  constexpr std::int64_t kMinute = 60, kHour = 60 * kMinute, kDay = 24 * kHour, kMonth = 30 * kDay;
  const auto some = [](std::int64_t count, const char* one, const char* many) {
    return count == 1 ? std::string(tr(one)) : tr_format(many, count);
  };
  if (seconds < kMinute) return tr("just now");
  if (seconds < kHour) return some(seconds / kMinute, word("1 minute ago"), word("{} minutes ago"));
  if (seconds < kDay) return some(seconds / kHour, word("1 hour ago"), word("{} hours ago"));
  if (seconds < 2 * kMonth) return some(seconds / kDay, word("1 day ago"), word("{} days ago"));
  return some(seconds / kMonth, word("1 month ago"), word("{} months ago"));
}

}  // namespace skerry::game::ui
