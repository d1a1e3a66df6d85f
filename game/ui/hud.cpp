#include "game/ui/hud.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/scene_file/parse.h"
#include "game/ui/look.h"
#include "game/ui/screens.h"
#include "game/words/words.h"

namespace skerry::game::ui {
namespace {

constexpr ImU32 kGlass = IM_COL32(8, 14, 18, 120);
constexpr float kMostOfScreens = 0.3f;  // of the window, that messages take from screens
constexpr ImU32 kShadow = IM_COL32(0, 0, 0, 150);

ImU32 faded(ImU32 colour, double strength) {
  ImVec4 value = ImGui::ColorConvertU32ToFloat4(colour);
  value.w *= static_cast<float>(std::clamp(strength, 0.0, 1.0));
  return ImGui::ColorConvertFloat4ToU32(value);
}

/// Text that reads on any ground; `across` 0 is left of `at`, 0.5 about it, 1 right of it.
void write(ImDrawList& list, ImVec2 at, float across, ImU32 colour, const std::string& line,
           double strength = 1.0) {
  const ImVec2 size = ImGui::CalcTextSize(line.c_str());
  const ImVec2 low(std::floor(at.x - (1.0f - across) * size.x), std::floor(at.y));
  const float offset = std::max(1.0f, unit());
  list.AddText(ImVec2(low.x + offset, low.y + offset), faded(kShadow, strength), line.c_str());
  list.AddText(low, faded(colour, strength), line.c_str());
}

/// About a place, on glass of its own.
void write_on_glass(ImDrawList& list, ImVec2 top_middle, ImU32 colour, const std::string& line) {
  const ImVec2 size = ImGui::CalcTextSize(line.c_str());
  const float side = 10 * unit(), above = 3 * unit();
  list.AddRectFilled(ImVec2(top_middle.x - 0.5f * size.x - side, top_middle.y - above),
                     ImVec2(top_middle.x + 0.5f * size.x + side, top_middle.y + size.y + above),
                     IM_COL32(8, 14, 18, 190), 5 * unit());
  write(list, top_middle, 0.5f, colour, line);
}

ImU32 shaded(ImU32 colour, float light) {
  ImVec4 value = ImGui::ColorConvertU32ToFloat4(colour);
  value.x *= light;
  value.y *= light;
  value.z *= light;
  return ImGui::ColorConvertFloat4ToU32(value);
}

/// A torch in the right hand: its texture's texels, thick, leaning inwards.
void draw_torch(ImDrawList& list, std::span<const HeldTexel> texels, ImVec2 window) {
  if (texels.empty()) return;
  const float texel = 0.40f * window.y / static_cast<float>(texels.back().y + 1);
  const ImVec2 right(0.985f * texel, 0.17f * texel), up(-0.17f * texel, -0.985f * texel);
  const ImVec2 into(1.1f * texel, -0.5f * texel);
  const ImVec2 foot(0.86f * window.x, 1.01f * window.y);
  const auto at = [&](float x, float y, float deep) {
    return ImVec2(foot.x + x * right.x + y * up.x + deep * into.x,
                  foot.y + x * right.y + y * up.y + deep * into.y);
  };
  for (const HeldTexel& t : texels) {
    const auto x = static_cast<float>(t.x), y = static_cast<float>(t.y);
    if (t.open_right)
      list.AddQuadFilled(at(x + 1, y, 0), at(x + 1, y, 1), at(x + 1, y + 1, 1), at(x + 1, y + 1, 0),
                         shaded(t.colour, 0.6f));
    if (t.open_top)
      list.AddQuadFilled(at(x, y + 1, 0), at(x + 1, y + 1, 0), at(x + 1, y + 1, 1), at(x, y + 1, 1),
                         shaded(t.colour, 0.85f));
    list.AddQuadFilled(at(x, y, 0), at(x + 1, y, 0), at(x + 1, y + 1, 0), at(x, y + 1, 0),
                       t.colour);
  }
}

void draw_crosshair(ImDrawList& list, ImVec2 middle) {
  const float arm = std::round(9 * unit()), half = std::max(0.5f, std::round(unit()) * 0.5f);
  const ImVec2 m(std::floor(middle.x), std::floor(middle.y));
  for (const float grow : {1.0f, 0.0f}) {
    const ImU32 colour = grow > 0.0f ? kShadow : colour::kText;
    list.AddRectFilled(ImVec2(m.x - arm - grow, m.y - half - grow),
                       ImVec2(m.x + arm + grow, m.y + half + grow), colour);
    list.AddRectFilled(ImVec2(m.x - half - grow, m.y - arm - grow),
                       ImVec2(m.x + half + grow, m.y + arm + grow), colour);
  }
}

void draw_hotbar(ImDrawList& list, const HudFacts& facts, const Pictures& pictures, ImVec2 window) {
  if (facts.hotbar.empty()) return;
  const float edge = std::round(52 * unit()), between = std::round(4 * unit());
  const auto count = static_cast<float>(facts.hotbar.size());
  const float left = std::floor(0.5f * (window.x - count * edge - (count - 1) * between));
  const float top = std::floor(window.y - edge - 14 * unit());
  for (std::size_t i = 0; i < facts.hotbar.size(); ++i) {
    const float x = left + static_cast<float>(i) * (edge + between);
    const ImVec2 low(x, top), high(x + edge, top + edge);
    const bool selected = static_cast<int>(i) == facts.selected;
    list.AddRectFilled(low, high, kGlass, 6 * unit());
    if (selected)
      list.AddRect(low, high, colour::kAccent, 6 * unit(), 0, std::max(1.5f, 2.5f * unit()));
    if (facts.hotbar[i] == world::kAir) continue;
    const PicturePart part = pictures.block(facts.hotbar[i]);
    const float inset = 6 * unit();
    list.AddImage(pictures_id(), ImVec2(low.x + inset, low.y + inset),
                  ImVec2(high.x - inset, high.y - inset), part.low, part.high);
  }
  const world::BlockId held = facts.hotbar[static_cast<std::size_t>(facts.selected)];
  if (held != world::kAir && !facts.choosing)
    write(list, ImVec2(0.5f * window.x, top - 22 * unit()), 0.5f, colour::kText, block_label(held));
}

constexpr double kCompassSpan = 60.0;  // degrees to either side

/// Places within the compass' span, the one most ahead with its name below. Nearer ones over
/// farther ones.
void draw_marks(ImDrawList& list, const HudFacts& facts, float middle_x, float half, float top) {
  constexpr double kNamed = 6.0;  // degrees
  const double ahead = bearing_deg(facts.yaw_deg);
  std::vector<const HudFacts::Mark*> marks;
  for (const HudFacts::Mark& mark : facts.marks) marks.push_back(&mark);
  std::sort(marks.begin(), marks.end(),
            [](const auto* a, const auto* b) { return a->blocks > b->blocks; });
  const HudFacts::Mark* named = nullptr;
  const auto off = [&](const HudFacts::Mark& mark) {
    return std::remainder(mark.bearing_deg - ahead, 360.0);
  };
  for (const HudFacts::Mark* mark : marks) {
    const double degrees = off(*mark);
    if (std::abs(degrees) >= kCompassSpan) continue;
    const float x = middle_x + static_cast<float>(degrees / kCompassSpan) * half * 0.94f;
    draw_place_mark(list, mark->kind, {x, top}, 6 * unit(),
                    1.0 - std::pow(std::abs(degrees) / kCompassSpan, 3.0));
    if (std::abs(degrees) < kNamed && (!named || std::abs(degrees) < std::abs(off(*named))))
      named = mark;
  }
  if (!named || facts.choosing) return;
  write(list, ImVec2(middle_x, top + 9 * unit()), 0.5f, colour::kText,
        fmt::format("{}  {:.0f}", named->name, named->blocks));
}

void draw_compass(ImDrawList& list, double yaw_deg, float middle_x) {
  constexpr double kSpan = kCompassSpan;
  constexpr const char* kNames[] = {word("N"), word("NE"), word("E"), word("SE"),
                                    word("S"), word("SW"), word("W"), word("NW")};
  const float half = 190 * unit(), top = 10 * unit(), height = 30 * unit();
  list.AddRectFilled(ImVec2(middle_x - half, top), ImVec2(middle_x + half, top + height), kGlass,
                     6 * unit());
  const double ahead = bearing_deg(yaw_deg);
  for (int step = 0; step < 24; ++step) {
    const double off = std::remainder(step * 15.0 - ahead, 360.0);
    if (std::abs(off) >= kSpan) continue;
    const float x = middle_x + static_cast<float>(off / kSpan) * half * 0.94f;
    const double strength = 1.0 - std::pow(std::abs(off) / kSpan, 3.0);
    if (step % 3 == 0) {
      write(list, ImVec2(x, top + 0.5f * (height - ImGui::GetTextLineHeight())), 0.5f,
            step == 0 ? colour::kAccent : colour::kText, tr(kNames[step / 3]), strength);
    } else {
      list.AddLine(ImVec2(x, top + 0.38f * height), ImVec2(x, top + 0.62f * height),
                   faded(colour::kFaint, strength), std::max(1.0f, unit()));
    }
  }
  list.AddTriangleFilled(ImVec2(middle_x - 5 * unit(), top + height),
                         ImVec2(middle_x + 5 * unit(), top + height),
                         ImVec2(middle_x, top + height - 6 * unit()), colour::kAccent);
}

}  // namespace

void Messages::say(std::string line) {
  if (!lines_.empty() && lines_.back().text == line) {
    lines_.back().age_s = 0.0;
    return;
  }
  if (lines_.size() == kMost) lines_.erase(lines_.begin());
  lines_.push_back({std::move(line), 0.0});
}

void Messages::pass(double seconds) {
  for (Line& line : lines_) line.age_s += seconds;
  std::erase_if(lines_, [](const Line& line) { return line.age_s >= kShown + kFading; });
}

double Messages::Line::strength() const {
  return std::clamp((kShown + kFading - age_s) / kFading, 0.0, 1.0);
}

double bearing_deg(double yaw_deg) {
  // Yaw 0 looks along +z, which is south, and grows to the left, towards the east.
  const double bearing = std::fmod(180.0 - yaw_deg, 360.0);
  return bearing < 0.0 ? bearing + 360.0 : bearing;
}

void show_hud(const HudFacts& facts, const Pictures& pictures) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  if (facts.hidden > 0.0)
    list.AddRectFilled(ImVec2(0, 0), window,
                       ImColor(0.0f, 0.0f, 0.0f, static_cast<float>(facts.hidden)));
  push_size(TextSize::kSmall);
  if (facts.torch) draw_torch(list, pictures.torch(), window);
  draw_crosshair(list, ImVec2(0.5f * window.x, 0.5f * window.y));
  draw_hotbar(list, facts, pictures, window);
  draw_compass(list, facts.yaw_deg, 0.5f * window.x);
  draw_marks(list, facts, 0.5f * window.x, 190 * unit(), 40 * unit());
  const float line = ImGui::GetTextLineHeight() + 3 * unit(), edge = 14 * unit();
  if (!facts.numbers) {
    write(list, ImVec2(window.x - edge, edge), 0.0f, colour::kText,
          format_time_of_day(facts.time_of_day_s).substr(0, 5));
    write(list, ImVec2(window.x - edge, edge + line), 0.0f, colour::kText, facts.place);
  }
  const ImVec2 news(0.5f * window.x, (facts.marks.empty() ? 50 : 70) * unit());
  if (facts.steering && facts.steering->held)
    write_on_glass(list, news, colour::kWarning,
                   tr_format("At the helm of {}   held fast", facts.steering->island));
  else if (facts.steering)
    write_on_glass(list, news, colour::kAccent,
                   tr_format("At the helm of {}   {:.1f} blocks/s", facts.steering->island,
                             facts.steering->speed));
  else if (facts.islands_to_come != 0)
    write_on_glass(list, news, colour::kFaint,
                   tr_format("Islands come into view: {} parts left", facts.islands_to_come));
  else if (facts.shaders_to_come != 0)
    write_on_glass(list, news, colour::kFaint,
                   tr_format("Shaders are compiled: {} left", facts.shaders_to_come));
  if (facts.hint && !facts.choosing)
    write_on_glass(list, ImVec2(news.x, news.y + 34 * unit()), colour::kText, *facts.hint);
  pop_size();
}

float show_messages(const Messages& messages, bool over_screens) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  push_size(TextSize::kSmall);
  const float inset = 10 * unit(), room = std::max(1.0f, window.x - 6 * inset);
  float bottom = window.y - (over_screens ? 12 : 94) * unit();
  const float highest = window.y * (over_screens ? 1.0f - kMostOfScreens : 0.0f);
  for (std::size_t i = messages.lines().size(); i-- > 0;) {
    const Messages::Line& message = messages.lines()[i];
    const ImVec2 size = ImGui::CalcTextSize(message.text.c_str(), nullptr, false, room);
    if (bottom - size.y < highest && i + 1 < messages.lines().size()) break;  // the newest is shown
    const ImVec2 at(0.5f * (window.x - size.x), bottom - size.y);
    list.AddRectFilled(ImVec2(at.x - inset, at.y - 4 * unit()),
                       ImVec2(at.x + size.x + inset, bottom + 4 * unit()),
                       faded(IM_COL32(8, 14, 18, 190), message.strength()), 5 * unit());
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at,
                 faded(colour::kText, message.strength()), message.text.c_str(), nullptr, room);
    bottom = at.y - 10 * unit();
  }
  pop_size();
  return over_screens && !messages.lines().empty() ? window.y - bottom : 0.0f;
}

}  // namespace skerry::game::ui
