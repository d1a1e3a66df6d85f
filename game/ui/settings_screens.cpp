// Settings and controls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "game/ui/look.h"
#include "game/ui/screens.h"
#include "game/words/words.h"

namespace skerry::game::ui {
namespace {

/// As wide as the longest label of the language: text stays readable where a window is small, so no
/// width in units of layout holds it.
void label_column() {
  ImGui::TableSetupColumn("label",
                          ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_NoResize);
}

/// As wide as anything that it may say, so that sliders do not move when it does.
void cost_column() {
  float width = 0.0f;
  for (const std::string& said :
       {std::string(tr("measuring")), std::string(tr("alike")), tr_format("{:+.1f} ms", -999.9)})
    width = std::max(width, ImGui::CalcTextSize(said.c_str()).x);
  ImGui::TableSetupColumn("cost", ImGuiTableColumnFlags_WidthFixed, width);
}

/// Label to the left, a control in the middle, what it cost to the right.
class Rows {
 public:
  Rows(const ScreenFacts& facts, Wishes& wishes) : facts_(facts), wishes_(wishes) {}

  template <class Control>
  void row(const char* label, std::optional<Knob> knob, const Control& control) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    text(tr(label));
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

  /// One of some values, by name. @param names words of tr().
  template <class T, std::size_t kCount>
  void choice(const char* label, std::optional<Knob> knob, T& value, const T (&values)[kCount],
              const char* const (&names)[kCount]) {
    choice(label, knob, value, values, [&](int at) { return std::string(tr(names[at])); });
  }

  /// The same. @param name_of the text of the value at an index, as printf takes it.
  template <class T, std::size_t kCount, class NameOf>
  void choice(const char* label, std::optional<Knob> knob, T& value, const T (&values)[kCount],
              const NameOf& name_of) {
    row(label, knob, [&] {
      // What is between two of them shows as the lower.
      const auto above = std::upper_bound(std::begin(values), std::end(values), value);
      int at = std::max(0, static_cast<int>(above - std::begin(values)) - 1);
      if (!slide("##", at, 0, static_cast<int>(kCount) - 1, name_of(at).c_str())) return false;
      value = values[at];
      return true;
    });
  }

 private:
  void show_cost(Knob knob) const {
    if (facts_.costs->measuring(knob)) {
      text_in(colour::kFaint, tr("measuring"));
      return;
    }
    const std::optional<KnobCosts::Cost> cost = facts_.costs->cost(knob);
    if (!cost) return;
    if (!cost->certain()) return text_in(colour::kFaint, tr("alike"));
    text_in(cost->ms > 0.0 ? colour::kWarning : colour::kAccent, tr_format("{:+.1f} ms", cost->ms));
  }
  const ScreenFacts& facts_;
  Wishes& wishes_;
  bool first_ = true;  // no row was shown yet
};

bool slide_blocks(std::uint32_t& blocks, int least, int most) {
  int value = static_cast<int>(blocks);
  if (!slide_by_eighths("##", value, least, most, tr("%d blocks"))) return false;
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

std::string a_second(std::uint32_t rate) {
  return tr_format("{} a second", rate);
}

/// How often, and when, frames are drawn.
void show_frame_knobs(FrameSettings& frames, Rows& rows) {
  constexpr std::uint32_t kRates[] = {0, 20, 30, 40, 50, 60, 75, 90, 120, 144, 240};
  std::uint32_t wanted = frames.wanted.value_or(0);
  rows.choice(word("Frames wanted by auto"), std::nullopt, wanted, kRates, [&](int at) {
    return at == 0 ? std::string(tr("as suits the machine")) : a_second(kRates[at]);
  });
  frames.wanted.reset();
  if (wanted != 0) frames.wanted = wanted;
  constexpr std::uint32_t kCaps[] = {
      FrameSettings::kNoCap, FrameSettings::kDisplayCap, 20, 30, 60, 90, 120, 144, 240};
  rows.choice(word("Most frames"), std::nullopt, frames.cap, kCaps, [&](int at) {
    return at == 0   ? std::string(tr("no limit"))
           : at == 1 ? std::string(tr("as the display"))
                     : a_second(kCaps[at]);
  });
  constexpr std::uint32_t kUnfocused[] = {1, 5, 10, 30, 60, FrameSettings::kMostRate};
  rows.choice(word("Most without focus"), std::nullopt, frames.unfocused, kUnfocused, [&](int at) {
    return kUnfocused[at] == FrameSettings::kMostRate ? std::string(tr("as with it"))
                                                      : a_second(kUnfocused[at]);
  });
  constexpr VerticalSync kSyncs[] = {VerticalSync::kOff, VerticalSync::kOn,
                                     VerticalSync::kAdaptive};
  constexpr const char* kSyncNames[] = {word("off"), word("on"), word("adaptive")};
  rows.choice(word("Vertical sync"), std::nullopt, frames.sync, kSyncs, kSyncNames);
}

void show_sound_knobs(SoundSettings& sound, Rows& rows) {
  const auto volume = [&rows](const char* label, float& value) {
    rows.row(label, std::nullopt, [&] { return slide_part(value, 0.0f, 1.0f, "%.2f"); });
  };
  volume(word("Sound"), sound.master);
  volume(word("Sound: effects"), sound.effects);
  volume(word("Sound: wind, fire, water"), sound.ambience);
  volume(word("Sound: clicks"), sound.interface);
  constexpr bool kCaptions[] = {false, true};
  constexpr const char* kCaptionNames[] = {word("off"), word("on")};
  rows.choice(word("Captions of sounds"), std::nullopt, sound.captions, kCaptions, kCaptionNames);
}

void show_language(UiSettings& ui, Rows& rows) {
  int language = ui.language ? static_cast<int>(*ui.language) : -1;
  constexpr int kChoices[] = {-1, 0, 1, 2, 3, 4, 5, 6};
  static_assert(std::size(kChoices) == kLanguages + 1);
  rows.choice(word("Language"), std::nullopt, language, kChoices, [&](int at) {
    return std::string(at == 0 ? tr("as the system")
                               : kLanguageNames[static_cast<std::size_t>(at) - 1]);
  });
  ui.language.reset();
  if (language >= 0) ui.language = static_cast<Language>(language);
}

void show_play_knobs(Settings& settings, Rows& rows) {
  constexpr float kScales[] = {0.75f, 1.0f, 1.25f, 1.5f, 1.75f, 2.0f};
  rows.choice(word("Size of text and buttons"), std::nullopt, settings.ui.scale, kScales,
              [&](int at) { return fmt::format("{:.0f}%%", kScales[at] * 100.0f); });
  show_language(settings.ui, rows);
  constexpr bool kModes[] = {false, true};
  constexpr const char* kHoldNames[] = {word("while held"), word("by a press")};
  rows.choice(word("Sprint"), std::nullopt, settings.play.toggle_sprint, kModes, kHoldNames);
  rows.choice(word("Crouch"), std::nullopt, settings.play.toggle_crouch, kModes, kHoldNames);
  constexpr const char* kRepeatNames[] = {word("once a press"), word("goes on while held")};
  rows.choice(word("Dig and place"), std::nullopt, settings.play.repeat, kModes, kRepeatNames);
}

void show_level(const ScreenFacts& facts, Rows& rows) {
  constexpr int kLevels[] = {-1, 0, 1, 2, 3};
  constexpr const char* kLevelNames[] = {word("auto"), word("low"), word("medium"), word("high"),
                                         word("ultra")};
  const int before = *facts.quality_auto ? -1 : static_cast<int>(*facts.quality);
  int level = before;
  rows.choice(word("Quality"), Knob::kQuality, level, kLevels, kLevelNames);
  *facts.quality_auto = level < 0;
  if (level != before && level >= 0) {
    *facts.quality = static_cast<Quality>(level);
    set_quality(*facts.quality, *facts.settings);
  }
}

void show_light_knobs(Settings& settings, Rows& rows) {
  int shadows = settings.render.shadow_enabled ? settings.render.shadow_size : 0;
  constexpr int kShadows[] = {0, 512, 1024, 2048, 4096};
  constexpr const char* kShadowNames[] = {word("off"), word("coarse"), word("fair"), word("fine"),
                                          word("finest")};
  const int shadows_before = shadows;
  rows.choice(word("Shadows"), Knob::kShadows, shadows, kShadows, kShadowNames);
  if (shadows != shadows_before) {
    settings.render.shadow_enabled = shadows != 0;
    if (shadows != 0) settings.render.shadow_size = shadows;
  }
  constexpr std::uint32_t kWalls[] = {0, 1, 2, 4, 8, render::kEveryLight};
  rows.choice(word("Lights that walls stop"), Knob::kLightShadows, settings.render.lights_shadows,
              kWalls, [&](int at) {
                return at == 0                             ? std::string(tr("none"))
                       : kWalls[at] == render::kEveryLight ? std::string(tr("all"))
                                                           : tr_format("{} a pixel", kWalls[at]);
              });
  rows.row(word("Dark corners"), Knob::kAo,
           [&] { return slide_part(settings.render.ao_strength, 0.0f, 0.9f, "%.2f"); });
  constexpr render::Indirect kIndirect[] = {render::Indirect::kOff, render::Indirect::kSky,
                                            render::Indirect::kFull};
  constexpr const char* kIndirectNames[] = {word("off"), word("of the sky"),
                                            word("of sky and glow")};
  rows.choice(word("Light in the shade"), Knob::kIndirect, settings.render.indirect, kIndirect,
              kIndirectNames);
  rows.row(word("Glow of bright things"), Knob::kBloom,
           [&] { return slide_part(settings.render.bloom.intensity, 0.0f, 0.2f, "%.2f"); });
}

/// One choice of two keys, aa and aa.samples.
void show_edge_knob(render::RenderSettings& settings, Rows& rows) {
  using render::Antialiasing;
  struct Way {
    Antialiasing aa;
    int samples;
  };
  constexpr Way kWays[] = {{Antialiasing::kOff, 1},
                           {Antialiasing::kEdge, 1},
                           {Antialiasing::kTemporal, 1},
                           {Antialiasing::kOff, 4},
                           {Antialiasing::kOff, 16}};
  constexpr int kPlaces[] = {0, 1, 2, 3, 4};
  int way = settings.aa_samples == 16  ? 4
            : settings.aa_samples == 4 ? 3
                                       : static_cast<int>(settings.aa);
  const int before = way;
  rows.choice(word("Smooth edges"), Knob::kAntialiasing, way, kPlaces, [&](int at) {
    if (kWays[at].samples > 1) return tr_format("{} samples", kWays[at].samples);
    const char* const names[] = {tr("off"), tr("of blocks"), tr("over time")};
    return std::string(names[at]);
  });
  if (way == before) return;
  settings.aa = kWays[way].aa;
  settings.aa_samples = kWays[way].samples;
}

void show_knobs(const ScreenFacts& facts, Rows& rows) {
  Settings& settings = *facts.settings;
  show_level(facts, rows);
  rows.row(word("View distance"), Knob::kViewDistance,
           [&] { return slide_blocks(settings.view_distance, kMinViewDistance, 4096); });
  rows.row(word("Full detail up to"), Knob::kViewDetail,
           [&] { return slide_blocks(settings.view_detail, 32, 1024); });
  rows.row(word("Drawn size"), Knob::kScale, [&] {
    return slide_part(settings.render.render_scale, 0.25f, 1.0f, tr("%.2f of the window"));
  });
  show_light_knobs(settings, rows);
  show_edge_knob(settings.render, rows);
  constexpr int kLayers[] = {1, 2, 3, 4};
  rows.choice(word("Layers of water and glass"), Knob::kWater, settings.render.water_layers,
              kLayers, [&](int at) { return std::to_string(kLayers[at]); });
  rows.row(word("Clouds"), Knob::kClouds, [&] {
    return slide_part(settings.render.clouds.coverage, 0.0f, 1.0f, tr("%.2f of the sky"));
  });
  rows.row(word("Field of view"), std::nullopt,
           [&] { return slide_part(*facts.fov_deg, 40.0f, 110.0f, tr("%.0f degrees")); });
  show_play_knobs(settings, rows);
  show_sound_knobs(settings.sound, rows);
  show_frame_knobs(settings.frames, rows);
  render::DisplaySettings& display = settings.render.display;
  rows.row(word("Display: white"), std::nullopt, [&] {
    return slide_part(display.peak, static_cast<float>(kMinDisplayPeak), 1.0f, "%.2f");
  });
  rows.row(word("Display: black"), std::nullopt, [&] {
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
  const std::string words = waits ? std::string(pad ? tr("press a button") : tr("press a key"))
                                  : chord_label(pad ? binding.pad : binding.key);
  const float room = ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().FramePadding.x;
  const std::string label = in_lines(words, room) + (pad ? "##pad" : "##key");
  if (ImGui::Button(label.c_str(), ImVec2(-1.0f, 0.0f)) && !state.listening)
    state.listening = ScreenState::Listening{action, pad};
}

void binding_row(ScreenState& state, const ScreenFacts& facts, Action action) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  const std::vector<Action> conflicts = conflicts_of(*facts.bindings, action);
  text_in(conflicts.empty() ? colour::kText : colour::kWarning, action_label(action));
  ImGui::PushID(static_cast<int>(action));
  binding_button(state, facts, action, false);
  binding_button(state, facts, action, true);
  ImGui::PopID();
  if (conflicts.empty()) return;
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TableNextColumn();
  text_in(colour::kWarning, tr_format("also: {}", action_label(conflicts.front())));
}

}  // namespace

void show_settings(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  // No shade: the picture behind is what the knobs change.
  begin_panel("settings", Place::kLeft, 680, 660);
  heading(tr("Settings"), by_keys() ? tr("left, right: change") : "");
  const float foot = 40 * unit() + 2 * ImGui::GetStyle().ItemSpacing.y;
  begin_scroll("knobs", -foot);
  if (ImGui::BeginTable("rows", 3)) {
    label_column();
    ImGui::TableSetupColumn("control", ImGuiTableColumnFlags_WidthStretch);
    cost_column();
    Rows rows(facts, wishes);
    show_knobs(facts, rows);
    ImGui::EndTable();
  }
  end_scroll();
  gap(0);
  if (button(tr("Back"), 150)) state.stack.back();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  text_in(colour::kFaint, tr_format("GPU {:.1f} ms a frame", facts.costs->now_ms()));
  end_panel();
}

void show_controls(ScreenState& state, const ScreenFacts& facts, Wishes& wishes) {
  shade();
  listen(state, facts, wishes);
  begin_panel("controls", Place::kMiddle, 860, 660);
  heading(tr("Controls"));
  Bindings& bindings = *facts.bindings;
  const float foot = 40 * unit() + 2 * ImGui::GetStyle().ItemSpacing.y;
  begin_scroll("actions", -foot);
  if (ImGui::BeginTable("turning", 2)) {
    label_column();
    ImGui::TableSetupColumn("control", ImGuiTableColumnFlags_WidthStretch);
    const auto speed = [&](const char* label, double& value) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::AlignTextToFramePadding();
      text(tr(label));
      ImGui::TableNextColumn();
      ImGui::PushID(label);
      wishes.bindings_changed |= slide_part(value, static_cast<float>(kMinTurnSpeed),
                                            static_cast<float>(kMaxTurnSpeed), "%.2f");
      ImGui::PopID();
    };
    speed(word("Mouse speed"), bindings.mouse_speed);
    speed(word("Gamepad speed"), bindings.pad_speed);
    ImGui::EndTable();
  }
  wishes.bindings_changed |= ImGui::Checkbox(tr("Up looks down"), &bindings.inverted);
  gap(4);
  if (ImGui::BeginTable("bindings", 3)) {
    ImGui::TableSetupColumn("action", ImGuiTableColumnFlags_WidthStretch, 1.1f);
    ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableSetupColumn("pad", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableNextRow();
    for (const char* title : {"", tr("Keyboard and mouse"), tr("Gamepad")}) {
      ImGui::TableNextColumn();
      text_in(colour::kAccent, title);
    }
    for (std::size_t i = 0; i < kActions; ++i) binding_row(state, facts, static_cast<Action>(i));
    ImGui::EndTable();
  }
  end_scroll();
  gap(0);
  if (first_button(tr("Back"), 150)) state.stack.back();
  ImGui::SameLine();
  if (button(tr("Back to the usual keys"), 340)) {
    bindings = default_bindings();
    wishes.bindings_changed = true;
  }
  end_panel();
}

}  // namespace skerry::game::ui
