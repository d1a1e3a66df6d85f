#include "game/ui/screens.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <set>
#include <tuple>

#include "game/ui/gui.h"
#include "game/ui/loading_screen.h"
#include "game/ui/look.h"
#include "game/words/words.h"

namespace skerry::game::ui {
namespace {

using platform::Input;
using platform::Key;
using platform::PadState;

struct Size {
  std::uint32_t width, height;
};
constexpr Size kSizes[] = {{640, 360}, {1280, 720}, {2560, 1440}};
constexpr Screen kScreens[] = {
    Screen::kTitle, Screen::kWorlds,  Screen::kNewWorld, Screen::kSettings, Screen::kControls,
    Screen::kPause, Screen::kPalette, Screen::kPhoto,    Screen::kMap,      Screen::kGallery};

/// A person at the screens.
class Sitting {
 public:
  explicit Sitting(Screen screen, Size size = {1280, 720}) : size_(size) {
    state.stack.open(screen);
    facts.pictures = &pictures();
    facts.worlds = worlds;
    facts.now_s = 1'000'000;
    facts.quality = &quality;
    facts.quality_auto = &quality_auto;
    facts.settings = &settings;
    facts.fov_deg = &fov_deg;
    facts.bindings = &bindings;
    facts.costs = &costs;
    facts.photo = &photo;
    facts.map = &map;
    facts.gallery = gallery;
    map.radius = 300.0;
    map.places = {{PlaceKind::kHome, "", {10.0, -20.0}, 3.0},
                  {PlaceKind::kGround, "", {1.0, 2.0}, 0.0},
                  {PlaceKind::kWaypoint, "Skarholm 1", {5000.0, 0.0}, -40.0}};
    map.islands = {{"Skarholm", "volcano, tropical", {30.0, 40.0}, 120.0, 5.0, {0.2, -0.1}}};
    facts.version = "1.2.3";
  }

  /// Shows a frame. @return what is to be drawn.
  OverlayTriangles frame() {
    const platform::InputFrame taken = input.take();
    facts.back = goes_back(state, taken);
    if (facts.back) go_back(state);
    take_keys(state, taken, facts);
    const bool fed = !state.listening;
    gui.begin({size_.width, size_.height, 0.05, fed ? &taken : nullptr, scale});
    show_screens(state, facts, wishes);
    return gui.end();
  }
  /// Shows for two frames how far something is that the last frame waits for.
  void load() {
    for (int i = 0; i < 2; ++i) {
      gui.begin({size_.width, size_.height, 0.05, nullptr, scale, true});
      show_loading({});
      (void)gui.end();
    }
  }
  void tap(Key key) {
    for (const bool down : {true, false}) {
      input.set_key(key, down);
      frame();
    }
    frame();
  }
  void tap_pad(std::size_t button) {
    for (const bool down : {true, false}) {
      PadState pad{{}, {0.0f, 0.0f, 0.0f, 0.0f, -1.0f, -1.0f}};
      pad.buttons[button] = down;
      input.set_pad(pad);
      frame();
    }
    frame();
  }
  void settle() {
    for (int i = 0; i < 3; ++i) frame();
  }

  static const Pictures& pictures() {
    static const Pictures made;
    return made;
  }

  std::vector<WorldCard> worlds{
      {"/a.skerry", "Home", "1", 990'000, 120'000, -1, ""},
      {"/b.skerry", std::string(64, 'W'), std::string(256, 'x'), 0, 1'500'000'000, 0, ""},
      {"/c.skerry", "Broken", "", 0, 12, -1, "it is damaged beyond reading; restore a copy"}};
  Gui gui;
  ScreenState state;
  ScreenFacts facts;
  Wishes wishes;
  Input input;
  Quality quality = Quality::kMedium;
  bool quality_auto = false;
  Settings settings;
  double fov_deg = 70.0;
  Bindings bindings = default_bindings();
  KnobCosts costs;
  PhotoSettings photo;
  float scale = 1.0f;
  MapFacts map;
  std::vector<PictureCard> gallery{{"/a.png", "skerry-20261125-031500", 0, ""},
                                   {"/b.png", "b", -1, "cannot enter the picture"}};

 private:
  Size size_;
};

/// No column of a table cuts off what is written in it.
void expect_columns_to_hold(ImGuiContext& context, const std::string& where) {
  for (int i = 0; i < context.Tables.GetMapSize(); ++i) {
    const ImGuiTable* table = context.Tables.TryGetMapData(i);
    if (!table || table->LastFrameActive < context.FrameCount - 1) continue;
    for (int c = 0; c < table->ColumnsCount; ++c) {
      const ImGuiTableColumn& column = table->Columns[c];
      EXPECT_LE(column.ContentMaxXUnfrozen, column.WorkMaxX + 0.5f)
          << table->OuterWindow->Name << ", column " << c << ", " << where;
    }
  }
}

void expect_to_fit(Screen screen, Size size, Language language = Language::kEnglish) {
  Sitting sitting(screen, size);
  if (language != Language::kEnglish) {
    sitting.gui.expect(words_of(language));
    sitting.gui.fit_font();
  }
  // The most that is said: by keys, of slow frames, of a world with a long name.
  for (int i = 0; i < 20; ++i) sitting.costs.note_frame(8888.8);
  sitting.facts.world = std::string(64, 'W');
  sitting.settle();
  sitting.tap(Key::kDown);
  sitting.settle();
  ImGuiContext& context = *ImGui::GetCurrentContext();
  const std::string where = std::to_string(static_cast<int>(screen)) + " at " +
                            std::to_string(size.height) + " in " +
                            std::string(kLanguageCodes[static_cast<std::size_t>(language)]);
  bool any = false;
  for (const ImGuiWindow* window : context.Windows) {
    if (!window->Active || window->Flags & ImGuiWindowFlags_Tooltip ||
        std::string_view(window->Name).starts_with("Debug"))
      continue;
    any = true;
    EXPECT_GE(window->Pos.x, 0.0f) << where;
    EXPECT_GE(window->Pos.y, 0.0f) << where;
    EXPECT_LE(window->Pos.x + window->Size.x, static_cast<float>(size.width)) << where;
    EXPECT_LE(window->Pos.y + window->Size.y, static_cast<float>(size.height)) << where;
    // Sideways nothing scrolls, so nothing may be wider than what holds it.
    EXPECT_LE(window->ContentSize.x, window->WorkRect.GetWidth() + 0.5f) << window->Name << where;
    // What has no scrolling part of its own must fit in height as well.
    const bool scrolls = std::string_view(window->Name).find('/') != std::string_view::npos;
    if (!scrolls && size.height >= 720) {
      EXPECT_EQ(window->ScrollMax.y, 0.0f) << window->Name << where;
    }
  }
  EXPECT_TRUE(any) << where;
  expect_columns_to_hold(context, where);
}

TEST(Screens, NothingLeavesItsWindowAtAnySize) {
  for (const Size size : kSizes)
    for (const Screen screen : kScreens) expect_to_fit(screen, size);
}

TEST(Screens, NothingLeavesItsWindowInAnyLanguage) {
  for (std::size_t i = 1; i < kLanguages; ++i) {
    const auto language = static_cast<Language>(i);
    speak(language);
    for (const Screen screen : kScreens)
      for (const Size size : {kSizes[0], kSizes[1]}) expect_to_fit(screen, size, language);
  }
  speak(Language::kEnglish);
}

TEST(Screens, EveryKeyIsNamedWholeInItsButton) {
  for (std::size_t i = 0; i < kLanguages; ++i) {
    const auto language = static_cast<Language>(i);
    speak(language);
    for (const Size size : {Size{640, 360}, {1280, 720}}) {
      Sitting sitting(Screen::kControls, size);
      sitting.gui.expect(words_of(language));
      sitting.gui.fit_font();
      sitting.settle();
      ImGuiContext& context = *ImGui::GetCurrentContext();
      int tables = 0;
      for (int t = 0; t < context.Tables.GetMapSize(); ++t) {
        const ImGuiTable* table = context.Tables.TryGetMapData(t);
        if (!table || table->ColumnsCount != 3) continue;
        ++tables;
        for (std::size_t a = 0; a < kActions; ++a) {
          const Binding& binding = sitting.bindings[static_cast<Action>(a)];
          for (const auto& [chord, column] : {std::pair(binding.key, 1), {binding.pad, 2}}) {
            const float room = table->Columns[column].WorkMaxX - table->Columns[column].WorkMinX -
                               2.0f * context.Style.FramePadding.x;
            const std::string lines = in_lines(chord_label(chord), room);
            EXPECT_LE(ImGui::CalcTextSize(lines.c_str()).x, room + 0.5f)
                << lines << " at " << size.height << " in " << kLanguageCodes[i];
          }
        }
      }
      EXPECT_EQ(tables, 1);
    }
  }
  speak(Language::kEnglish);
}

TEST(Lines, AreBrokenAtSpacesAndAfterPlusSignsAndKeepEveryWord) {
  Gui gui;
  gui.begin({1280, 720, 0.02, nullptr});
  const auto width = [](const char* text) { return ImGui::CalcTextSize(text).x; };
  EXPECT_EQ(in_lines("Back+Left bumper", 1000.0f), "Back+Left bumper");
  EXPECT_EQ(in_lines("Back+Left bumper", width("Back+Left")), "Back+Left\nbumper");
  EXPECT_EQ(in_lines("Back+Left bumper", width("bumper")), "Back+\nLeft\nbumper");
  EXPECT_EQ(in_lines("Back", 1.0f), "Back");
  EXPECT_EQ(in_lines("", 1.0f), "");
  gui.end();
}

TEST(Screens, TheMapAsksForThePlaceThatIsChosen) {
  Sitting sitting(Screen::kMap);
  sitting.state.chosen_place = 2;
  sitting.settle();
  sitting.tap(Key::kEnter);  // the first button
  EXPECT_EQ(sitting.wishes.map.travel, 2u);
  EXPECT_FALSE(sitting.wishes.map.remove);
  sitting.map.places.clear();
  sitting.wishes = {};
  sitting.tap(Key::kEnter);
  EXPECT_FALSE(sitting.wishes.map.travel);
}

TEST(Screens, TheMouseTakesTheMapAlongAndNoFartherThanItsBound) {
  Sitting sitting(Screen::kMap);
  sitting.settle();
  const auto drag = [&](glm::dvec2 from, glm::dvec2 to) {
    sitting.input.move_pointer(from);
    sitting.frame();
    sitting.input.set_key(Key::kMouseLeft, true);
    sitting.frame();
    for (int i = 1; i <= 4; ++i) {
      sitting.input.move_pointer(glm::mix(from, to, i / 4.0));
      sitting.frame();
    }
    sitting.input.set_key(Key::kMouseLeft, false);
    sitting.frame();
  };
  drag({400.0, 400.0}, {340.0, 430.0});  // to the left and down: the view goes east and north
  EXPECT_GT(sitting.state.map_shift.x, 20.0);
  EXPECT_NEAR(sitting.state.map_shift.y, -0.5 * sitting.state.map_shift.x, 1e-3);
  const glm::dvec2 before = sitting.state.map_shift;
  drag({1000.0, 400.0}, {900.0, 400.0});  // beside the map
  EXPECT_EQ(sitting.state.map_shift, before);
  shift_map(sitting.state, {1e9, -1e9});
  EXPECT_EQ(sitting.state.map_shift, glm::dvec2(kMostMapShift, -kMostMapShift));
}

TEST(Screens, TheGalleryEntersThePictureThatIsChosenUnlessItLeadsNowhere) {
  Sitting sitting(Screen::kGallery);
  sitting.settle();
  sitting.tap(Key::kEnter);
  EXPECT_EQ(sitting.wishes.enter, "/a.png");
  Sitting other(Screen::kGallery);
  other.state.chosen_picture = 1;
  other.settle();
  other.tap(Key::kEnter);
  EXPECT_FALSE(other.wishes.enter);
}

TEST(Screens, EverythingGrowsWithItsScale) {
  const auto height = [](float scale) {
    Sitting sitting(Screen::kPause);
    sitting.scale = scale;
    sitting.settle();
    const ImGuiWindow* pause = ImGui::FindWindowByName("pause");
    return pause ? pause->Size.y : 0.0f;
  };
  EXPECT_NEAR(height(1.25f), 1.25f * height(1.0f), 2.0f);
  EXPECT_NEAR(height(0.75f), 0.75f * height(1.0f), 2.0f);
}

TEST(Screens, TextIsNeverSmallerThanItReads) {
  for (const Size size : kSizes) {
    Sitting sitting(Screen::kSettings, size);
    sitting.settle();
    EXPECT_GE(ImGui::GetIO().FontDefault->FontSize, 12.0f);
    EXPECT_NEAR(ImGui::GetIO().FontDefault->FontSize, std::max(12.0, 18.0 * size.height / 720.0),
                4.0);
  }
}

TEST(Screens, SurviveAWindowOfOnePixel) {
  for (const Screen screen : kScreens) {
    Sitting sitting(screen, {1, 1});
    sitting.settle();
  }
}

TEST(Screens, AreAllReachedAndLeftWithTheKeyboardAlone) {
  Sitting sitting(Screen::kTitle);
  sitting.settle();
  sitting.tap(Key::kEnter);  // the first button has the focus
  EXPECT_EQ(sitting.state.stack.top(), Screen::kWorlds);
  sitting.tap(Key::kEscape);
  EXPECT_EQ(sitting.state.stack.top(), Screen::kTitle);
  sitting.tap(Key::kEscape);  // no further
  EXPECT_EQ(sitting.state.stack.top(), Screen::kTitle);
  sitting.tap(Key::kDown);
  sitting.tap(Key::kDown);
  sitting.tap(Key::kEnter);
  EXPECT_EQ(sitting.state.stack.top(), Screen::kSettings);
}

TEST(Screens, AreAllReachedAndLeftWithAGamepadAlone) {
  constexpr std::size_t kA = 0, kB = 1, kDown = 13;
  Sitting sitting(Screen::kTitle);
  sitting.settle();
  sitting.tap_pad(kA);
  EXPECT_EQ(sitting.state.stack.top(), Screen::kWorlds);
  sitting.tap_pad(kB);
  EXPECT_EQ(sitting.state.stack.top(), Screen::kTitle);
  for (int i = 0; i < 3; ++i) sitting.tap_pad(kDown);
  sitting.tap_pad(kA);
  EXPECT_EQ(sitting.state.stack.top(), Screen::kControls);
}

TEST(Screens, EnterOnTheWorldListPlaysTheLatest) {
  Sitting sitting(Screen::kWorlds);
  sitting.settle();
  for (int i = 0; i < 12 && !sitting.wishes.play; ++i) {
    sitting.tap(Key::kEnter);
    if (!sitting.wishes.play) sitting.tap(Key::kDown);
  }
  EXPECT_EQ(sitting.wishes.play, "/a.skerry");
}

/// On a slow machine a frame brings all that was pressed in seconds.
TEST(Screens, KeysThatComeInOneFrameAllCount) {
  const auto typed = [](Sitting& sitting, std::initializer_list<Key> keys, bool loads = false) {
    sitting.settle();
    for (const Key key : keys)
      for (const bool down : {true, false}) sitting.input.set_key(key, down);
    for (int i = 0; i < 40; ++i) {
      sitting.frame();
      if (loads && i < 3) sitting.load();
    }
  };
  Sitting lists(Screen::kTitle);  // the list of worlds, and there the latest
  typed(lists, {Key::kEnter, Key::kEnter});
  EXPECT_EQ(lists.wishes.play, "/a.skerry");
  Sitting waits(Screen::kTitle);  // while the island behind the title is loaded
  typed(waits, {Key::kEnter, Key::kEnter}, true);
  EXPECT_EQ(waits.wishes.play, "/a.skerry");
  // There is no world yet: the screen for a new one, and Enter there.
  Sitting makes(Screen::kTitle);
  makes.facts.worlds = {};
  typed(makes, {Key::kEnter, Key::kEnter});
  EXPECT_TRUE(makes.wishes.create);
  // In the fields of a new world: what follows Tab goes to the next one, two presses on.
  Sitting names(Screen::kNewWorld);
  names.settle();
  for (int i = 0; i < 2; ++i) {
    for (const bool down : {true, false}) names.input.set_key(Key::kTab, down);
    names.input.type(U'7');
  }
  for (int i = 0; i < 40; ++i) names.frame();
  EXPECT_EQ(std::string(names.state.new_seed.data()), "7");
  Sitting walks(Screen::kTitle);
  typed(walks, {Key::kDown, Key::kDown, Key::kEnter});
  EXPECT_EQ(walks.state.stack.top(), Screen::kSettings);
}

TEST(Screens, KeysChooseWorldsOnTheWay) {
  Sitting sitting(Screen::kWorlds);
  sitting.settle();
  EXPECT_EQ(sitting.state.chosen_world, "/a.skerry");
  for (int i = 0; i < 4 && sitting.state.chosen_world != "/b.skerry"; ++i) sitting.tap(Key::kUp);
  EXPECT_EQ(sitting.state.chosen_world, "/b.skerry");
  sitting.tap(Key::kEnter);
  EXPECT_EQ(sitting.wishes.play, "/b.skerry");
}

TEST(Screens, TheFirstWorldChosenIsOneThatCanBePlayed) {
  Sitting sitting(Screen::kWorlds);
  std::swap(sitting.worlds[0], sitting.worlds[2]);
  sitting.settle();
  EXPECT_EQ(sitting.state.chosen_world, "/b.skerry");
}

TEST(Screens, KnobsTurnByArrowsAloneFromTheFirstOnDown) {
  Sitting sitting(Screen::kSettings);
  sitting.settle();
  sitting.tap(Key::kRight);
  EXPECT_EQ(sitting.quality, Quality::kHigh);
  sitting.tap(Key::kLeft);
  sitting.tap(Key::kLeft);
  EXPECT_EQ(sitting.quality, Quality::kLow);
  sitting.tap(Key::kLeft);
  EXPECT_TRUE(sitting.quality_auto);
  sitting.tap(Key::kRight);
  EXPECT_FALSE(sitting.quality_auto);
  sitting.tap(Key::kRight);
  EXPECT_EQ(sitting.quality, Quality::kMedium);
  const Settings before = sitting.settings;
  for (int row = 1; row < 29; ++row) {
    sitting.tap(Key::kDown);
    sitting.tap(Key::kLeft);
    EXPECT_FALSE(sitting.gui.typing()) << row;
  }
  EXPECT_LT(sitting.settings.view_distance, before.view_distance);
  EXPECT_LT(sitting.settings.render.render_scale, before.render.render_scale);
  EXPECT_LT(sitting.settings.render.shadow_size, before.render.shadow_size);
  EXPECT_LT(sitting.settings.render.water_layers, before.render.water_layers);
  EXPECT_LT(sitting.fov_deg, 70.0);
  EXPECT_LT(sitting.settings.ui.scale, before.ui.scale);
  EXPECT_LT(sitting.settings.sound.master, before.sound.master);
  EXPECT_LT(sitting.settings.sound.interface, before.sound.interface);
  EXPECT_LT(sitting.settings.render.display.peak, before.render.display.peak);
  EXPECT_TRUE(sitting.wishes.settings_changed);
  EXPECT_EQ(sitting.state.stack.top(), Screen::kSettings);
}

TEST(Screens, EscapeLeavesAFieldAndItsScreenAtOnce) {
  Sitting sitting(Screen::kTitle);
  sitting.state.stack.open(Screen::kNewWorld);
  sitting.settle();
  EXPECT_TRUE(sitting.gui.typing());
  sitting.tap(Key::kEscape);
  EXPECT_EQ(sitting.state.stack.top(), Screen::kTitle);
}

/// Relative luminance of WCAG 2.
double luminance(const ImVec4& colour) {
  const auto linear = [](float v) {
    return v <= 0.04045f ? double{v} / 12.92 : std::pow((double{v} + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.x) + 0.7152 * linear(colour.y) + 0.0722 * linear(colour.z);
}

TEST(Screens, ASlidersValueReadsOnItsHandle) {
  Sitting sitting(Screen::kSettings);
  sitting.settle();
  const auto* colours = ImGui::GetStyle().Colors;
  for (const ImGuiCol handle : {ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive}) {
    ASSERT_EQ(colours[handle].w, 1.0f);
    const double ratio =
        (luminance(colours[ImGuiCol_Text]) + 0.05) / (luminance(colours[handle]) + 0.05);
    EXPECT_GE(ratio, 4.5);  // WCAG 2, AA
  }
}

TEST(Screens, AWorldIsDeletedOnlyAfterASecondQuestion) {
  Sitting sitting(Screen::kWorlds);
  sitting.settle();
  sitting.state.asks_to_delete = true;
  sitting.settle();
  sitting.tap(Key::kEnter);  // "Keep it" has the focus
  EXPECT_FALSE(sitting.wishes.remove);
  sitting.state.asks_to_delete = true;
  sitting.settle();
  sitting.tap(Key::kEscape);  // closes the question, not the list
  EXPECT_FALSE(sitting.wishes.remove);
  EXPECT_EQ(sitting.state.stack.top(), Screen::kWorlds);
  sitting.state.asks_to_delete = true;
  sitting.settle();
  sitting.tap(Key::kRight);
  sitting.tap(Key::kEnter);
  EXPECT_EQ(sitting.wishes.remove, "/a.skerry");
}

/// A field with the focus, and what a person types into it in frames of their own choice.
class Typing {
 public:
  explicit Typing(std::string in_clipboard = {})
      : clipboard(std::move(in_clipboard)),
        gui({[this] { return clipboard; }, [this](const std::string& text) { clipboard = text; }}) {
    for (int i = 0; i < 3; ++i) frame();
  }
  void frame() {
    const platform::InputFrame taken = input.take();
    gui.begin({640, 360, 0.05, &taken});
    ImGui::Begin("seed");
    if (!shown_) ImGui::SetKeyboardFocusHere();
    shown_ = true;
    text_field("##seed", field);
    ImGui::End();
    gui.end();
  }
  void chord(Key with, Key key) {
    input.set_key(with, true);
    input.set_key(key, true);
    input.set_key(key, false);
    input.set_key(with, false);
  }
  void type(std::string_view text) {
    for (const char c : text) {
      const Key key = platform::key_named(std::string(1, c)).value_or(Key::kNone);
      if (key != Key::kNone) input.set_key(key, true);
      input.type(static_cast<char32_t>(c));
      if (key != Key::kNone) input.set_key(key, false);
    }
  }
  void tap(Key key) {
    for (const bool down : {true, false}) input.set_key(key, down);
  }

  std::string clipboard;
  Gui gui;
  Field<kMaxSeedBytes> field{};
  Input input;

 private:
  bool shown_ = false;
};

TEST(Typing, AMegabyteOfPastedTextIsRefusedInOneLine) {
  Typing typing(std::string(1 << 20, 'a'));
  typing.type("sea");
  typing.chord(Key::kControl, Key::kV);
  for (int i = 0; i < 9; ++i) typing.frame();
  EXPECT_STREQ(typing.field.data(), "sea");
  EXPECT_NE(typing.gui.take_refusal().find("1048576 bytes"), std::string::npos);
  EXPECT_EQ(typing.gui.take_refusal(), "");
  typing.clipboard = std::string(kMaxSeedBytes - 3, 'b');  // just fits
  typing.chord(Key::kControl, Key::kV);
  for (int i = 0; i < 9; ++i) typing.frame();
  EXPECT_EQ(std::string(typing.field.data()), "sea" + typing.clipboard);
  EXPECT_EQ(typing.gui.take_refusal(), "");
}

TEST(Typing, ChordsShorterThanAFrameKeepTheirOrder) {
  Typing typing("b");
  // All within one frame: a word, all of it chosen and cut, pasted behind another letter.
  typing.type("harbour");
  typing.chord(Key::kControl, Key::kA);
  typing.chord(Key::kControl, Key::kX);
  typing.type("x");
  typing.tap(Key::kBackspace);
  typing.type("old ");
  typing.chord(Key::kControl, Key::kV);
  typing.tap(Key::kHome);
  typing.type("my ");
  for (int i = 0; i < 40; ++i) typing.frame();
  EXPECT_STREQ(typing.field.data(), "my old harbour");
}

TEST(Typing, AKeyThatIsHeldBackIsUp) {
  Gui gui;
  Input input;
  platform::HeldBack held;
  const auto down_after_frame = [&] {
    const platform::InputFrame frame = held.filtered(input.take());
    gui.begin({640, 360, 0.05, &frame});
    const bool down = ImGui::IsKeyDown(ImGui::GetKeyIndex(ImGuiKey_LeftArrow));
    gui.end();
    return down;
  };
  input.set_key(Key::kLeft, true);
  const platform::InputFrame opening = input.take();
  gui.begin({640, 360, 0.05, &opening});
  gui.end();
  // The event that it went up is kept back with it.
  held.hold(opening);
  EXPECT_FALSE(down_after_frame());
  input.set_key(Key::kLeft, false);
  EXPECT_FALSE(down_after_frame());
  input.set_key(Key::kLeft, true);
  EXPECT_TRUE(down_after_frame());
  EXPECT_TRUE(down_after_frame());
  input.set_key(Key::kLeft, false);
  EXPECT_FALSE(down_after_frame());
}

TEST(NewWorld, IsNotMadeByTheEnterThatOpenedIt) {
  Sitting sitting(Screen::kTitle);
  sitting.facts.worlds = {};
  sitting.settle();
  sitting.input.set_key(Key::kEnter, true);
  // Held for longer than ImGui's delay before a key repeats.
  for (int i = 0; i < 20; ++i) sitting.frame();
  EXPECT_EQ(sitting.state.stack.top(), Screen::kNewWorld);
  EXPECT_FALSE(sitting.wishes.create);
  sitting.input.set_key(Key::kEnter, false);
  sitting.frame();
  sitting.tap(Key::kEnter);
  EXPECT_TRUE(sitting.wishes.create);
}

TEST(PastedText, IsCutBetweenCharactersAndAtTheFirstLine) {
  EXPECT_EQ(pasted_text("one\ntwo", 100), "one");
  EXPECT_EQ(pasted_text(std::string_view("a\0b", 3), 100), "a");
  EXPECT_EQ(pasted_text("a\xe2\x82\xac", 3), "a");
  EXPECT_EQ(pasted_text("a\xe2\x82\xac", 4), "a\xe2\x82\xac");
  EXPECT_EQ(pasted_text("\x80\x80\x80", 2), "");
}

TEST(Controls, AKeyIsBoundWithItsChordAndConflictsAreShown) {
  Sitting sitting(Screen::kControls);
  sitting.settle();
  sitting.state.listening = ScreenState::Listening{Action::kJump, false};
  sitting.input.set_key(Key::kControl, true);
  sitting.frame();
  EXPECT_TRUE(sitting.state.listening);  // Ctrl alone may begin a chord
  sitting.input.set_key(Key::kJ, true);
  sitting.frame();
  EXPECT_EQ(sitting.bindings[Action::kJump].key, (Chord{Key::kJ, true}));
  EXPECT_TRUE(sitting.wishes.bindings_changed);
}

TEST(Controls, CtrlAloneEscapeAndDeleteMeanWhatTheySay) {
  Sitting sitting(Screen::kControls);
  sitting.settle();
  const auto listen = [&](bool pad) { sitting.state.listening = {Action::kJump, pad}; };
  listen(false);
  sitting.tap(Key::kControl);
  EXPECT_EQ(sitting.bindings[Action::kJump].key, Chord{Key::kControl});
  listen(false);
  sitting.tap(Key::kEscape);  // keeps it, and the screen stays
  EXPECT_EQ(sitting.bindings[Action::kJump].key, Chord{Key::kControl});
  EXPECT_EQ(sitting.state.stack.top(), Screen::kControls);
  listen(false);
  sitting.tap(Key::kDelete);
  EXPECT_EQ(sitting.bindings[Action::kJump].key, Chord{});
  listen(true);
  sitting.tap(Key::kW);  // no gamepad's
  EXPECT_TRUE(sitting.state.listening);
  sitting.tap_pad(2);
  EXPECT_EQ(sitting.bindings[Action::kJump].pad, Chord{Key::kPadX});
}

TEST(Controls, AGamepadsBAndChordsCanBeBound) {
  constexpr std::size_t kB = 1, kX = 2, kBack = 6;
  Sitting sitting(Screen::kControls);
  sitting.settle();
  const auto listen = [&] { sitting.state.listening = {Action::kJump, true}; };
  const auto& bound = sitting.bindings[Action::kJump].pad;
  listen();
  sitting.tap_pad(kB);
  EXPECT_EQ(bound, Chord{Key::kPadB});
  EXPECT_EQ(sitting.state.stack.top(), Screen::kControls);
  listen();
  sitting.tap_pad(kBack);
  EXPECT_EQ(bound, Chord{Key::kPadBack});
  listen();
  PadState pad{{}, {0.0f, 0.0f, 0.0f, 0.0f, -1.0f, -1.0f}};
  for (const std::size_t button : {kBack, kX}) {
    pad.buttons.set(button);
    sitting.input.set_pad(pad);
    sitting.frame();
  }
  EXPECT_EQ(bound, (Chord{Key::kPadX, true}));
  listen();
  sitting.tap(Key::kEscape);
  EXPECT_FALSE(sitting.state.listening);
  EXPECT_EQ(bound, (Chord{Key::kPadX, true}));
}

TEST(Pause, SaysThatSavingFailedAndLeavesAnywayOnlyIfTold) {
  for (const bool failed : {false, true}) {
    Sitting sitting(Screen::kPause);
    if (failed) sitting.state.unsaved = "cannot save the world '/a': the disk is full; make room";
    sitting.settle();
    for (int i = 0; i < 8; ++i) sitting.tap(Key::kDown);  // past the eight that are always there
    sitting.tap(Key::kEnter);
    EXPECT_EQ(sitting.wishes.leave_unsaved, failed);
  }
}

TEST(NewWorld, HasANameAndASeedWithoutAKeyboard) {
  constexpr std::size_t kA = 0, kDown = 13;
  Sitting sitting(Screen::kNewWorld);
  sitting.tap_pad(14);  // plugged in
  sitting.settle();
  sitting.tap_pad(kDown);
  sitting.tap_pad(kA);
  EXPECT_TRUE(sitting.wishes.draw_name);
  for (int i = 0; i < 2; ++i) sitting.tap_pad(kDown);  // over the seed's field
  sitting.tap_pad(kA);
  EXPECT_TRUE(sitting.wishes.draw_lots);
  sitting.tap_pad(kDown);
  sitting.tap_pad(kA);
  EXPECT_TRUE(sitting.wishes.create);
}

TEST(NewWorld, IsNamedWithAGamepadsLetters) {
  constexpr std::size_t kA = 0, kRight = 12, kDown = 13, kUp = 11;
  Sitting sitting(Screen::kNewWorld);
  sitting.tap_pad(14);  // plugged in
  sitting.settle();
  for (int i = 0; i < 4; ++i) sitting.tap_pad(kDown);  // over the seed's field, to Create
  sitting.tap_pad(kDown);                              // the digits
  sitting.tap_pad(kDown);                              // the letters
  const std::size_t before = std::string_view(sitting.state.new_seed.data()).size();
  sitting.tap_pad(kA);
  sitting.tap_pad(kRight);
  sitting.tap_pad(kA);
  const std::string seed = sitting.state.new_seed.data();
  ASSERT_EQ(seed.size(), before + 2);  // the seed's field had the focus last
  const std::string_view row = "qwertyuiop";
  const std::size_t first = row.find(seed[before]);
  ASSERT_NE(first, std::string_view::npos) << seed;
  EXPECT_EQ(seed[before + 1], row[first + 1]);
  EXPECT_TRUE(sitting.wishes.preview);
  EXPECT_STREQ(sitting.state.new_name.data(), "");
  sitting.tap_pad(kUp);
  EXPECT_FALSE(sitting.wishes.create);
}

TEST(LetterButtons, KeepToTheirRoomAndDeleteWholeCharacters) {
  Gui gui;
  Field<6> text{};
  set_field(text, "ab\xe2\x82\xac");
  bool upper = false;
  Input input;
  const auto frame = [&] {
    const platform::InputFrame taken = input.take();
    gui.begin({1280, 720, 0.05, &taken});
    begin_panel("letters", Place::kMiddle, 440, 300);
    letter_buttons(text, upper);
    end_panel();
    gui.end();
  };
  const auto tap = [&](Key key) {
    for (const bool down : {true, false}) {
      input.set_key(key, down);
      frame();
    }
    frame();
  };
  frame();
  tap(Key::kDown);  // from the first button to the one below
  tap(Key::kSpace);
  tap(Key::kSpace);  // no room any more
  EXPECT_STREQ(text.data(), "ab\xe2\x82\xacq");
  for (int i = 0; i < 8; ++i) tap(Key::kDown);
  for (int i = 0; i < 4; ++i) tap(Key::kRight);
  tap(Key::kSpace);
  EXPECT_STREQ(text.data(), "ab\xe2\x82\xac");
  tap(Key::kSpace);
  EXPECT_STREQ(text.data(), "ab");
}

TEST(Palette, FindsBlocksByAllWordsInAnyCase) {
  EXPECT_EQ(find_blocks("").size(), std::size_t{world::block::kBuiltInCount} - 1);
  EXPECT_EQ(find_blocks("TORCH"), std::vector<world::BlockId>{world::block::kTorch});
  for (const world::BlockId block : find_blocks("leaves oak"))
    EXPECT_EQ(block, world::block::kOakLeaves);
  EXPECT_TRUE(find_blocks("no such thing").empty());
}

TEST(Palette, FindsBlocksInThePlayersLanguageAndInEnglish) {
  using world::block::kBlossomLeaves, world::block::kMud, world::block::kIce;
  const std::tuple<Language, const char*, world::BlockId> searches[] = {
      {Language::kGerman, "SCHLAMM", kMud},
      {Language::kGerman, "BLÜTEN", kBlossomLeaves},
      {Language::kRussian, "ЛЁД", kIce},
      {Language::kJapanese, "花の", kBlossomLeaves},
      {Language::kFrench, "BLOSSOM", kBlossomLeaves}};
  for (const auto& [language, typed, block] : searches) {
    speak(language);
    EXPECT_EQ(find_blocks(typed), std::vector<world::BlockId>{block}) << typed;
  }
  // Two blocks that look alike in a list could not be told apart.
  for (std::size_t i = 0; i < kLanguages; ++i) {
    speak(static_cast<Language>(i));
    std::set<std::string> labels;
    for (world::BlockId block = 0; block < world::block::kBuiltInCount; ++block)
      EXPECT_TRUE(labels.insert(block_label(block)).second) << block_label(block);
  }
  speak(Language::kEnglish);
}

TEST(Palette, EnterTakesTheFirstThatWasFound) {
  Sitting sitting(Screen::kPalette);
  sitting.settle();
  for (const char32_t c : U"lamp")
    if (c) sitting.input.type(c);
  sitting.frame();
  sitting.tap(Key::kEnter);
  EXPECT_EQ(sitting.wishes.take, world::block::kLamp);
  EXPECT_TRUE(sitting.state.stack.empty());
}

TEST(Ago, SaysItInTheLargestUnit) {
  EXPECT_EQ(ago(-5), "just now");
  EXPECT_EQ(ago(59), "just now");
  EXPECT_EQ(ago(60), "1 minute ago");
  EXPECT_EQ(ago(7200), "2 hours ago");
  EXPECT_EQ(ago(86400 * 3), "3 days ago");
  EXPECT_EQ(ago(86400 * 90), "3 months ago");
}

TEST(ScreenStack, GoesBackToWhereOneCameFrom) {
  ScreenStack stack;
  stack.open(Screen::kPause);
  stack.open(Screen::kSettings);
  stack.back();
  EXPECT_EQ(stack.top(), Screen::kPause);
  stack.open(Screen::kControls);
  stack.open(Screen::kPause);  // open already: what lay over it closes
  EXPECT_EQ(stack.size(), 1u);
  stack.back();
  EXPECT_TRUE(stack.empty());
  stack.back();
  EXPECT_TRUE(stack.empty());
}

TEST(KnobCosts, AreTheDifferenceOfMediansAfterWhatWasOnItsWay) {
  KnobCosts costs;
  costs.turned(Knob::kShadows);
  EXPECT_FALSE(costs.cost(Knob::kShadows));
  KnobCosts steady;
  for (int i = 0; i < 20; ++i) steady.note_frame(i % 5 == 0 ? 90.0 : 10.0);  // hitches do not count
  EXPECT_EQ(steady.now_ms(), 10.0);
  steady.turned(Knob::kShadows);
  EXPECT_TRUE(steady.measuring(Knob::kShadows));
  for (std::size_t i = 0; i < KnobCosts::kSkipped; ++i) steady.note_frame(10.0);
  for (std::size_t i = 0; i < KnobCosts::kFrames; ++i) {
    EXPECT_FALSE(steady.cost(Knob::kShadows));
    steady.note_frame(13.5);
  }
  ASSERT_TRUE(steady.cost(Knob::kShadows));
  EXPECT_EQ(steady.cost(Knob::kShadows)->ms, 3.5);
  EXPECT_TRUE(steady.cost(Knob::kShadows)->certain());
  EXPECT_FALSE(steady.cost(Knob::kBloom));
  EXPECT_FALSE(steady.measuring(Knob::kShadows));
}

TEST(KnobCosts, ADifferenceWithinTheSpreadIsNotCertain) {
  KnobCosts costs;
  const auto frames = [&](double ms) {
    for (int i = 0; i < 18; ++i) costs.note_frame(ms + 4.0 * (i % 3));  // 0, 4 or 8 ms more
  };
  frames(100.0);
  costs.turned(Knob::kViewDistance);
  frames(103.6);
  ASSERT_TRUE(costs.cost(Knob::kViewDistance));
  EXPECT_FALSE(costs.cost(Knob::kViewDistance)->certain()) << costs.cost(Knob::kViewDistance)->ms;
  costs.turned(Knob::kViewDistance);
  frames(150.0);
  EXPECT_TRUE(costs.cost(Knob::kViewDistance)->certain());
  costs.turned(Knob::kBloom);
  frames(150.0);  // no difference at all
  EXPECT_FALSE(costs.cost(Knob::kBloom)->certain());
}

TEST(KnobCosts, ASliderDraggedThroughManyPlacesCountsFromItsFirst) {
  KnobCosts costs;
  for (int i = 0; i < 9; ++i) costs.note_frame(10.0);
  for (int i = 0; i < 8; ++i) {
    costs.turned(Knob::kViewDistance);
    costs.note_frame(11.0 + i);
  }
  for (int i = 0; i < 20; ++i) costs.note_frame(20.0);
  ASSERT_TRUE(costs.cost(Knob::kViewDistance));
  EXPECT_EQ(costs.cost(Knob::kViewDistance)->ms, 10.0);
}

TEST(KnobCosts, WaitsUntilAllIsInView) {
  KnobCosts costs;
  for (int i = 0; i < 9; ++i) costs.note_frame(10.0);
  costs.turned(Knob::kViewDistance);
  for (int i = 0; i < 40; ++i) costs.note_frame(12.0, false);
  EXPECT_TRUE(costs.measuring());
  EXPECT_FALSE(costs.cost(Knob::kViewDistance));
  for (std::size_t i = 0; i < KnobCosts::kSkipped + KnobCosts::kFrames; ++i) costs.note_frame(17.0);
  ASSERT_TRUE(costs.cost(Knob::kViewDistance));
  EXPECT_EQ(costs.cost(Knob::kViewDistance)->ms, 7.0);
}

TEST(Thumbnails, KeepColoursAndCutToTheMiddle) {
  // Left and right edges are red, what is in the middle is green: 16:9 of a 4:1 picture is middle.
  constexpr int kWidth = 800, kHeight = 200;
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool middle = x >= 200 && x < 600;
      pixels.insert(pixels.end(), {static_cast<std::uint8_t>(middle ? 0 : 255),
                                   static_cast<std::uint8_t>(middle ? 255 : 0), 0, 255});
    }
  const Rgba small = thumbnail_of(kWidth, kHeight, pixels);
  ASSERT_EQ(small.pixels.size(), std::size_t{kThumbnailWidth} * kThumbnailHeight * 4);
  for (std::size_t i = 0; i < small.pixels.size(); i += 4) ASSERT_EQ(small.pixels[i + 1], 255) << i;
  EXPECT_TRUE(thumbnail_of(0, 0, {}).pixels.empty());
  EXPECT_EQ(thumbnail_of(1, 1, std::vector<std::uint8_t>{1, 2, 3, 4}).pixels[1], 2);
}

TEST(Pictures, EveryBlockHasOneThatShowsSomething) {
  for (world::BlockId block = 1; block < world::block::kBuiltInCount; ++block) {
    const Rgba picture = block_picture(block);
    std::size_t seen = 0;
    for (std::size_t i = 3; i < picture.pixels.size(); i += 4) seen += picture.pixels[i] > 32;
    EXPECT_GT(seen, 100u) << world::block_types()[block].name;
  }
}

}  // namespace
}  // namespace skerry::game::ui
