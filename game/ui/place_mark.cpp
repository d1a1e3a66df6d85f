#include "game/ui/place_mark.h"

#include <algorithm>

#include "game/ui/look.h"

namespace skerry::game::ui {
namespace {

void draw_shape(ImDrawList& list, PlaceKind kind, ImVec2 m, float half, ImU32 colour) {
  switch (kind) {
    case PlaceKind::kHome: {
      const ImVec2 house[] = {{m.x - half, m.y},
                              {m.x, m.y - half},
                              {m.x + half, m.y},
                              {m.x + 0.7f * half, m.y},
                              {m.x + 0.7f * half, m.y + half},
                              {m.x - 0.7f * half, m.y + half},
                              {m.x - 0.7f * half, m.y}};
      list.AddConvexPolyFilled(house, 3, colour);
      list.AddRectFilled(house[6], house[4], colour);
      break;
    }
    case PlaceKind::kGround:
      list.AddCircle(m, 0.75f * half, colour, 20, std::max(1.5f, 0.4f * half));
      break;
    case PlaceKind::kWaypoint:
      list.AddQuadFilled({m.x, m.y - half}, {m.x + 0.8f * half, m.y}, {m.x, m.y + half},
                         {m.x - 0.8f * half, m.y}, colour);
      break;
  }
}

}  // namespace

void draw_place_mark(ImDrawList& list, PlaceKind kind, ImVec2 middle, float half, double strength) {
  const auto opaque = [strength](ImU32 colour, double most) {
    ImVec4 value = ImGui::ColorConvertU32ToFloat4(colour);
    value.w = static_cast<float>(std::clamp(strength, 0.0, 1.0) * most);
    return ImGui::ColorConvertFloat4ToU32(value);
  };
  draw_shape(list, kind, middle, half + std::max(1.5f, 1.5f * unit()),
             opaque(IM_COL32(8, 14, 18, 255), 0.85));
  draw_shape(list, kind, middle, half,
             opaque(kind == PlaceKind::kWaypoint ? colour::kWarning : colour::kText, 1.0));
}

}  // namespace skerry::game::ui
