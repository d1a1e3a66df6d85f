// Where levels of detail meet there must be no hole: pixels that show the sky where an island's
// full detail shows land, all around, by the G-buffers of a flight.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <optional>
#include <set>
#include <string>

#include "game/view/scene_view.h"
#include "tests/gpu/test_device.h"
#include "tests/render/random_scenes.h"
#include "world/islands/world.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{240, 160};
// A voxel's edge is 4 pixels at most where it may be seen, so that a silhouette may be off by 2 and
// what is thinner than a voxel may be lost.
constexpr int kSilhouettePixels = 5;

/// How many of something the long run asks for.
int asked(const char* variable, int otherwise) {
  const char* set = std::getenv(variable);
  return set ? std::stoi(set) : otherwise;
}

using Words = std::vector<std::uint32_t>;

/// The row of the island table that a pixel shows; none: the sky.
std::optional<std::uint32_t> island_at(const Words& words, int x, int y) {
  const std::uint32_t word =
      words[static_cast<std::size_t>(y) * kSize.width + static_cast<std::size_t>(x)];
  if ((word & shared::kSurfaceHere) == 0) return std::nullopt;
  return shared::surface_island(word);
}

/// Pixels of sky within an island that reaches kSilhouettePixels beyond them at full detail, where
/// an island has one row.
int cracks(const Words& coarse, const Words& full) {
  int count = 0;
  for (int y = kSilhouettePixels; y + kSilhouettePixels < static_cast<int>(kSize.height); ++y) {
    for (int x = kSilhouettePixels; x + kSilhouettePixels < static_cast<int>(kSize.width); ++x) {
      const std::optional<std::uint32_t> island = island_at(full, x, y);
      if (!island || island_at(coarse, x, y)) continue;
      bool within = true;
      for (int dy = -kSilhouettePixels; within && dy <= kSilhouettePixels; ++dy)
        for (int dx = -kSilhouettePixels; within && dx <= kSilhouettePixels; ++dx)
          within = island_at(full, x + dx, y + dy) == island;
      count += within;
    }
  }
  return count;
}

std::size_t rows_of(const Words& words) {
  std::set<std::uint32_t> rows;
  for (const std::uint32_t word : words)
    if ((word & shared::kSurfaceHere) != 0) rows.insert(shared::surface_island(word));
  return rows.size();
}

class CracksTest : public gpu::GpuTest {
 protected:
  CracksTest() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  std::unique_ptr<SceneView> view_of(int seed, std::uint32_t detail) {
    SceneOptions options;
    options.seed_text = std::to_string(seed);
    options.settings.view_distance = 300;
    options.settings.view_detail = detail;
    options.settings.view_error = 1.0;
    options.settings.exposure_ev = 0.0;
    options.size = {kSize.width, kSize.height};
    render::RenderSettings& settings = options.settings.render;
    settings.indirect = render::Indirect::kOff;
    settings.shadow_enabled = false;
    settings.shading = render::Shading::kFlat;
    settings.ao_strength = 0.0f;
    settings.lights_shadows = 0;
    settings.leave_out.add(render::Feature::kLights);
    settings.leave_out.add(render::Feature::kCutouts);  // leaves are of holes
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made) << made.error().message;
    return *std::move(made);
  }

  static Words seen(SceneView& view, const SceneView::Moment& moment,
                    std::optional<double> blend_s = {}) {
    EXPECT_TRUE(view.load_completely(moment, blend_s));
    EXPECT_TRUE(view.draw(moment, kSize));
    view.renderer().finish();
    const std::vector<std::byte>& texels =
        view.renderer().captured(render::Capture::kSurfaces).texels;
    Words words(texels.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), texels.data(), texels.size());
    return words;
  }

  /// Over the island that is nearest to the origin, and beside and below it.
  /// @param blend_s see SceneView::load_completely(); each pass begins with one level of each
  /// place.
  void fly(int seed, int frames, std::optional<double> blend_s = {}) {
    const auto full = view_of(seed, 1024), coarse = view_of(seed, 32);
    const auto islands = coarse->world().islands_near(coarse->world().origin(), 400.0, 0.0);
    ASSERT_FALSE(islands.empty());
    const world::IslandSpec& island = islands.front();
    render::RandomPlaces random(static_cast<std::uint32_t>(seed));
    SceneView::Moment moment;
    moment.capture = true;
    const double reach = island.bounding_radius;
    glm::dvec3 at{}, step{};
    for (int i = 0; i < frames; ++i) {
      if (i % 10 == 0) {  // another pass
        const double heading = random.uniform(0.0, 6.28);
        step = glm::dvec3(std::sin(heading), random.uniform(-0.2, 0.2), std::cos(heading)) * 8.0;
        at = glm::dvec3(0.0, random.uniform(-0.5, 0.5) * reach, 0.0) - step * (reach / 10.0);
        moment.camera.yaw_deg = glm::degrees(heading) + random.uniform(-60.0, 60.0);
        moment.camera.pitch_deg = random.uniform(-40.0, 30.0);
      }
      at += step;
      const world::WorldPos place = world::moved(island.origin, at);
      moment.camera.position = {place.x, place.y, place.z};
      const Words of_full = seen(*full, moment),
                  of_coarse = seen(*coarse, moment, i % 10 == 0 ? std::nullopt : blend_s);
      const int found = cracks(of_coarse, of_full);
      const glm::dvec3 camera = world::difference_blocks(place, coarse->world().origin());
      EXPECT_EQ(found, 0) << "--seed " << seed << " --camera=" << camera.x << "," << camera.y << ","
                          << camera.z << "," << moment.camera.yaw_deg << ","
                          << moment.camera.pitch_deg;
      blending_ += coarse->blending();
      mixed_ += rows_of(of_coarse) > rows_of(of_full);
    }
  }

  int mixed_ = 0;     // frames that show an island at several levels
  int blending_ = 0;  // frames in which levels are changing
};

TEST_F(CracksTest, ThereAreNoneInAFlight) {
  const int seeds = asked("SKERRY_CRACK_SEEDS", 3), frames = asked("SKERRY_CRACK_FRAMES", 20);
  for (int seed = 1; seed <= seeds; ++seed) fly(seed, frames);
  EXPECT_GT(mixed_, seeds * frames / 4);
  EXPECT_EQ(blending_, 0);
}

// Each pixel shows one of two levels, so that there are holes unless they complete each other.
TEST_F(CracksTest, ThereAreNoneWhileLevelsChange) {
  const int seeds = asked("SKERRY_CRACK_SEEDS", 3), frames = asked("SKERRY_CRACK_FRAMES", 20);
  for (int seed = 1; seed <= seeds; ++seed) fly(seed, frames, 0.06);
  EXPECT_GT(blending_, seeds * frames / 4);
}

}  // namespace
}  // namespace skerry::game
