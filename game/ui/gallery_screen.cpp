// Pictures that the player took.
#include <algorithm>

#include "game/ui/look.h"
#include "game/ui/screens.h"
#include "game/words/words.h"

namespace skerry::game::ui {
namespace {

constexpr float kCardWidth = 230.0f;  // units

/// @return whether it was pressed.
bool picture_card(const ScreenFacts& facts, const PictureCard& card, bool chosen) {
  const ImVec2 size(kCardWidth * unit(), kCardWidth * unit() * 9 / 16);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight(), inset = 5 * unit();
  const bool pressed = ImGui::Selectable("##picture", chosen, 0, ImVec2(size.x, size.y + line));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low(at.x + inset, at.y + inset), high(at.x + size.x - inset, at.y + size.y - inset);
  if (card.thumbnail >= 0) {
    const PicturePart part = facts.pictures->thumbnail(card.thumbnail);
    list.AddImageRounded(pictures_id(), low, high, part.low, part.high, IM_COL32_WHITE, 4 * unit());
  } else {
    list.AddRectFilled(low, high, IM_COL32(255, 255, 255, 16), 4 * unit());
  }
  if (chosen)
    list.AddRect(low, high, colour::kAccent, 4 * unit(), 0, std::max(1.5f, 2.5f * unit()));
  list.AddText(ImVec2(low.x, at.y + size.y - 2 * unit()),
               card.problem.empty() ? colour::kFaint : colour::kWarning, card.name.c_str());
  return pressed;
}

}  // namespace

void show_gallery(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  shade();
  begin_panel("gallery", Place::kMiddle, 1040, 660);
  heading(tr("Gallery"));
  const PictureCard* chosen =
      state.chosen_picture < facts.gallery.size() ? &facts.gallery[state.chosen_picture] : nullptr;
  const bool enterable = chosen && chosen->thumbnail >= 0 && chosen->problem.empty();
  push_size(TextSize::kSmall);
  const float foot = 40 * unit() + 2 * ImGui::GetStyle().ItemSpacing.y +
                     (chosen && !chosen->problem.empty() ? 3 * ImGui::GetTextLineHeight() : 0.0f);
  begin_scroll("pictures", -foot);
  if (facts.gallery.empty()) text_in(colour::kFaint, tr("No pictures yet: F2 takes one"));
  const float room = ImGui::GetContentRegionAvail().x + ImGui::GetStyle().ItemSpacing.x;
  const auto across = static_cast<std::size_t>(
      std::max(1.0f, room / (kCardWidth * unit() + ImGui::GetStyle().ItemSpacing.x)));
  for (std::size_t i = 0; i < facts.gallery.size(); ++i) {
    if (i % across != 0) ImGui::SameLine();
    ImGui::PushID(static_cast<int>(i));
    if (picture_card(facts, facts.gallery[i], state.chosen_picture == i)) state.chosen_picture = i;
    if (by_keys() && ImGui::IsItemFocused()) state.chosen_picture = i;
    ImGui::PopID();
  }
  end_scroll();
  if (chosen && !chosen->problem.empty()) text_wrapped(colour::kWarning, chosen->problem);
  pop_size();
  gap(0);
  ImGui::BeginDisabled(!enterable);
  if (first_button(tr("Enter the picture"), 260) && enterable) wishes.enter = chosen->path;
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (button(tr("Back"), 150)) state.stack.back();
  end_panel();
}

}  // namespace skerry::game::ui
