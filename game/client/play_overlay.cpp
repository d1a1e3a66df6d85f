// What the window's title and the overlay say of a run of the game.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>

#include "game/client/island_name.h"
#include "game/client/play_loop.h"
#include "game/ui/gui.h"
#include "game/words/words.h"

namespace skerry::game {
namespace {

constexpr double kTitlePeriod = 0.5;      // seconds
constexpr std::size_t kFramesKept = 240;  // for the overlay's graph
constexpr std::size_t kLabelBytes = 40;   // of a name or a seed, where there is little room

std::string brief(const std::string& text) {
  std::string out = ui::pasted_text(text, kLabelBytes);
  return out.size() == text.size() ? out : out + "...";
}

}  // namespace

std::string PlayLoop::world_label() const {
  const world::WorldInfo& info = session_->joined().world;
  const bool saved = !info.name.empty();
  if (!saved && scene_.world) return brief(std::filesystem::path(*scene_.world).filename());
  const std::string& seed = saved ? info.seed_text : scene_.seed_text;
  std::string label = brief(info.name);
  if (!seed.empty()) label += (saved ? ", " : "") + tr_format("seed {}", brief(seed));
  return label;
}

void PlayLoop::note_frame(double seconds) {
  if (frame_ms_.size() == kFramesKept) frame_ms_.erase(frame_ms_.begin());
  frame_ms_.push_back(static_cast<float>(seconds * 1000.0));
  since_title_s_ += seconds;
  if (since_title_s_ < kTitlePeriod) return;
  since_title_s_ = 0.0;
  const double fps = 1000.0 / std::max(spread_of_frames(frame_ms_).median, 1e-3f);
  window_.set_title(fmt::format("Skerry - {} - {:.0f} fps", world_label(), fps));
}

std::vector<std::string> PlayLoop::overlay_lines() const {
  const CameraPlace& eye = *scene_.camera;
  const world::Streamer::Stats stream = view_->streamer().stats();
  std::vector<std::string> lines{
      world_label(),
      fmt::format("{}x{}   {}", presenter_.extent().width, presenter_.extent().height,
                  device_.info().name),
      fmt::format("x {} y {} z {}", format_blocks(eye.position.x), format_blocks(eye.position.y),
                  format_blocks(eye.position.z)),
      fmt::format("yaw {:.1f} pitch {:.1f}   {} {:.1f} blocks/s", eye.yaw_deg, eye.pitch_deg,
                  player_.mode() == MoveMode::kNoclip ? "flying through walls"
                  : player_.mode() == MoveMode::kFly  ? "flying"
                  : player_.in_water()                ? "swimming"
                  : player_.crouching()               ? "crouching"
                                                      : "walking",
                  glm::length(player_.velocity())),
      fmt::format("time {}   islands at {:.1f} s", format_time_of_day(day_.time_of_day_s()),
                  player_.world_time_s()),
      fmt::format("quality {}   view {} blocks, detail {}{}", quality_level(scene_.quality).name,
                  view_->settings().view_distance, view_->settings().view_detail,
                  culling_frozen_ ? "   culling frozen" : ""),
      fmt::format("exposure {:.2f} stops",
                  view_->renderer().report().value_or(render::FrameReport{}).exposure_ev),
      fmt::format("streaming: {} islands, {} tasks left", stream.islands, stream.tasks_left)};
  if (!quality_line_.empty()) lines.push_back(quality_line_);
  if (!sound_line_.empty()) lines.push_back(sound_line_);
  return lines;
}

void PlayLoop::show_numbers() const {
  if (!overlay_shown_ && !calibrating_) return;
  OverlayFacts facts;
  facts.frame_ms = frame_ms_;
  const std::vector<std::string> lines = overlay_lines();
  facts.lines = lines;
  const render::FrameReport report = view_->renderer().report().value_or(render::FrameReport{});
  facts.gpu_ms = report.gpu_ms;
  facts.passes = report.passes;
  const render::GeometryStore& geometry = view_->renderer().geometry();
  const std::vector<OverlayFacts::Count> counts{{"sections resident", geometry.sections_resident()},
                                                {"sections drawn", report.camera.sections_passed},
                                                {"quads resident", geometry.quads_resident()},
                                                {"quads drawn", report.camera.quads},
                                                {"quads in shadows", report.shadows.quads},
                                                {"draws", report.camera.draws},
                                                {"draws in shadows", report.shadows.draws},
                                                {"lights", view_->lights()}};
  facts.counts = counts;
  const std::vector<gpu::MemoryUse> memory = device_.memory_use();
  facts.memory = memory;
  facts.numbers = overlay_shown_;
  if (calibrating_) facts.calibration = view_->settings().render.display;
  facts.calibration_key = chord_label((*bindings_)[Action::kCalibrate].key);
  show_overlay(facts);
}

ui::HudFacts PlayLoop::hud() const {
  ui::HudFacts facts;
  const CameraPlace& eye = *scene_.camera;
  const world::WorldPos feet = player_.feet();
  const auto whole = [](std::int64_t units) {
    return world::floor_div(units, world::kUnitsPerBlock);
  };
  facts.yaw_deg = eye.yaw_deg;
  facts.hidden = player_.return_fade();
  facts.hotbar = hands_.hotbar().blocks;
  facts.selected = hands_.hotbar().selected;
  facts.time_of_day_s = day_.time_of_day_s();
  facts.place = fmt::format("{}  {}  {}", whole(feet.x), whole(feet.y), whole(feet.z));
  facts.numbers = overlay_shown_;
  if (helm_.island())
    facts.steering = {island_name(*helm_.island()), helm_.speed(), helm_.held_fast()};
  facts.marks = compass_marks();
  facts.torch = view_->settings().lights_held;
  if (!view_->complete()) facts.islands_to_come = view_->streamer().stats().tasks_left;
  facts.shaders_to_come = view_->renderer().programs_to_come();
  return facts;
}

}  // namespace skerry::game
