// Over a world: pause, all blocks, photo mode.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/scene_file/parse.h"
#include "game/ui/look.h"
#include "game/ui/screens.h"
#include "game/words/words.h"

namespace skerry::game::ui {

void show_pause(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  shade();
  begin_panel("pause", Place::kMiddle, 380, state.unsaved ? 690 : 522);
  heading(tr("Paused"));
  if (facts.world)
    text_in(colour::kFaint, shortened(*facts.world, ImGui::GetContentRegionAvail().x));
  gap(8);
  if (first_button(tr("Go on"))) state.stack.clear();
  if (button(tr("Map"))) state.stack.open(Screen::kMap);
  if (button(tr("Settings"))) state.stack.open(Screen::kSettings);
  if (button(tr("Controls"))) state.stack.open(Screen::kControls);
  if (button(tr("Photo mode"))) state.stack.open(Screen::kPhoto);
  if (button(tr("Gallery"))) state.stack.open(Screen::kGallery);
  if (button(tr("Save and leave"))) wishes.leave_world = true;
  if (button(tr("Save and quit Skerry"))) wishes.quit = true;
  if (state.unsaved) {
    gap(4);
    text_wrapped(colour::kWarning, *state.unsaved);
    if (danger_button(tr("Leave without saving"))) wishes.leave_unsaved = true;
  }
  end_panel();
}

void show_palette(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  begin_panel("palette", Place::kMiddle, 840, facts.pad ? 688 : 560);
  heading(tr("Blocks"));
  ImGui::SetNextItemWidth(-1.0f);
  if (state.fresh) ImGui::SetKeyboardFocusHere();
  const bool entered = text_field("##search", state.palette_search, tr("Search"));
  if (facts.pad) letter_buttons(state.palette_search, state.capitals);
  const std::vector<world::BlockId> found = find_blocks(state.palette_search.data());
  if (entered && !found.empty()) wishes.take = found.front();
  gap(2);
  std::string named = found.empty() ? tr("No block of that name") : "";
  const float foot = ImGui::GetTextLineHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
  begin_scroll("blocks", -foot);
  const float edge = 56 * unit(), spacing = 6 * unit();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(spacing, spacing));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(6 * unit(), 6 * unit()));
  const int across = std::max(
      1, static_cast<int>((ImGui::GetContentRegionAvail().x + spacing) / (edge + spacing)));
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i % static_cast<std::size_t>(across) != 0) ImGui::SameLine();
    ImGui::PushID(static_cast<int>(found[i]));
    if (ImGui::Button("##block", ImVec2(edge, edge))) wishes.take = found[i];
    if (ImGui::IsItemHovered() || ImGui::IsItemFocused()) named = block_label(found[i]);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const PicturePart part = facts.pictures->block(found[i]);
    const float inset = 6 * unit();
    ImGui::GetWindowDrawList()->AddImage(pictures_id(), ImVec2(low.x + inset, low.y + inset),
                                         ImVec2(high.x - inset, high.y - inset), part.low,
                                         part.high);
    ImGui::PopID();
  }
  ImGui::PopStyleVar(2);
  end_scroll();
  text_in(colour::kFaint, named.empty() ? tr("Choose one for the hand") : named);
  end_panel();
  if (wishes.take) state.stack.back();
}

void show_photo(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  PhotoSettings& photo = *facts.photo;
  if (photo.bare) return;
  begin_panel("photo", Place::kLeft, 360, 496);
  heading(tr("Photo mode"));
  text_in(colour::kFaint, tr("Time of day"));
  int ten_minutes = photo.time_of_day_s / 600;
  const std::string time = format_time_of_day(photo.time_of_day_s);
  if (slide("##time", ten_minutes, 0, 143, time.c_str())) photo.time_of_day_s = ten_minutes * 600;
  text_in(colour::kFaint, tr("Exposure"));
  bool adapts = !photo.exposure_ev;
  if (ImGui::Checkbox(tr("as the eye adapts"), &adapts)) {
    photo.exposure_ev.reset();
    if (!adapts) photo.exposure_ev = facts.adapted_ev;
  }
  ImGui::BeginDisabled(adapts);
  auto stops = static_cast<float>(photo.exposure_ev.value_or(facts.adapted_ev));
  if (slide("##exposure", stops, -12.0f, 18.0f, 0.5f, tr("%.1f stops")))
    photo.exposure_ev = std::round(double{stops} * 10.0) / 10.0;
  ImGui::EndDisabled();
  text_in(colour::kFaint, tr("Field of view"));
  auto fov = static_cast<float>(photo.fov_deg);
  if (slide("##fov", fov, 5.0f, 120.0f, 5.0f, tr("%.0f degrees")))
    photo.fov_deg = std::round(double{fov});
  gap(8);
  if (first_button(tr("Take the picture"))) wishes.photograph = true;
  if (button(tr("Fly the camera"))) photo.bare = true;
  if (button(tr("Back"))) state.stack.back();
  end_panel();
}

}  // namespace skerry::game::ui
