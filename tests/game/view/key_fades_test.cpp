// From which directions reflected light of sun and moon is shown, over time.
#include "game/view/key_fades.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "engine/gpu/transfer/readback.h"
#include "game/view/scene_view.h"
#include "tests/game/view/roof.h"
#include "tests/gpu/test_device.h"

namespace skerry::game {
namespace {

const world::IslandLevel kRow{7}, kOther{8};
const glm::vec3 kEast{1.0f, 0.0f, 0.0f}, kUp{0.0f, 1.0f, 0.0f}, kSouth{0.0f, 0.0f, 1.0f};

bool kAll(const world::IslandLevel&) {
  return true;
}

float sum_of(const std::array<render::KeyedBody, 2>& keyed) {
  return keyed[0].weight + keyed[1].weight;
}

TEST(KeyFades, TheFirstLightOfAnIslandIsThereAtOnce) {
  KeyFades fades;
  EXPECT_EQ(fades.next(kRow), 0u);
  fades.show(kRow, {kEast, std::nullopt});
  EXPECT_EQ(fades.of(kRow)[0].weight, 1.0f);
  EXPECT_EQ(fades.of(kRow)[0].direction, kEast);
  EXPECT_EQ(fades.shown(kRow), kEast);
  EXPECT_EQ(sum_of(fades.of(kOther)), 0.0f);
}

TEST(KeyFades, OneDirectionFadesIntoTheNext) {
  KeyFades fades;
  fades.show(kRow, {kEast, std::nullopt});
  world::KeyDirections keys{kEast, std::nullopt};
  for (const glm::vec3& next : {kUp, kSouth, kEast}) {
    const std::size_t slot = fades.next(kRow);
    ASSERT_TRUE(fades.is_unseen(kRow, slot));
    EXPECT_EQ(fades.of(kRow)[slot].weight, 0.0f);
    keys[slot] = next;
    fades.show(kRow, keys);
    EXPECT_EQ(fades.of(kRow)[slot].weight, 0.0f);
    EXPECT_FALSE(fades.is_unseen(kRow, fades.next(kRow)));
    float before = 0.0f;
    int frames = 0;
    for (; !fades.is_unseen(kRow, fades.next(kRow)); ++frames) {
      fades.advance(kAll);
      EXPECT_FLOAT_EQ(sum_of(fades.of(kRow)), 1.0f);
      EXPECT_GT(fades.of(kRow)[slot].weight, before);
      EXPECT_LE(fades.of(kRow)[slot].weight - before, 0.05f);
      before = fades.of(kRow)[slot].weight;
      ASSERT_LT(frames, 100);
    }
    EXPECT_EQ(fades.of(kRow)[slot].weight, 1.0f);
    EXPECT_EQ(fades.shown(kRow), next);
  }
}

TEST(KeyFades, AnIslandThatIsNoLongerNearFadesOutAndComesBack) {
  KeyFades fades;
  fades.show(kRow, {kEast, kUp});
  ASSERT_TRUE(fades.turn_to(kRow, kUp));
  EXPECT_FALSE(fades.turn_to(kRow, kSouth));
  EXPECT_FALSE(fades.turn_to(kOther, kUp));
  fades.advance(kAll);
  EXPECT_GT(fades.of(kRow)[1].weight, 0.0f);
  float before = 1.0f;
  for (int frame = 0; frame < 40; ++frame) {
    fades.advance([](const world::IslandLevel& row) { return row != kRow; });
    const float now = sum_of(fades.of(kRow));
    EXPECT_LE(before - now, 0.07f);
    before = now;
  }
  EXPECT_FALSE(fades.shows(kRow));
  for (int frame = 0; frame < 40; ++frame) fades.advance(kAll);
  EXPECT_EQ(fades.of(kRow)[1].weight, 1.0f);
}

TEST(KeyFades, LightThatHadNoDirectionFadesIn) {
  KeyFades fades;
  fades.show(kRow, {});
  EXPECT_EQ(sum_of(fades.of(kRow)), 0.0f);
  fades.show(kRow, {kUp, std::nullopt});
  EXPECT_EQ(sum_of(fades.of(kRow)), 0.0f);
  fades.advance(kAll);
  EXPECT_GT(sum_of(fades.of(kRow)), 0.0f);
  EXPECT_LT(sum_of(fades.of(kRow)), 0.1f);
}

TEST(KeyFades, APictureThatStandsStillShowsNoFade) {
  KeyFades fades;
  fades.show(kRow, {kEast, std::nullopt});
  fades.show(kOther, {kEast, std::nullopt});
  fades.show(kRow, {kEast, kUp});
  fades.advance(kAll);
  fades.finish({kRow});
  EXPECT_EQ(fades.of(kRow)[0].weight, 0.0f);
  EXPECT_EQ(fades.of(kRow)[1].weight, 1.0f);
  EXPECT_EQ(sum_of(fades.of(kOther)), 0.0f);
}

TEST(KeyFades, TheBrighterBodyIsFollowedAboutTheIslandsAxes) {
  const glm::dquat turned = glm::angleAxis(0.8, glm::normalize(glm::dvec3(0.1, 1.0, 0.0)));
  const render::Celestial noon = render::celestial_at(43200.0, 0.5),
                          night = render::celestial_at(0.0, 0.5),
                          new_moon = render::celestial_at(0.0, 0.0);
  const auto toward = [&](const render::Celestial& sky) {
    return glm::dvec3(turned * glm::dvec3(*key_direction(sky, turned)));
  };
  EXPECT_LT(glm::length(toward(noon) - noon.to_sun), 1e-6);
  EXPECT_LT(glm::length(toward(night) - night.to_moon), 1e-6);
  EXPECT_FALSE(key_direction(new_moon, turned));
}

constexpr VkExtent2D kSize{160, 90};

class KeyedFrames : public gpu::GpuTest {
 protected:
  using Picture = std::vector<std::byte>;
  std::unique_ptr<SceneView> open() {
    SceneOptions options;
    options.seed_text = "1";
    options.settings.view_distance = 128;
    options.settings.exposure_ev = 8.0;
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made) << made.error().message;
    add_roof(**made);
    return *std::move(made);
  }
  /// Over the camera: below it, most of the light is what the ground about it reflects.
  static void add_roof(SceneView& view) { test::put_roof(view, 2, -8, 8, world::block::kStone); }
  static void take_part_of_roof(SceneView& view) {
    test::put_roof(view, 2, 0, 8, world::block::kAirBlock);
  }
  static SceneView::Moment moment(SceneView& view, double hour) {
    SceneView::Moment out;
    out.camera = view.start_camera();
    out.camera.pitch_deg = -35.0;
    out.time_of_day_s = hour * 3600.0;
    return out;
  }
  Picture draw(SceneView& view, const SceneView::Moment& moment) {
    EXPECT_TRUE(view.draw(moment, kSize));
    view.renderer().finish();
    auto picture = gpu::read_back(device(), view.renderer().picture(), 4);
    EXPECT_TRUE(picture);
    return *std::move(picture);
  }
  /// But for what the sky's tables differ by, which depend on when they were made.
  static bool alike(const Picture& a, const Picture& b) {
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const int by = std::to_integer<int>(a[i]) - std::to_integer<int>(b[i]);
      if (by < -2 || by > 2) return false;
      differ += by != 0 ? 1 : 0;
    }
    return differ < 64;
  }
  Picture loaded(SceneView& view, double hour) {
    EXPECT_TRUE(view.load_completely(moment(view, hour)));
    return draw(view, moment(view, hour));
  }
};

TEST_F(KeyedFrames, AreTheSameWhateverTheSunHasBeenFollowedFromBefore) {
  const auto fresh = open(), old = open();
  const Picture right = loaded(*fresh, 10.0);
  for (const double hour : {9.0, 9.8, 15.0, 0.0})
    EXPECT_FALSE(alike(loaded(*old, hour), right)) << hour;
  EXPECT_TRUE(alike(loaded(*old, 10.0), right));
}

// Streams as a game does, while the clock runs and once it rests.
TEST_F(KeyedFrames, AreThoseOfTheirMomentAfterAnEditToo) {
  const auto fresh = open(), old = open();
  EXPECT_TRUE(old->load_completely(moment(*old, 9.0)));
  for (const auto& view : {fresh.get(), old.get()}) take_part_of_roof(*view);
  EXPECT_TRUE(alike(loaded(*old, 10.0), loaded(*fresh, 10.0)));
}

TEST_F(KeyedFrames, InPlayComeToWhereTheSunRests) {
  const auto fresh = open(), played = open();
  const Picture right = loaded(*fresh, 10.0);
  EXPECT_FALSE(alike(loaded(*played, 9.0), right));
  EXPECT_FALSE(alike(draw(*played, moment(*played, 10.0)), right));  // from where the sun stood
  for (double hour = 9.0; hour < 10.0; hour += 1.0 / 64.0)
    ASSERT_TRUE(played->stream(moment(*played, hour)));
  bool same = false;
  for (int tries = 0; tries < 40 && !same; ++tries) {
    for (int i = 0; i < 128; ++i) {
      ASSERT_TRUE(played->stream(moment(*played, 10.0)));
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    same = alike(draw(*played, moment(*played, 10.0)), right);
  }
  EXPECT_TRUE(same);
}

}  // namespace
}  // namespace skerry::game
