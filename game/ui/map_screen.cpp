// The map: islands from above, and the places to find again.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>

#include "game/ui/look.h"
#include "game/ui/screens.h"
#include "game/words/words.h"

namespace skerry::game::ui {
namespace {

constexpr ImU32 kVoid = IM_COL32(20, 34, 44, 255), kGrid = IM_COL32(255, 255, 255, 18);
constexpr double kDriftShown = 60.0;  // seconds of drift that an arrow shows
constexpr float kSideWidth = 320.0f;  // units

/// Where the map lies in the window.
struct Sheet {
  ImVec2 low;
  float edge = 0.0f;    // pixels
  double radius = 1.0;  // blocks
  glm::dvec2 view{};    // blocks: what lies in its middle
  ImVec2 at(glm::dvec2 blocks) const {
    const auto axis = [&](float from, double b) {
      return from + static_cast<float>((b / radius + 1.0) * 0.5) * edge;
    };
    return {axis(low.x, blocks.x - view.x), axis(low.y, blocks.y - view.y)};
  }
  float pixels(double blocks) const { return static_cast<float>(blocks / radius * 0.5) * edge; }
  /// A place beyond the edge is shown at the edge.
  ImVec2 clamped(glm::dvec2 blocks, float margin) const {
    const ImVec2 p = at(blocks);
    return {std::clamp(p.x, low.x + margin, low.x + edge - margin),
            std::clamp(p.y, low.y + margin, low.y + edge - margin)};
  }
};

void write(ImDrawList& list, ImVec2 top_middle, ImU32 colour, const std::string& line) {
  const ImVec2 size = ImGui::CalcTextSize(line.c_str());
  const ImVec2 at(std::floor(top_middle.x - 0.5f * size.x), std::floor(top_middle.y));
  for (const ImVec2 off : {ImVec2(1, 1), ImVec2(-1, 1), ImVec2(1, -1), ImVec2(-1, -1)})
    list.AddText(ImVec2(at.x + off.x, at.y + off.y), IM_COL32(8, 14, 18, 200), line.c_str());
  list.AddText(at, colour, line.c_str());
}

void draw_grid(ImDrawList& list, const Sheet& sheet) {
  const double step = sheet.radius / 3.0;
  for (int i = -2; i <= 2; ++i) {
    const ImVec2 at = sheet.at(sheet.view + glm::dvec2(i * step));
    list.AddLine({at.x, sheet.low.y}, {at.x, sheet.low.y + sheet.edge}, kGrid);
    list.AddLine({sheet.low.x, at.y}, {sheet.low.x + sheet.edge, at.y}, kGrid);
  }
  const ImVec2 foot(sheet.low.x + 12 * unit(), sheet.low.y + sheet.edge - 12 * unit());
  const float length = sheet.pixels(step);
  list.AddLine(foot, {foot.x + length, foot.y}, colour::kText, 2 * unit());
  for (const float x : {foot.x, foot.x + length})
    list.AddLine({x, foot.y - 5 * unit()}, {x, foot.y + 1}, colour::kText, 2 * unit());
  write(list, {foot.x + 0.5f * length, foot.y - 6 * unit() - ImGui::GetTextLineHeight()},
        colour::kText, tr_format("{:.0f} blocks", step));
  write(list, {sheet.low.x + 0.5f * sheet.edge, sheet.low.y + 4 * unit()}, colour::kText, tr("N"));
}

/// Which way an island drifts, as far as it goes in a minute.
void draw_drift(ImDrawList& list, const Sheet& sheet, const MapFacts::Island& island) {
  const double minute = glm::length(island.drift) * kDriftShown;
  const float length = sheet.pixels(minute), head = 4 * unit();
  if (length < 3 * head) return;
  const glm::dvec2 way = island.drift / glm::length(island.drift);
  const ImVec2 from = sheet.at(island.at), to = sheet.at(island.at + island.drift * kDriftShown);
  const ImVec2 along(static_cast<float>(way.x) * head, static_cast<float>(way.y) * head);
  list.AddLine(from, to, colour::kText, std::max(1.0f, 1.5f * unit()));
  list.AddTriangleFilled({to.x + along.x, to.y + along.y},
                         {to.x - along.x - along.y, to.y - along.y + along.x},
                         {to.x - along.x + along.y, to.y - along.y - along.x}, colour::kText);
}

void draw_islands(ImDrawList& list, const Sheet& sheet, const MapFacts& map) {
  for (const MapFacts::Island& island : map.islands) draw_drift(list, sheet, island);
  // The largest are named first; a name that would lie over another is left out.
  std::vector<const MapFacts::Island*> by_size;
  for (const MapFacts::Island& island : map.islands) by_size.push_back(&island);
  std::sort(by_size.begin(), by_size.end(),
            [](const auto* a, const auto* b) { return a->radius > b->radius; });
  std::vector<std::pair<ImVec2, ImVec2>> taken;
  for (const MapFacts::Island* island : by_size) {
    if (sheet.pixels(island->radius) < 12 * unit()) continue;
    const ImVec2 middle = sheet.at(island->at), size = ImGui::CalcTextSize(island->name.c_str());
    const ImVec2 low(middle.x - 0.5f * size.x, middle.y - 0.5f * size.y);
    const ImVec2 high(low.x + size.x, low.y + size.y);
    const bool inside = low.x > sheet.low.x && low.y > sheet.low.y + 18 * unit() &&
                        high.x < sheet.low.x + sheet.edge && high.y < sheet.low.y + sheet.edge;
    const bool clear = std::none_of(taken.begin(), taken.end(), [&](const auto& other) {
      return low.x < other.second.x && other.first.x < high.x && low.y < other.second.y &&
             other.first.y < high.y;
    });
    if (!inside || !clear) continue;
    taken.emplace_back(low, high);
    write(list, {middle.x, low.y}, colour::kText, island->name);
  }
}

void draw_player(ImDrawList& list, const Sheet& sheet, const MapFacts& map) {
  const double yaw = map.yaw_deg * std::numbers::pi / 180.0;
  const ImVec2 way(static_cast<float>(std::sin(yaw)), static_cast<float>(std::cos(yaw)));
  const ImVec2 m = sheet.clamped(map.player, 6 * unit());
  for (const float half : {10 * unit(), 7 * unit()}) {
    const ImU32 colour = half > 8 * unit() ? IM_COL32(8, 14, 18, 255) : colour::kAccent;
    // A slim arrow: its tip ahead, its corners behind to both sides.
    const auto corner = [&](float ahead, float aside) {
      return ImVec2(m.x + (way.x * ahead - way.y * aside) * half,
                    m.y + (way.y * ahead + way.x * aside) * half);
    };
    list.AddTriangleFilled(corner(1.3f, 0.0f), corner(-0.8f, 0.65f), corner(-0.8f, -0.65f), colour);
  }
}

std::string heights(double up) {
  if (up == 0.0) return tr("level");
  return up > 0.0 ? tr_format("{:.0f} up", up) : tr_format("{:.0f} down", -up);
}

std::string label_of(const MapFacts::Place& place) {
  switch (place.kind) {
    case PlaceKind::kHome:
      return tr("Home");
    case PlaceKind::kGround:
      return tr("Last safe ground");
    case PlaceKind::kWaypoint:
      return place.name.empty() ? tr("Waypoint") : place.name;
  }
  return {};
}

std::string distance_to(const MapFacts& map, glm::dvec2 at, double up) {
  const glm::dvec2 to = at - map.player;
  return fmt::format("{:.0f} {}  {}", glm::length(to), compass_point(to), heights(std::round(up)));
}

/// The island that the pointer is over: the smallest, if there are several.
const MapFacts::Island* pointed_at(const Sheet& sheet, const MapFacts& map) {
  const ImVec2 pointer = ImGui::GetIO().MousePos;
  const MapFacts::Island* found = nullptr;
  for (const MapFacts::Island& island : map.islands) {
    const ImVec2 at = sheet.at(island.at);
    const float away = std::hypot(pointer.x - at.x, pointer.y - at.y);
    if (away < sheet.pixels(island.radius) && (!found || island.radius < found->radius))
      found = &island;
  }
  return found;
}

/// The mouse takes the map along.
void drag_sheet(ScreenState& state, const Sheet& sheet) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 from = io.MouseClickedPos[0];
  const bool on_sheet = from.x >= sheet.low.x && from.x < sheet.low.x + sheet.edge &&
                        from.y >= sheet.low.y && from.y < sheet.low.y + sheet.edge;
  if (!ImGui::IsMouseDragging(0) || !on_sheet) return;
  const double blocks = 2.0 * sheet.radius / std::max(sheet.edge, 1.0f);
  shift_map(state, glm::dvec2(io.MouseDelta.x, io.MouseDelta.y) * -blocks);
}

void draw_sheet(const ScreenState& state, const ScreenFacts& facts, const Sheet& sheet) {
  const MapFacts& map = *facts.map;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 high(sheet.low.x + sheet.edge, sheet.low.y + sheet.edge);
  list.PushClipRect(sheet.low, high, true);
  list.AddRectFilled(sheet.low, high, kVoid);
  if (map.radius > 0.0) {
    const PicturePart part = facts.pictures->map();
    const glm::dvec2 corner(map.radius);
    list.AddImage(pictures_id(), sheet.at(-corner), sheet.at(corner), part.low, part.high);
    draw_grid(list, sheet);
    draw_islands(list, sheet, map);
    for (std::size_t i = 0; i < map.places.size(); ++i) {
      const bool chosen = i == state.chosen_place;
      const ImVec2 at = sheet.clamped(map.places[i].at, 8 * unit());
      if (chosen) list.AddCircle(at, 13 * unit(), colour::kText, 24, std::max(1.5f, 2 * unit()));
      draw_place_mark(list, map.places[i].kind, at, 7 * unit());
    }
    draw_player(list, sheet, map);
  }
  list.PopClipRect();
}

void show_discoveries(const MapFacts& map) {
  const auto line = [](const std::string& words) { text_in(colour::kFaint, words); };
  line(tr_format("Kinds of islands: {} of {}", map.kinds, map.all_kinds));
  line(tr_format("Biomes: {} of {}", map.biomes, map.all_biomes));
  if (map.highest) line(tr_format("Highest ground: {}", *map.highest));
  if (map.deepest) line(tr_format("Deepest ground: {}", *map.deepest));
}

/// Distance, height and what the pointer is over; else what was discovered.
void show_details(const MapFacts& map, const Sheet& sheet, const MapFacts::Place* chosen) {
  if (map.radius == 0.0 || map.to_come != 0)
    return text_in(colour::kFaint, tr("Islands are being drawn"));
  if (const MapFacts::Island* island = pointed_at(sheet, map)) {
    text(island->name);
    if (!island->description.empty()) text_in(colour::kFaint, island->description);
    return text_in(colour::kFaint, distance_to(map, island->at, island->up));
  }
  if (chosen) text_in(colour::kFaint, distance_to(map, chosen->at, chosen->up));
  show_discoveries(map);
}

void show_places(ScreenState& state, const MapFacts& map, float height) {
  begin_scroll("places", height);
  for (std::size_t i = 0; i < map.places.size(); ++i) {
    const MapFacts::Place& place = map.places[i];
    ImGui::PushID(static_cast<int>(i));
    const float line = ImGui::GetTextLineHeight(), inset = 1.6f * line;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##place", state.chosen_place == i, 0, ImVec2(0.0f, line)))
      state.chosen_place = i;
    if (by_keys() && ImGui::IsItemFocused()) state.chosen_place = i;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_place_mark(list, place.kind, {at.x + 0.6f * line, at.y + 0.5f * line}, 0.4f * line);
    list.AddText({at.x + inset, at.y}, colour::kText, label_of(place).c_str());
    ImGui::PopID();
  }
  end_scroll();
}

void show_name_field(ScreenState& state, const MapFacts& map, MapWishes& wishes) {
  const MapFacts::Place& place = map.places[state.chosen_place];
  const bool other = state.named_place != state.chosen_place;
  if (other || !ImGui::IsAnyItemActive()) set_field(state.place_name, place.name);
  state.named_place = state.chosen_place;
  ImGui::SetNextItemWidth(-1.0f);
  ImGui::BeginDisabled(place.kind != PlaceKind::kWaypoint);
  text_field("##place_name", state.place_name, tr("Name"));
  ImGui::EndDisabled();
  if (!ImGui::IsItemDeactivatedAfterEdit() && !ImGui::IsItemActive()) return;
  if (place.kind != PlaceKind::kWaypoint || place.name == state.place_name.data()) return;
  wishes.rename = state.chosen_place;
  wishes.name = state.place_name.data();
}

/// Of two buttons side by side [units].
float half_width() {
  return 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / unit();
}

void show_map_buttons(ScreenState& state, const MapFacts& map, MapWishes& wishes) {
  const bool any = state.chosen_place < map.places.size();
  const PlaceKind kind = any ? map.places[state.chosen_place].kind : PlaceKind::kHome;
  const float half = half_width();
  ImGui::BeginDisabled(!any);
  if (first_button(tr("Go there"), half) && any) wishes.travel = state.chosen_place;
  ImGui::SameLine();
  if (button(tr("Make it home"), half)) wishes.make_home = state.chosen_place;
  ImGui::EndDisabled();
  ImGui::BeginDisabled(map.full);
  if (button(tr("Mark this place"), half)) wishes.mark = true;
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!any || kind != PlaceKind::kWaypoint);
  if (button(tr("Remove"), half)) wishes.remove = state.chosen_place;
  ImGui::EndDisabled();
}

}  // namespace

void shift_map(ScreenState& state, glm::dvec2 blocks) {
  state.map_shift = glm::clamp(state.map_shift + blocks, -kMostMapShift, kMostMapShift);
}

std::string compass_point(glm::dvec2 to) {
  constexpr const char* kNames[] = {word("N"), word("NE"), word("E"), word("SE"),
                                    word("S"), word("SW"), word("W"), word("NW")};
  if (glm::length(to) < 0.5) return "";
  const double eighths = std::atan2(to.x, -to.y) * 4.0 / std::numbers::pi;
  return tr(kNames[(static_cast<int>(std::lround(eighths)) + 8) % 8]);
}

void show_map(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  const MapFacts& map = *facts.map;
  if (state.chosen_place >= map.places.size()) state.chosen_place = 0;
  begin_panel("map", Place::kMiddle, 1040, 690);
  const ImVec2 room = ImGui::GetContentRegionAvail(), low = ImGui::GetCursorScreenPos();
  const float side = kSideWidth * unit(), between = 20 * unit();
  const Sheet sheet{low, std::min(room.y, room.x - side - between),
                    map.radius > 0.0 ? map.radius : 1.0, map.view};
  drag_sheet(state, sheet);
  push_size(TextSize::kSmall);
  draw_sheet(state, facts, sheet);
  ImGui::SetCursorScreenPos({low.x + sheet.edge + between, low.y});
  ImGui::BeginGroup();
  ImGui::PushItemWidth(side);
  begin_scroll("side", 0.0f);
  slide("##radius", state.map_radius, 0, static_cast<int>(std::size(kMapRadii)) - 1,
        tr_format("{:.0f} blocks", kMapRadii[state.map_radius]).c_str());
  const float foot = ImGui::GetTextLineHeightWithSpacing() * 5.4f +
                     2 * (40 * unit() + ImGui::GetStyle().ItemSpacing.y) +
                     ImGui::GetFrameHeightWithSpacing() + 40 * unit();
  show_places(state, map,
              std::max(ImGui::GetTextLineHeightWithSpacing() * 2.0f,
                       ImGui::GetContentRegionAvail().y - foot));
  if (!map.places.empty()) show_name_field(state, map, wishes.map);
  show_map_buttons(state, map, wishes.map);
  const float half = half_width();
  ImGui::BeginDisabled(state.map_shift == glm::dvec2(0.0));
  if (button(tr("Show the player"), half)) state.map_shift = {};
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (button(tr("Back"), half)) state.stack.back();
  show_details(map, sheet,
               state.chosen_place < map.places.size() ? &map.places[state.chosen_place] : nullptr);
  end_scroll();
  ImGui::PopItemWidth();
  ImGui::EndGroup();
  pop_size();
  end_panel();
}

}  // namespace skerry::game::ui
