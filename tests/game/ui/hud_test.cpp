#include "game/ui/hud.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/output.h"
#include "game/ui/gui.h"
#include "game/ui/loading_screen.h"
#include "game/ui/look.h"
#include "game/words/words.h"
#include "tests/folder.h"

namespace skerry::game::ui {
namespace {

TEST(Hud, BearingsFollowTheConventions) {
  EXPECT_EQ(bearing_deg(0.0), 180.0);  // yaw 0 looks along +z, south
  EXPECT_EQ(bearing_deg(90.0), 90.0);  // 90 along +x, east
  EXPECT_EQ(bearing_deg(180.0), 0.0);
  EXPECT_EQ(bearing_deg(-90.0), 270.0);
}

TEST(Hud, DrawsWithinThePicture) {
  const Pictures pictures;
  const std::vector<world::BlockId> blocks(9, world::block::kTorch);
  HudFacts facts;
  facts.hotbar = blocks;
  facts.place = "1099511627776  -1099511627776  1099511627776";
  facts.steering = HudFacts::Steering{"Skarholm", 3.5};
  Messages messages;
  messages.say("The disk is full: nothing more of this world is saved until there is room again");
  for (const auto& [width, height] : {std::pair(640u, 360u), {1280u, 720u}, {2560u, 1440u}}) {
    Gui gui;
    gui.begin({width, height, 0.02, nullptr});
    show_hud(facts, pictures);
    show_messages(messages, false);
    const OverlayTriangles triangles = gui.end();
    ASSERT_GT(triangles.vertices.size(), 100u);
    bool pictured = false;
    for (const shared::OverlayVertex& vertex : triangles.vertices) {
      ASSERT_LT(vertex.clip & ~shared::kOverlayPicture, triangles.clips.size());
      pictured |= (vertex.clip & shared::kOverlayPicture) != 0;
      ASSERT_TRUE(vertex.position.x >= -2.0f &&
                  vertex.position.x <= static_cast<float>(width) + 2.0f);
      ASSERT_TRUE(vertex.position.y >= -2.0f &&
                  vertex.position.y <= static_cast<float>(height) + 2.0f);
    }
    EXPECT_TRUE(pictured);
  }
}

TEST(LoadingScreen, FitsInEveryLanguageAndShowsHowFarItIs) {
  for (std::size_t i = 0; i < kLanguages; ++i) {
    const auto language = static_cast<Language>(i);
    speak(language);
    for (const auto& size : {std::pair(640u, 360u), {320u, 180u}, {1280u, 720u}}) {
      const auto width = size.first, height = size.second;
      Gui gui;
      gui.expect(words_of(language));
      gui.fit_font();
      const auto bar = [&](const LoadingFacts& facts) {
        gui.begin({width, height, 0.02, nullptr});
        show_loading(facts);
        float right = 0.0f;
        for (const shared::OverlayVertex& vertex : gui.end().vertices) {
          EXPECT_TRUE(vertex.position.x >= -2.0f && vertex.position.y >= -2.0f &&
                      vertex.position.x <= static_cast<float>(width) + 2.0f &&
                      vertex.position.y <= static_cast<float>(height) + 2.0f);
          if (vertex.color == colour::kAccent) right = std::max(right, vertex.position.x);
        }
        return right;
      };
      EXPECT_LT(bar({3, 42, 0, 1.0}), bar({41, 42, 0, 2.0}));
      EXPECT_LE(bar({41, 42, 0, 2.0}), bar({42, 42, 7, 3.0}));
    }
  }
  speak(Language::kEnglish);
}

/// Where a HUD draws in one colour: lowest and highest x and y; nothing: infinities.
struct Extent {
  float left = 1e9f, top = 1e9f, right = -1e9f, bottom = -1e9f;
};
Extent drawn_in(const OverlayTriangles& triangles, ImU32 colour) {
  Extent e;
  for (const shared::OverlayVertex& vertex : triangles.vertices) {
    if (vertex.color != colour) continue;
    e.left = std::min(e.left, vertex.position.x);
    e.right = std::max(e.right, vertex.position.x);
    e.top = std::min(e.top, vertex.position.y);
    e.bottom = std::max(e.bottom, vertex.position.y);
  }
  return e;
}

TEST(Hud, ATorchInTheHandIsSeenAndKeepsClearOfTheHotbar) {
  const Pictures pictures;
  ASSERT_GT(pictures.torch().size(), 10u);
  for (const bool torch : {false, true}) {
    Gui gui;
    gui.begin({1280, 720, 0.02, nullptr});
    HudFacts facts;
    facts.torch = torch;
    show_hud(facts, pictures);
    const OverlayTriangles triangles = gui.end();
    const Extent seen = drawn_in(triangles, pictures.torch().back().colour);
    EXPECT_EQ(seen.right > seen.left, torch);
    if (!torch) continue;
    EXPECT_GT(seen.left, 900.0f);  // the hotbar ends at 892
    EXPECT_LT(seen.right, 1280.0f);
    EXPECT_GT(seen.top, 360.0f);  // the upper half stays to look at
  }
}

TEST(Hud, TheHelmSaysWhetherItsIslandMoves) {
  const Pictures pictures;
  for (const bool held : {false, true}) {
    Gui gui;
    gui.begin({1280, 720, 0.02, nullptr});
    HudFacts facts;
    facts.steering = HudFacts::Steering{"Skarholm", 0.0, held};
    show_hud(facts, pictures);
    const OverlayTriangles triangles = gui.end();
    const Extent words = drawn_in(triangles, held ? colour::kWarning : colour::kAccent);
    const Extent glass = drawn_in(triangles, IM_COL32(8, 14, 18, 190));
    ASSERT_GT(words.right, words.left);
    // Words on glass of their own read over sky and grass.
    EXPECT_LT(glass.left, 640.0f - 100.0f);
    EXPECT_GT(glass.right, 640.0f + 100.0f);
    EXPECT_LT(glass.top, 50.0f);
    EXPECT_EQ(drawn_in(triangles, colour::kWarning).right > 0.0f, held);
  }
}

/// Vertices of what marks of places are drawn with.
std::vector<glm::vec2> mark_at(PlaceKind kind, double bearing) {
  static const Pictures pictures;
  const auto drawn = [&](bool with) {
    Gui gui;
    gui.begin({1280, 720, 0.02, nullptr});
    HudFacts facts;
    facts.yaw_deg = 180.0;  // north
    facts.choosing = true;  // no name
    facts.numbers = true;   // nothing after the marks
    if (with) facts.marks = {{kind, "Here", bearing, 100.0}};
    show_hud(facts, pictures);
    return gui.end();
  };
  const OverlayTriangles without = drawn(false), with = drawn(true);
  // The HUD is the same up to where marks begin.
  std::vector<glm::vec2> out;
  for (std::size_t i = without.vertices.size(); i < with.vertices.size(); ++i)
    out.push_back(with.vertices[i].position);
  return out;
}

TEST(Hud, PlacesAreMarkedWhereTheyAre) {
  const auto middle = [](const std::vector<glm::vec2>& vertices) {
    float left = 1e9f, right = -1e9f;
    for (const glm::vec2& v : vertices) {
      left = std::min(left, v.x);
      right = std::max(right, v.x);
    }
    return 0.5f * (left + right);
  };
  for (const PlaceKind kind : {PlaceKind::kHome, PlaceKind::kGround, PlaceKind::kWaypoint}) {
    ASSERT_FALSE(mark_at(kind, 0.0).empty());
    EXPECT_NEAR(middle(mark_at(kind, 0.0)), 640.0f, 1.0f);
    EXPECT_NEAR(middle(mark_at(kind, 30.0)), 640.0f + 0.5f * 0.94f * 190.0f, 1.0f);
    EXPECT_NEAR(middle(mark_at(kind, 345.0)), 640.0f - 0.25f * 0.94f * 190.0f, 1.0f);
    EXPECT_TRUE(mark_at(kind, 90.0).empty());
    EXPECT_TRUE(mark_at(kind, 180.0).empty());
  }
}

/// Where colours cannot be told apart, shapes can.
TEST(Hud, MarksOfPlacesDifferInShape) {
  const auto shape = [](PlaceKind kind) {
    std::set<std::pair<int, int>> cells;
    for (const glm::vec2& v : mark_at(kind, 0.0))
      cells.emplace(static_cast<int>(v.x), static_cast<int>(v.y));
    return cells;
  };
  EXPECT_NE(shape(PlaceKind::kHome), shape(PlaceKind::kGround));
  EXPECT_NE(shape(PlaceKind::kHome), shape(PlaceKind::kWaypoint));
  EXPECT_NE(shape(PlaceKind::kGround), shape(PlaceKind::kWaypoint));
}

TEST(Messages, OverScreensTheyTakeTheFootAndPanelsKeepClearOfIt) {
  Messages messages;
  messages.say(std::string(200, 'm'));
  messages.say("cannot save the world: the disk is full");
  for (const auto& [width, height] : {std::pair(640u, 360u), {1280u, 720u}}) {
    Gui gui;
    float foot = 0.0f, panel_end = 0.0f;
    for (int i = 0; i < 2; ++i) {
      gui.begin({width, height, 0.02, nullptr});
      foot = show_messages(messages, true);
      keep_foot_clear(foot);
      begin_panel("panel", Place::kMiddle, 900, 700);
      text("above");
      panel_end = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
      end_panel();
      gui.end();
    }
    EXPECT_GT(foot, 30.0f);
    EXPECT_LE(panel_end, static_cast<float>(height) - foot);
  }
  Gui gui;
  gui.begin({640, 360, 0.02, nullptr});
  EXPECT_EQ(show_messages({}, true), 0.0f);
  EXPECT_EQ(show_messages(messages, false), 0.0f);
  gui.end();
}

TEST(Fonts, CyrillicGreekAndChineseComeWithTheTextThatHasThem) {
  if (!find_typeface() || !find_fallback_typeface()) GTEST_SKIP() << "no such fonts here";
  Gui gui;
  const std::u32string characters = U"\u0416\u03a9\u5c9b\u3057\ud55c";
  const auto has = [&](char32_t character) {
    gui.begin({1280, 720, 0.02, nullptr});
    const bool found =
        ImGui::GetFont()->FindGlyphNoFallback(static_cast<ImWchar>(character)) != nullptr;
    gui.end();
    return found;
  };
  for (const char32_t c : characters) EXPECT_FALSE(has(c)) << std::hex << std::uint32_t{c};
  EXPECT_FALSE(gui.fit_font());
  gui.expect("\u041e\u0441\u0442\u0440\u043e\u0432 \u5c9b \u03c9 \u3057\u307e \ud55c \xff\xfe");
  EXPECT_TRUE(gui.fit_font());
  EXPECT_FALSE(gui.fit_font());  // nothing new
  for (const char32_t c : characters) EXPECT_TRUE(has(c)) << std::hex << std::uint32_t{c};
  EXPECT_TRUE(has(U'A'));
  // A text of all there is takes no more than a device can hold.
  for (char32_t c = 0x180; c < 0x10000; ++c) {
    platform::Input input;
    input.type(c);
    gui.expect(input.take());
  }
  gui.fit_font();
  EXPECT_LE(gui.font().height, 16384);
}

/// Distributions have different ones of them.
TEST(Fonts, EachTypefaceThatIsKnownIsFoundAndTheBestTaken) {
  const Folder root;
  EXPECT_FALSE(find_fallback_typeface(root.path()));
  const auto files = fallback_typefaces();
  for (auto file = files.rbegin(); file != files.rend(); ++file) {
    std::filesystem::create_directories((root / *file).parent_path());
    ASSERT_TRUE(write_text(root / *file, "a typeface"));
    EXPECT_EQ(find_fallback_typeface(root.path()), root / *file);
  }
}

/// With outlines of TrueType and of PostScript, alone and in collections.
TEST(Fonts, EveryInstalledTypefaceDrawsChineseAndJapanese) {
  int installed = 0;
  for (const char* file : fallback_typefaces()) {
    const std::filesystem::path path = std::filesystem::path("/") / file;
    if (!std::filesystem::exists(path)) continue;
    ++installed;
    ImGuiContext* context = ImGui::CreateContext();
    ImGui::SetCurrentContext(context);
    {
      Fonts fonts(path);
      fonts.want("\u5c9b \u5cf6 \u3057\u307e \u30ab");
      ASSERT_TRUE(fonts.fit());
      EXPECT_TRUE(ImGui::GetIO().Fonts->Build());
      constexpr ImWchar kSome[] = {0x5c9b, 0x5cf6, 0x3057, 0x30ab};
      for (const ImWchar c : kSome) {
        const ImFontGlyph* glyph = fonts.at(TextSize::kBody, 1.0f)->FindGlyphNoFallback(c);
        ASSERT_NE(glyph, nullptr) << path << " lacks " << std::hex << int{c};
        EXPECT_GT((glyph->X1 - glyph->X0) * (glyph->Y1 - glyph->Y0), 40.0f) << path;
      }
    }
    ImGui::DestroyContext(context);
  }
  if (installed == 0) GTEST_SKIP() << "no such fonts here";
}

TEST(Messages, FadeAndRepeatInOneLine) {
  Messages messages;
  messages.say("saved");
  messages.pass(5.0);
  messages.say("saved");
  ASSERT_EQ(messages.lines().size(), 1u);
  messages.pass(6.5);
  EXPECT_NEAR(messages.lines()[0].strength(), 0.5, 1e-9);
  messages.pass(1.0);
  EXPECT_TRUE(messages.lines().empty());
  for (int i = 0; i < 100; ++i) messages.say(std::to_string(i));
  EXPECT_EQ(messages.lines().size(), Messages::kMost);
  EXPECT_EQ(messages.lines().back().text, "99");
}

}  // namespace
}  // namespace skerry::game::ui
