// Before a world is played: title, world list, new world.
#include <fmt/format.h>

#include <algorithm>

#include "game/ui/look.h"
#include "game/ui/screens.h"
#include "game/words/words.h"

namespace skerry::game::ui {
namespace {

constexpr float kRowHeight = 84.0f;  // units

std::string megabytes(std::uint64_t bytes) {
  return bytes < 100'000 ? fmt::format("{:.0f} kB", static_cast<double>(bytes) * 1e-3)
                         : fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

void draw_thumbnail(const ScreenFacts& facts, const WorldCard& world, ImVec2 at, ImVec2 size) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(at.x + size.x, at.y + size.y);
  if (world.thumbnail < 0) {
    list.AddRectFilled(at, end, IM_COL32(255, 255, 255, 16), 4 * unit());
    return;
  }
  const PicturePart part = facts.pictures->thumbnail(world.thumbnail);
  list.AddImageRounded(pictures_id(), at, end, part.low, part.high, IM_COL32_WHITE, 4 * unit());
}

/// @return whether it was opened (pressed twice, or Enter on the chosen one).
bool world_row(ScreenState& state, const ScreenFacts& facts, const WorldCard& world) {
  const float height = kRowHeight * unit(), inset = 6 * unit();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const bool chosen = state.chosen_world == world.path;
  ImGui::PushID(world.path.c_str());
  const bool pressed = ImGui::Selectable("##row", chosen, ImGuiSelectableFlags_AllowDoubleClick,
                                         ImVec2(width, height));
  ImGui::PopID();
  if (chosen && state.fresh) ImGui::SetItemDefaultFocus();
  // Whoever goes through the list by keys chooses on the way.
  const bool gone_to = ImGui::GetIO().NavVisible && ImGui::IsItemFocused() && !pressed;
  if (gone_to) state.chosen_world = world.path;
  const ImVec2 picture((height - 2 * inset) * 16 / 9, height - 2 * inset);
  draw_thumbnail(facts, world, ImVec2(at.x + inset, at.y + inset), picture);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float x = at.x + picture.x + 4 * inset, line = ImGui::GetTextLineHeight();
  const float room = at.x + width - x - inset;
  list.AddText(ImVec2(x, at.y + 0.5f * height - 1.25f * line), colour::kText,
               shortened(world.name, room).c_str());
  const std::string below =
      world.problem.empty() ? fmt::format("{}  ·  {}  ·  {}", tr_format("seed {}", world.seed_text),
                                          ago(facts.now_s - world.played_s), megabytes(world.bytes))
                            : world.problem;
  list.AddText(ImVec2(x, at.y + 0.5f * height + 0.25f * line),
               world.problem.empty() ? colour::kFaint : colour::kWarning,
               shortened(below, room).c_str());
  if (!pressed) return false;
  const bool again =
      state.chosen_world == world.path && !ImGui::IsMouseReleased(0) && !ImGui::IsMouseClicked(0);
  state.chosen_world = world.path;
  return again || ImGui::IsMouseDoubleClicked(0);
}

/// Why the world that is chosen cannot be played, in whole: its row shows the beginning.
std::string problem_of_chosen(const ScreenState& state, const ScreenFacts& facts) {
  for (const WorldCard& world : facts.worlds)
    if (state.chosen_world == world.path) return world.problem;
  return {};
}

void ask_to_delete(ScreenState& state, const WorldCard& world, bool back, Wishes& wishes) {
  if (state.asks_to_delete) ImGui::OpenPopup("delete");
  state.asks_to_delete = false;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(0.5f * window.x, 0.5f * window.y), ImGuiCond_Always,
                          ImVec2(0.5f, 0.5f));
  const float width = std::min(460 * unit(), window.x - 16 * unit());
  ImGui::SetNextWindowSize(ImVec2(width, 0.0f));
  if (!ImGui::BeginPopupModal("delete", nullptr,
                              ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                  ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings))
    return;
  text_wrapped(colour::kText, tr_format("Delete \"{}\" for good?", world.name));
  text_wrapped(colour::kFaint, tr("What was built in it cannot be brought back."));
  gap(8);
  if (first_button(tr("Keep it"), 190) || back) ImGui::CloseCurrentPopup();
  ImGui::SameLine();
  if (danger_button(tr("Delete"), 190)) {
    wishes.remove = world.path;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

}  // namespace

void show_title(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  // Darker to the left, where the words are.
  ImGui::GetBackgroundDrawList()->AddRectFilledMultiColor(
      ImVec2(0, 0), ImVec2(0.62f * window.x, window.y), IM_COL32(6, 12, 16, 205),
      IM_COL32(6, 12, 16, 0), IM_COL32(6, 12, 16, 0), IM_COL32(6, 12, 16, 205));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, 0u);
  ImGui::PushStyleColor(ImGuiCol_Border, 0u);
  begin_panel("title", Place::kLeft, 420, 600);
  push_size(TextSize::kTitle);
  text("Skerry");
  pop_size();
  text_in(colour::kAccent, tr("Islands in the air"));
  gap(26);
  if (facts.worlds.empty()) {
    if (first_button(tr("New world"), 300)) state.stack.open(Screen::kNewWorld);
  } else {
    if (first_button(tr("Worlds"), 300)) state.stack.open(Screen::kWorlds);
    if (button(tr("New world"), 300)) state.stack.open(Screen::kNewWorld);
  }
  if (button(tr("Settings"), 300)) state.stack.open(Screen::kSettings);
  if (button(tr("Controls"), 300)) state.stack.open(Screen::kControls);
  if (button(tr("Gallery"), 300)) state.stack.open(Screen::kGallery);
  if (button(tr("Quit"), 300)) wishes.quit = true;
  end_panel();
  ImGui::PopStyleColor(2);
  push_size(TextSize::kSmall);
  const std::string version(facts.version);
  const ImVec2 size = ImGui::CalcTextSize(version.c_str());
  ImGui::GetForegroundDrawList()->AddText(
      ImGui::GetFont(), ImGui::GetFontSize(),
      ImVec2(window.x - size.x - 14 * unit(), window.y - size.y - 10 * unit()), colour::kFaint,
      version.c_str());
  pop_size();
}

void show_worlds(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  shade();
  begin_panel("worlds", Place::kMiddle, 900, 620);
  heading(tr("Worlds"));
  const std::string problem = problem_of_chosen(state, facts);
  float foot = 40 * unit() + 2 * ImGui::GetStyle().ItemSpacing.y;
  if (!problem.empty())
    foot +=
        ImGui::GetStyle().ItemSpacing.y +
        ImGui::CalcTextSize(problem.c_str(), nullptr, false, ImGui::GetContentRegionAvail().x).y;
  begin_scroll("list", -foot);
  if (facts.worlds.empty()) text_in(colour::kFaint, tr("None yet. Make one."));
  const WorldCard* chosen = nullptr;
  if (!state.chosen_world && !facts.worlds.empty()) {
    const auto sound = std::find_if(facts.worlds.begin(), facts.worlds.end(),
                                    [](const WorldCard& world) { return world.problem.empty(); });
    state.chosen_world = (sound != facts.worlds.end() ? *sound : facts.worlds.front()).path;
  }
  for (const WorldCard& world : facts.worlds) {
    if (world_row(state, facts, world) && world.problem.empty()) wishes.play = world.path;
    if (state.chosen_world == world.path) chosen = &world;
  }
  end_scroll();
  if (!problem.empty()) text_wrapped(colour::kWarning, problem);
  gap(0);
  ImGui::BeginDisabled(!chosen || !chosen->problem.empty());
  if (first_button(tr("Play"), 190) && chosen) wishes.play = chosen->path;
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (button(tr("New world"), 190)) state.stack.open(Screen::kNewWorld);
  ImGui::SameLine();
  ImGui::BeginDisabled(!chosen);
  if (button(tr("Delete"), 150)) state.asks_to_delete = true;
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (button(tr("Back"), 150)) state.stack.back();
  if (chosen) ask_to_delete(state, *chosen, facts.back, wishes);
  end_panel();
}

void show_new_world(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  begin_panel("new_world", Place::kLeft, 440, facts.pad ? 650 : 464);
  heading(tr("New world"));
  text_in(colour::kFaint, tr("Name"));
  ImGui::SetNextItemWidth(-1.0f);
  if (state.fresh) ImGui::SetKeyboardFocusHere();
  const bool entered = text_field("##name", state.new_name);
  if (ImGui::IsItemFocused()) state.types_seed = false;
  if (button(tr("Another name"), 184)) wishes.draw_name = true;
  gap(4);
  text_in(colour::kFaint, tr("Seed"));
  ImGui::SetNextItemWidth(-1.0f);
  const std::string before = state.new_seed.data();
  const bool seed_entered = text_field("##seed", state.new_seed);
  if (ImGui::IsItemFocused()) state.types_seed = true;
  if (button(tr("Another seed"), 184)) wishes.draw_lots = true;
  text_wrapped(colour::kFaint,
               tr("Any text or number. The same seed makes the same islands; to the right is what "
                  "you will see first."));
  gap(12);
  if (first_button(tr("Create"), 184) || entered || seed_entered)
    wishes.create = Wishes::NewWorld{state.new_name.data(), state.new_seed.data()};
  ImGui::SameLine();
  if (button(tr("Back"), 184)) state.stack.back();
  if (facts.pad) {
    gap(4);
    state.types_seed ? letter_buttons(state.new_seed, state.capitals)
                     : letter_buttons(state.new_name, state.capitals);
  }
  wishes.preview |= before != state.new_seed.data();
  end_panel();
}

}  // namespace skerry::game::ui
