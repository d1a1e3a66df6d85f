// Settings and controls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "game/ui/look.h"
#include "game/ui/screens.h"

namespace skerry::game::ui {
namespace {

constexpr float kLabelWidth = 230.0f, kCostWidth = 104.0f;  // units

/// Label to the left, a control in the middle, what it cost to the right.
class Rows {
 public:
  Rows(const ScreenFacts& facts, Wishes& wishes) : facts_(facts), wishes_(wishes) {}

  template <class Control>
  void row(const char* label, std::optional<Knob> knob, const Control& control) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    text(label);
    ImGui::TableNextColumn();
    ImGui::PushID(label);
    const bool changed = control();
    if (std::exchange(first_, false)) ImGui::SetItemDefaultFocus();
    ImGui::PopID();
    ImGui::TableNextColumn();
    if (!knob) {
      wishes_.settings_changed |= changed;
      return;
    }
    ImGui::AlignTextToFramePadding();
    show_cost(*knob);
    if (!changed) return;
    wishes_.settings_changed = true;
    facts_.costs->turned(*knob);
  }

  /// One of some values, by name.
  template <class T, std::size_t kCount>
  void choice(const char* label, std::optional<Knob> knob, T& value, const T (&values)[kCount],
              const char* const (&names)[kCount]) {
    row(label, knob, [&] {
      // What is between two of them shows as the lower.
      const auto above = std::upper_bound(std::begin(values), std::end(values), value);
      int at = std::max(0, static_cast<int>(above - std::begin(values)) - 1);
      if (!slide("##", at, 0, static_cast<int>(kCount) - 1, names[at])) return false;
      value = values[at];
      return true;
    });
  }

 private:
  void show_cost(Knob knob) const {
    if (facts_.costs->measuring(knob)) {
      text_in(colour::kFaint, "measuring");
      return;
    }
    const std::optional<KnobCosts::Cost> cost = facts_.costs->cost(knob);
    if (!cost) return;
    if (!cost->certain()) return text_in(colour::kFaint, "alike");
    text_in(cost->ms > 0.0 ? colour::kWarning : colour::kAccent,
            fmt::format("{:+.1f} ms", cost->ms));
  }
  const ScreenFacts& facts_;
  Wishes& wishes_;
  bool first_ = true;  // no row was shown yet
};

bool slide_blocks(std::uint32_t& blocks, int least, int most) {
  int value = static_cast<int>(blocks);
  if (!slide_by_eighths("##", value, least, most, "%d blocks")) return false;
  blocks = static_cast<std::uint32_t>(value);
  return true;
}

constexpr float kKeySteps = 20.0f;  // from one end of a slider to the other

bool slide_part(float& value, float least, float most, const char* format) {
  return slide("##", value, least, most, (most - least) / kKeySteps, format);
}

bool slide_part(double& value, float least, float most, const char* format) {
  auto narrow = static_cast<float>(value);
  if (!slide_part(narrow, least, most, format)) return false;
  value = std::round(double{narrow} * 100.0) / 100.0;
  return true;
}

/// How often, and when, frames are drawn.
void show_frame_knobs(FrameSettings& frames, Rows& rows) {
  constexpr std::uint32_t kRates[] = {0, 20, 30, 40, 50, 60, 75, 90, 120, 144, 240};
  constexpr const char* kRateNames[] = {"as suits the machine", "20 a second", "30 a second",
                                        "40 a second",          "50 a second", "60 a second",
                                        "75 a second",          "90 a second", "120 a second",
                                        "144 a second",         "240 a second"};
  std::uint32_t wanted = frames.wanted.value_or(0);
  rows.choice("Frames wanted by auto", std::nullopt, wanted, kRates, kRateNames);
  frames.wanted.reset();
  if (wanted != 0) frames.wanted = wanted;
  constexpr std::uint32_t kCaps[] = {
      FrameSettings::kNoCap, FrameSettings::kDisplayCap, 20, 30, 60, 90, 120, 144, 240};
  constexpr const char* kCapNames[] = {"no limit",     "as the display", "20 a second",
                                       "30 a second",  "60 a second",    "90 a second",
                                       "120 a second", "144 a second",   "240 a second"};
  rows.choice("Most frames", std::nullopt, frames.cap, kCaps, kCapNames);
  constexpr std::uint32_t kUnfocused[] = {1, 5, 10, 30, 60, FrameSettings::kMostRate};
  constexpr const char* kUnfocusedNames[] = {"1 a second",  "5 a second",  "10 a second",
                                             "30 a second", "60 a second", "as with it"};
  rows.choice("Most without focus", std::nullopt, frames.unfocused, kUnfocused, kUnfocusedNames);
  constexpr VerticalSync kSyncs[] = {VerticalSync::kOff, VerticalSync::kOn,
                                     VerticalSync::kAdaptive};
  constexpr const char* kSyncNames[] = {"off", "on", "adaptive"};
  rows.choice("Vertical sync", std::nullopt, frames.sync, kSyncs, kSyncNames);
}

void show_sound_knobs(SoundSettings& sound, Rows& rows) {
  const auto volume = [&rows](const char* label, float& value) {
    rows.row(label, std::nullopt, [&] { return slide_part(value, 0.0f, 1.0f, "%.2f"); });
  };
  volume("Sound", sound.master);
  volume("Sound: effects", sound.effects);
  volume("Sound: wind, fire, water", sound.ambience);
  volume("Sound: clicks", sound.interface);
  constexpr bool kCaptions[] = {false, true};
  constexpr const char* kCaptionNames[] = {"off", "on"};
  rows.choice("Captions of sounds", std::nullopt, sound.captions, kCaptions, kCaptionNames);
}

void show_level(const ScreenFacts& facts, Rows& rows) {
  constexpr int kLevels[] = {-1, 0, 1, 2, 3};
  constexpr const char* kLevelNames[] = {"auto", "low", "medium", "high", "ultra"};
  const int before = *facts.quality_auto ? -1 : static_cast<int>(*facts.quality);
  int level = before;
  rows.choice("Quality", Knob::kQuality, level, kLevels, kLevelNames);
  *facts.quality_auto = level < 0;
  if (level != before && level >= 0) {
    *facts.quality = static_cast<Quality>(level);
    set_quality(*facts.quality, *facts.settings);
  }
}

void show_light_knobs(Settings& settings, Rows& rows) {
  int shadows = settings.render.shadow_enabled ? settings.render.shadow_size : 0;
  constexpr int kShadows[] = {0, 512, 1024, 2048, 4096};
  constexpr const char* kShadowNames[] = {"off", "coarse", "fair", "fine", "finest"};
  const int shadows_before = shadows;
  rows.choice("Shadows", Knob::kShadows, shadows, kShadows, kShadowNames);
  if (shadows != shadows_before) {
    settings.render.shadow_enabled = shadows != 0;
    if (shadows != 0) settings.render.shadow_size = shadows;
  }
  constexpr std::uint32_t kWalls[] = {0, 1, 2, 4, 8, render::kEveryLight};
  constexpr const char* kWallNames[] = {"none",      "1 a pixel", "2 a pixel",
                                        "4 a pixel", "8 a pixel", "all"};
  rows.choice("Lights that walls stop", Knob::kLightShadows, settings.render.lights_shadows, kWalls,
              kWallNames);
  rows.row("Dark corners", Knob::kAo,
           [&] { return slide_part(settings.render.ao_strength, 0.0f, 0.9f, "%.2f"); });
  constexpr render::Indirect kIndirect[] = {render::Indirect::kOff, render::Indirect::kSky,
                                            render::Indirect::kFull};
  constexpr const char* kIndirectNames[] = {"off", "of the sky", "of sky and glow"};
  rows.choice("Light in the shade", Knob::kIndirect, settings.render.indirect, kIndirect,
              kIndirectNames);
  rows.row("Glow of bright things", Knob::kBloom,
           [&] { return slide_part(settings.render.bloom.intensity, 0.0f, 0.2f, "%.2f"); });
}

void show_knobs(const ScreenFacts& facts, Rows& rows) {
  Settings& settings = *facts.settings;
  show_level(facts, rows);
  rows.row("View distance", Knob::kViewDistance,
           [&] { return slide_blocks(settings.view_distance, kMinViewDistance, 4096); });
  rows.row("Full detail up to", Knob::kViewDetail,
           [&] { return slide_blocks(settings.view_detail, 32, 1024); });
  rows.row("Drawn size", Knob::kScale, [&] {
    return slide_part(settings.render.render_scale, 0.25f, 1.0f, "%.2f of the window");
  });
  show_light_knobs(settings, rows);
  constexpr int kSamples[] = {1, 4, 16};
  constexpr const char* kSampleNames[] = {"off", "4 samples", "16 samples"};
  rows.choice("Smooth edges", Knob::kAntialiasing, settings.render.aa_samples, kSamples,
              kSampleNames);
  constexpr int kLayers[] = {1, 2, 3, 4};
  constexpr const char* kLayerNames[] = {"1 layer", "2 layers", "3 layers", "4 layers"};
  rows.choice("Water and glass", Knob::kWater, settings.render.water_layers, kLayers, kLayerNames);
  rows.row("Clouds", Knob::kClouds, [&] {
    return slide_part(settings.render.clouds.coverage, 0.0f, 1.0f, "%.2f of the sky");
  });
  rows.row("Field of view", std::nullopt,
           [&] { return slide_part(*facts.fov_deg, 40.0f, 110.0f, "%.0f degrees"); });
  show_sound_knobs(settings.sound, rows);
  show_frame_knobs(settings.frames, rows);
  render::DisplaySettings& display = settings.render.display;
  rows.row("Display: white", std::nullopt, [&] {
    return slide_part(display.peak, static_cast<float>(kMinDisplayPeak), 1.0f, "%.2f");
  });
  rows.row("Display: black", std::nullopt, [&] {
    return slide_part(display.black, 0.0f, static_cast<float>(kMaxDisplayBlack), "%.3f");
  });
}

// Controls.

/// Takes the key that was pressed for the binding that waits for one. Delete clears it; Ctrl, or a
/// gamepad's Back, begins a chord, unless it goes up again alone.
void listen(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  using platform::Key;
  if (!state.listening) return;
  const ScreenState::Listening waiting = *state.listening;
  const Key control = control_of(waiting.pad ? Key::kPadA : Key::kA);
  Key key = facts.pressed;
  if (key == control) return;
  if (key == Key::kNone && facts.control_up) key = control;
  if (key == Key::kNone) return;
  const bool clears = key == Key::kDelete;
  if (!clears && platform::is_pad(key) != waiting.pad) return;
  Binding& binding = (*facts.bindings)[waiting.action];
  const bool chord = facts.control && key != control;
  (waiting.pad ? binding.pad : binding.key) = clears ? Chord{} : Chord{key, chord};
  state.listening.reset();
  wishes.bindings_changed = true;
}

void binding_button(ScreenState& state, const ScreenFacts& facts, Action action, bool pad) {
  ImGui::TableNextColumn();
  const Binding& binding = (*facts.bindings)[action];
  const bool waits =
      state.listening && state.listening->action == action && state.listening->pad == pad;
  const std::string label = (waits ? std::string(pad ? "press a button" : "press a key")
                                   : chord_label(pad ? binding.pad : binding.key)) +
                            (pad ? "##pad" : "##key");
  if (ImGui::Button(label.c_str(), ImVec2(-1.0f, 0.0f)) && !state.listening)
    state.listening = ScreenState::Listening{action, pad};
}

void binding_row(ScreenState& state, const ScreenFacts& facts, Action action) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  const std::vector<Action> conflicts = conflicts_of(*facts.bindings, action);
  text_in(conflicts.empty() ? colour::kText : colour::kWarning, action_type(action).label);
  ImGui::PushID(static_cast<int>(action));
  binding_button(state, facts, action, false);
  binding_button(state, facts, action, true);
  ImGui::PopID();
  if (conflicts.empty()) return;
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TableNextColumn();
  text_in(colour::kWarning, fmt::format("also: {}", action_type(conflicts.front()).label));
}

}  // namespace

void show_settings(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  // No shade: the picture behind is what the knobs change.
  begin_panel("settings", Place::kLeft, 680, 660);
  heading("Settings");
  const float foot = 40 * unit() + 2 * ImGui::GetStyle().ItemSpacing.y;
  begin_scroll("knobs", -foot);
  if (ImGui::BeginTable("rows", 3)) {
    ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthFixed, kLabelWidth * unit());
    ImGui::TableSetupColumn("control", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("cost", ImGuiTableColumnFlags_WidthFixed, kCostWidth * unit());
    Rows rows(facts, wishes);
    show_knobs(facts, rows);
    ImGui::EndTable();
  }
  end_scroll();
  gap(0);
  if (button("Back", 150)) state.stack.back();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  text_in(colour::kFaint, fmt::format("GPU {:.1f} ms a frame{}", facts.costs->now_ms(),
                                      by_keys() ? "   left, right: change" : ""));
  end_panel();
}

void show_controls(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  shade();
  listen(state, facts, wishes);
  begin_panel("controls", Place::kMiddle, 860, 660);
  heading("Controls");
  Bindings& bindings = *facts.bindings;
  const float foot = 40 * unit() + 2 * ImGui::GetStyle().ItemSpacing.y;
  begin_scroll("actions", -foot);
  if (ImGui::BeginTable("turning", 2)) {
    ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthFixed, kLabelWidth * unit());
    ImGui::TableSetupColumn("control", ImGuiTableColumnFlags_WidthStretch);
    const auto speed = [&](const char* label, double& value) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::AlignTextToFramePadding();
      text(label);
      ImGui::TableNextColumn();
      ImGui::PushID(label);
      wishes.bindings_changed |= slide_part(value, static_cast<float>(kMinTurnSpeed),
                                            static_cast<float>(kMaxTurnSpeed), "%.2f");
      ImGui::PopID();
    };
    speed("Mouse speed", bindings.mouse_speed);
    speed("Gamepad speed", bindings.pad_speed);
    ImGui::EndTable();
  }
  wishes.bindings_changed |= ImGui::Checkbox("Up looks down", &bindings.inverted);
  gap(4);
  if (ImGui::BeginTable("bindings", 3)) {
    ImGui::TableSetupColumn("action", ImGuiTableColumnFlags_WidthStretch, 1.1f);
    ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableSetupColumn("pad", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableNextRow();
    for (const char* title : {"", "Keyboard and mouse", "Gamepad"}) {
      ImGui::TableNextColumn();
      text_in(colour::kAccent, title);
    }
    for (std::size_t i = 0; i < kActions; ++i) binding_row(state, facts, static_cast<Action>(i));
    ImGui::EndTable();
  }
  end_scroll();
  gap(0);
  if (first_button("Back", 150)) state.stack.back();
  ImGui::SameLine();
  if (button("Back to the usual keys", 260)) {
    bindings = default_bindings();
    wishes.bindings_changed = true;
  }
  end_panel();
}

}  // namespace skerry::game::ui
