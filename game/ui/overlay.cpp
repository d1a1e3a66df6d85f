#include "game/ui/overlay.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/render/frame/display.h"
#include "game/ui/look.h"
#include "game/words/words.h"

namespace skerry::game {
namespace {

constexpr float kPanelWidth = 372.0f;  // units of layout, as the next
constexpr float kGraphHeight = 60.0f;
constexpr ImU32 kBar = IM_COL32(122, 204, 190, 70);
constexpr std::size_t kMemoryRows = 12;  // the rest is summed up

using ui::text;

void show_frames(const OverlayFacts& facts) {
  const FrameSpread spread = spread_of_frames(facts.frame_ms);
  if (facts.frame_ms.empty()) return;
  ui::text_wrapped(ui::colour::kText,
                   fmt::format("{:.1f} fps   median {:.2f} ms   slowest 1% {:.2f} ms",
                               1000.0f / std::max(spread.median, 1e-3f), spread.median,
                               spread.slowest_1_percent));
  ImGui::PlotLines("##frames", facts.frame_ms.data(), static_cast<int>(facts.frame_ms.size()), 0,
                   nullptr, 0.0f, std::max(2.0f * spread.median, spread.slowest_1_percent),
                   ImVec2(ImGui::GetContentRegionAvail().x, kGraphHeight * ui::unit()));
}

struct Row {
  std::string name, value;
  double share = 0.0;  // of the table's width that a bar behind it takes
};

float text_width(std::string_view line) {
  return ImGui::CalcTextSize(line.data(), line.data() + line.size()).x;
}

void show_row(const Row& row) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetWindowContentRegionMax().x - ImGui::GetWindowContentRegionMin().x;
  if (row.share > 0.0) {
    const ImVec2 end(at.x + static_cast<float>(row.share) * width,
                     at.y + ImGui::GetTextLineHeight());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 panel = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    list.PushClipRect(panel, ImVec2(panel.x + size.x, panel.y + size.y));  // beyond its column
    list.AddRectFilled(at, end, kBar);
    list.PopClipRect();
  }
  text(ui::shortened(row.name, ImGui::GetContentRegionAvail().x));
  ImGui::TableNextColumn();
  const float slack = ImGui::GetContentRegionAvail().x - text_width(row.value);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, slack));
  text(row.value);
}

/// Two columns of names and values under a heading. The values have the room that they need, the
/// names what is left. @param id stays the same while the heading changes: ImGui keeps the columns'
/// widths by it.
void table(const char* id, const std::string& heading, std::span<const Row> rows) {
  ImGui::Separator();
  text(heading);
  // Of a given width: a table that makes its window as wide as itself would be as narrow as it can.
  if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_None,
                         ImVec2(ImGui::GetContentRegionAvail().x, 0.0f)))
    return;
  float widest = 1.0f;
  for (const Row& row : rows) widest = std::max(widest, text_width(row.value));
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthFixed, widest);
  for (const Row& row : rows) show_row(row);
  ImGui::EndTable();
}

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.2f} MB", static_cast<double>(bytes) * 1e-6);
}

void show_memory(std::span<const gpu::MemoryUse> memory) {
  std::uint64_t total = 0, rest = 0;
  for (std::size_t i = 0; i < memory.size(); ++i) {
    total += memory[i].bytes;
    if (i >= kMemoryRows) rest += memory[i].bytes;
  }
  std::vector<Row> rows;
  for (const gpu::MemoryUse& use : memory.first(std::min(memory.size(), kMemoryRows)))
    rows.push_back({use.name, megabytes(use.bytes)});
  if (rest != 0) rows.push_back({"others", megabytes(rest)});
  table("memory", fmt::format("GPU memory: {:.1f} MB", static_cast<double>(total) * 1e-6), rows);
}

constexpr float kPanelShare = 0.3f;  // of the picture's width at most: the middle stays to look at
constexpr float kFootHeight = 124.0f;  // of the hotbar, its label and a message, units

/// A translucent panel in the upper left or right corner, as high as its contents, or down to the
/// hotbar.
template <class F>
void panel(const char* id, bool right, const ImVec2& picture, const F& contents) {
  const float gap = 8.0f * ui::unit();
  const float width = std::max(1.0f, std::min(kPanelWidth * ui::unit(), kPanelShare * picture.x));
  const float pivot = right ? 1.0f : 0.0f;
  ImGui::SetNextWindowPos(ImVec2(right ? picture.x - gap : gap, gap), ImGuiCond_Always,
                          ImVec2(pivot, 0.0f));
  ImGui::SetNextWindowSizeConstraints(
      ImVec2(width, 0.0f),
      ImVec2(width, std::max(32.0f, picture.y - gap - kFootHeight * ui::unit())));
  ImGui::SetNextWindowBgAlpha(0.6f);
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration |
                                      ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings;
  ImGui::Begin(id, nullptr, kFlags);
  contents();
  ImGui::End();
}

/// A square with a value of the picture, as the display gets it, in the middle of another.
void patch(double encoded, double around, const render::DisplaySettings& display, float edge) {
  const auto grey = [&](double value) {
    const auto level = static_cast<int>(std::lround(255.0 * render::displayed(value, display)));
    return IM_COL32(level, level, level, 255);
  };
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float inset = 0.25f * edge;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, ImVec2(at.x + edge, at.y + edge), grey(around));
  list.AddRectFilled(ImVec2(at.x + inset, at.y + inset),
                     ImVec2(at.x + edge - inset, at.y + edge - inset), grey(encoded));
  ImGui::Dummy(ImVec2(edge, edge));
}

/// Dark squares on black and bright ones on white: what the display can keep apart.
void show_calibration(const OverlayFacts& facts, const ImVec2& picture) {
  const render::DisplaySettings& display = *facts.calibration;
  const float edge = 56.0f * ui::unit();
  ImGui::SetNextWindowPos(ImVec2(0.5f * picture.x, 0.5f * picture.y), ImGuiCond_Always,
                          ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowBgAlpha(1.0f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.0f, 0.0f, 0.0f, 1.0f));
  ImGui::Begin("calibration", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings);
  text(tr("Up, Down: until the square on the left is just seen"));
  const auto squares = [&](std::span<const int> codes, double around) {
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (i != 0) ImGui::SameLine();
      patch(codes[i] / 255.0, around, display, edge);
    }
  };
  constexpr int kDark[] = {1, 2, 4, 8, 16}, kBright[] = {254, 252, 248, 240, 224};
  squares(kDark, 0.0);
  text(tr("Left, Right: as bright as is pleasant, all squares seen"));
  squares(kBright, 1.0);
  text(fmt::format("display.black {:.3f}   display.peak {:.2f}   {}", display.black, display.peak,
                   tr_format("{} closes", facts.calibration_key)));
  ImGui::End();
  ImGui::PopStyleColor();
}

void show_numbers(const OverlayFacts& facts, const ImVec2& picture) {
  panel("state", false, picture, [&] {
    show_frames(facts);
    const float width = ImGui::GetContentRegionAvail().x;  // no number is broken at its point
    for (const std::string& line : facts.lines)
      ui::text_wrapped(ui::colour::kText, ui::in_lines(line, width));
    std::vector<Row> rows;
    for (const auto& count : facts.counts)
      rows.push_back({std::string(count.name), fmt::format("{}", count.value)});
    table("counts", "counts", rows);
  });
  panel("gpu", true, picture, [&] {
    std::vector<Row> rows;
    for (const gpu::PassTime& pass : facts.passes)
      rows.push_back({pass.name, fmt::format("{:.3f} ms", pass.ms),
                      facts.gpu_ms > 0.0 ? pass.ms / facts.gpu_ms : 0.0});
    table("passes", fmt::format("GPU passes: {:.2f} ms", facts.gpu_ms), rows);
    show_memory(facts.memory);
  });
}

}  // namespace

void show_overlay(const OverlayFacts& facts) {
  const ImVec2 picture = ImGui::GetIO().DisplaySize;
  ui::push_size(ui::TextSize::kSmall);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(10 * ui::unit(), 8 * ui::unit()));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(6 * ui::unit(), 2 * ui::unit()));
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(4 * ui::unit(), 0.0f));
  if (facts.numbers) show_numbers(facts, picture);
  if (facts.calibration) show_calibration(facts, picture);
  ImGui::PopStyleVar(3);
  ui::pop_size();
}

FrameSpread spread_of_frames(std::span<const float> frame_ms) {
  if (frame_ms.empty()) return {};
  std::vector<float> sorted(frame_ms.begin(), frame_ms.end());
  std::sort(sorted.begin(), sorted.end());
  return {sorted[sorted.size() / 2], sorted[(sorted.size() * 99) / 100]};
}

}  // namespace skerry::game
