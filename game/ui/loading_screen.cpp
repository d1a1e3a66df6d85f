#include "game/ui/loading_screen.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "game/ui/look.h"
#include "game/words/words.h"

namespace skerry::game::ui {
namespace {

constexpr double kRound = 1.6;  // seconds of a dot's round

void write_in_middle(ImDrawList& list, float y, ImU32 colour, const std::string& text) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float room = window.x - 32 * unit();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, room);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), ImVec2(0.5f * (window.x - size.x), y),
               colour, text.c_str(), nullptr, room);
}

/// Dots that go round: whoever waits sees that it goes on.
void draw_wheel(ImDrawList& list, ImVec2 middle, double seconds) {
  constexpr int kDots = 8;
  for (int i = 0; i < kDots; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / kDots;
    const double behind = std::fmod(seconds / kRound - double(i) / kDots + kDots, 1.0);
    const ImVec2 at(middle.x + 18 * unit() * static_cast<float>(std::sin(turn)),
                    middle.y - 18 * unit() * static_cast<float>(std::cos(turn)));
    const auto strength = static_cast<float>(1.0 - 0.85 * behind);
    list.AddCircleFilled(at, 3.5f * unit(), ImColor(0.48f, 0.8f, 0.75f, strength));
  }
}

}  // namespace

void show_loading(const LoadingFacts& facts) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  cover();
  draw_wheel(list, ImVec2(0.5f * window.x, 0.36f * window.y), facts.seconds);
  const bool islands = facts.islands_to_come != 0;
  const float share = islands || facts.passes == 0 ? 1.0f
                                                   : static_cast<float>(facts.passes_done) /
                                                         static_cast<float>(facts.passes);
  const float width = std::min(420 * unit(), 0.8f * window.x), height = 8 * unit();
  const ImVec2 corner(0.5f * (window.x - width), 0.5f * window.y);
  list.AddRectFilled(corner, ImVec2(corner.x + width, corner.y + height),
                     IM_COL32(255, 255, 255, 28), 4 * unit());
  list.AddRectFilled(corner, ImVec2(corner.x + width * share, corner.y + height), colour::kAccent,
                     4 * unit());
  push_size(TextSize::kBody);
  const float line = ImGui::GetTextLineHeight();
  write_in_middle(list, corner.y + height + line, colour::kText,
                  islands
                      ? tr_format("Islands come into view: {} parts left", facts.islands_to_come)
                      : tr_format("Shaders are prepared for this device: {} of {}",
                                  facts.passes_done, facts.passes));
  write_in_middle(list, corner.y + height + 3 * line, colour::kFaint,
                  tr("Later starts take less time."));
  pop_size();
}

}  // namespace skerry::game::ui
