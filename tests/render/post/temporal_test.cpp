// Pictures mixed over time (aa=temporal), against many samples of single frames.
// docs/decisions/0088.
#include "engine/render/plan/temporal_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/render/post/kept_frames.h"
#include "tests/render/renderer_on_gpu.h"
#include "tests/render/smooth_pictures.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{96, 64};

world::BlockId ground(int, int y, int) {
  return y < 0 ? world::block::kStone : world::block::kAirBlock;
}
/// A light block before the ground's dark one.
world::BlockId tower(int x, int y, int z) {
  return x >= 0 && x < 3 && y >= 0 && y < 5 && z >= 0 && z < 3 ? world::block::kSnow
                                                               : world::block::kAirBlock;
}

class Temporal : public RendererOnGpu {
 protected:
  FrameInput view(glm::dvec3 eye, double yaw_deg, double pitch_deg) const {
    FrameInput in;
    in.islands = islands_;
    in.sky = sun_at(50.0, 160.0);
    in.camera = camera_at(eye, yaw_deg, pitch_deg);
    in.reach_blocks = 200.0;
    return in;
  }
  static RenderSettings settings(Antialiasing aa, int samples = 1) {
    RenderSettings out;
    out.aa = aa;
    out.aa_samples = samples;
    out.shadow_enabled = false;
    return out;
  }
  Bytes mixed(const FrameInput& input) {
    drawn(input, settings(Antialiasing::kTemporal), kSize);
    return picture();
  }
  /// The picture of a frame that nothing is known before.
  Bytes first(const FrameInput& input) {
    renderer().invalidate_history();
    return mixed(input);
  }
  Bytes hard(const FrameInput& input) {
    drawn(input, settings(Antialiasing::kOff), kSize);
    return picture();
  }
  Bytes exact(const FrameInput& input) {
    drawn(input, settings(Antialiasing::kOff, 16), kSize);
    return picture();
  }
  /// The picture that frames at rest come to.
  Bytes settled(const FrameInput& input) {
    Bytes out;
    for (int frame = 0; frame < 34; ++frame) out = mixed(input);
    return out;
  }
  IslandPlacement& island(std::size_t index) { return islands_[index]; }

 private:
  std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0},
                                        {{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
};

/// Pixels with a channel that no pixel of `truth` within two of them has: what is left of another
/// picture.
int strange(const Bytes& picture, const Bytes& truth) {
  constexpr int kRounding = 14;
  const int width = kSize.width, height = kSize.height;
  int count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      bool is_strange = false;
      for (int channel = 0; channel < 3; ++channel) {
        int low = 255, high = 0;
        for (int v = std::max(y - 2, 0); v <= std::min(y + 2, height - 1); ++v)
          for (int u = std::max(x - 2, 0); u <= std::min(x + 2, width - 1); ++u) {
            const int at = truth[4 * (static_cast<std::size_t>(v) * width + u) + channel];
            low = std::min(low, at);
            high = std::max(high, at);
          }
        const int shown = picture[4 * (static_cast<std::size_t>(y) * width + x) + channel];
        is_strange |= shown < low - kRounding || shown > high + kRounding;
      }
      count += is_strange;
    }
  return count;
}

TEST(TemporalJitter, CoversThePixelEvenlyAndBeginsAtItsCentre) {
  glm::dvec2 sum(0.0);
  std::set<int> columns, rows;
  std::set<std::pair<int, int>> halves;
  for (std::uint32_t frame = 0; frame < shared::kMixedFrames; ++frame) {
    const glm::vec2 at = temporal_jitter(frame);
    EXPECT_LE(std::max(std::abs(at.x), std::abs(at.y)), 0.5f);
    EXPECT_EQ(at, temporal_jitter(frame + shared::kMixedFrames));
    sum += at;
    columns.insert(static_cast<int>(std::lround(at.x * 8.0f)));
    rows.insert(static_cast<int>(std::lround(at.y * 8.0f)));
    halves.insert({at.x < 0.0f, at.y < 0.0f});
  }
  EXPECT_EQ(temporal_jitter(0), glm::vec2(0.0f));
  // Eighths from -4 to 3: their mean is half of one.
  EXPECT_LT(glm::length(sum / 8.0), 0.1);
  EXPECT_EQ(columns.size(), 8u);
  EXPECT_EQ(rows.size(), 8u);
  EXPECT_EQ(halves.size(), 4u);
}

TEST_F(Temporal, ComesToManySamplesAtRest) {
  island(0).rotation = glm::angleAxis(0.3, glm::dvec3(0, 1, 0));
  add(rough, {-1, 0, -1}, {1, 1, 1});
  for (const auto& [eye, yaw, pitch] : {std::tuple(glm::dvec3(2.0, 8.0, -12.0), 10.0, -20.0),
                                        std::tuple(glm::dvec3(-7.0, 14.0, 9.0), 130.0, -35.0)}) {
    const FrameInput input = view(eye, yaw, pitch);
    const Bytes truth = exact(input), off = hard(input), found = settled(input);
    EXPECT_LT(error_of(found, truth), 0.5 * error_of(off, truth));
    EXPECT_LE(far_off(found, truth), far_off(off, truth) / 8);
    // It stays so, whichever place the next frame samples.
    for (int i = 0; i < 8; ++i) ASSERT_EQ(mixed(input), found) << i;
  }
}

TEST_F(Temporal, IsNearerToManySamplesInATurn) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  double off = 0.0, found = 0.0;
  int off_far = 0, found_far = 0;
  std::vector<FrameInput> frames;
  for (int i = 0; i < 24; ++i) frames.push_back(view({2.0, 8.0, -12.0}, 10.0 + 0.31 * i, -20.0));
  std::vector<Bytes> shown;
  for (const FrameInput& input : frames) shown.push_back(mixed(input));
  for (std::size_t i = 12; i < frames.size(); ++i) {
    const Bytes truth = exact(frames[i]), alone = hard(frames[i]);
    off += error_of(alone, truth);
    found += error_of(shown[i], truth);
    off_far += far_off(alone, truth);
    found_far += far_off(shown[i], truth);
  }
  EXPECT_LT(found, 0.9 * off);
  EXPECT_LT(found_far, off_far / 2);
}

TEST_F(Temporal, TheSameFramesHaveTheSameBytes) {
  Bytes first;
  for (const bool again : {false, true}) {
    if (again) restart();
    add(rough, {-1, 0, -1}, {1, 1, 1});
    Bytes last;
    for (int i = 0; i < 6; ++i) {
      island(0).origin[0] = 3000 * i;
      last = mixed(view({2.0, 8.0, -12.0}, 10.0 + 0.4 * i, -20.0));
    }
    if (again)
      EXPECT_EQ(first, last);
    else
      first = last;
  }
  island(0).origin[0] = 0;
}

TEST_F(Temporal, ARemovedBlockIsGoneInTheNextFrame) {
  add(ground, {-1, -1, -1}, {1, 1, 1});
  tools::stability::MeshedChunk meshed = tools::stability::mesh_chunk_of(tower, {0, 0, 0}, 0);
  meshed.section.island = 1;
  const Result<SectionId> id =
      renderer().geometry().add(renderer().mesh_uploader(), meshed.section, meshed.quads);
  ASSERT_TRUE(id);
  const FrameInput input = view({1.5, 4.0, -9.0}, 0.0, -10.0);
  const Bytes before = settled(input);
  renderer().geometry().remove(renderer().mesh_uploader(), *id);
  const Bytes after = mixed(input), truth = exact(input);
  EXPECT_GT(strange(before, truth), 100);
  EXPECT_EQ(strange(after, truth), 0);
}

TEST_F(Temporal, ABlockThatIsPutIsThereInTheNextFrame) {
  add(ground, {-1, -1, -1}, {1, 1, 1});
  const FrameInput input = view({1.5, 4.0, -9.0}, 0.0, -10.0);
  const Bytes before = settled(input);
  add(tower, {0, 0, 0}, {1, 1, 1}, 1);
  const Bytes after = mixed(input), truth = exact(input);
  EXPECT_GT(strange(before, truth), 100);
  EXPECT_EQ(strange(after, truth), 0);
}

// It moves by one to three pixels a frame; so does what it uncovers.
TEST_F(Temporal, AnIslandThatDriftsLeavesNoTrail) {
  add(ground, {-1, -1, -1}, {1, 1, 1});
  add(tower, {0, 0, 0}, {1, 1, 1}, 1);
  for (const double blocks : {0.12, 0.4})
    for (const double pitch : {-10.0, 25.0}) {
      Bytes after;
      FrameInput input;
      for (int i = 0; i < 14; ++i) {
        island(1).origin[0] = static_cast<std::int64_t>(std::llround(65536.0 * blocks * i));
        input = view({1.5, 4.0, -9.0}, 0.0, pitch);
        after = mixed(input);
      }
      const Bytes alone = first(input), truth = exact(input);
      EXPECT_LE(strange(after, truth), strange(alone, truth) + 2) << blocks << " " << pitch;
    }
}

TEST_F(Temporal, ACutShowsTheNewViewAlone) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  settled(view({2.0, 8.0, -12.0}, 10.0, -20.0));
  const FrameInput there = view({-20.0, 11.0, 25.0}, 150.0, -30.0);
  const Bytes after = mixed(there), alone = first(there), truth = exact(there);
  EXPECT_LE(strange(after, truth), strange(alone, truth) * 5 / 4 + 2);
}

TEST_F(Temporal, RestAfterMotionIsAsRestAlone) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  const FrameInput here = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  const Bytes alone = settled(here);
  FrameInput there = here;
  for (int i = 1; i <= 5; ++i) {
    there = view({2.0 + 0.2 * i, 8.0, -12.0}, 10.0 + 2.0 * i, -20.0);
    mixed(there);
  }
  EXPECT_GT(far_off(settled(there), alone), 100);
  // One that is not at rest yet, then each place of a pixel.
  Bytes again;
  for (std::uint32_t i = 0; i <= shared::kMixedFrames; ++i) again = mixed(here);
  EXPECT_EQ(again, alone);
}

// Rest has another picture than motion: places of pixels are sampled in turn.
TEST_F(Temporal, OnlyIslandsInViewEndRest) {
  constexpr std::int64_t kBlock = 65536;
  add(rough, {-1, 0, -1}, {1, 1, 1});
  add(tower, {0, 0, 0}, {1, 1, 1}, 1);
  std::vector<IslandPlacement> islands{island(0), island(1)};
  islands[1].origin[2] = -2000 * kBlock;  // behind the camera
  FrameInput input = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  input.islands = islands;
  const Bytes rest = settled(input);
  for (int i = 0; i < 10; ++i) {
    islands[1].origin[0] += kBlock;
    if (i == 5) islands.push_back({{}, {1.0, 0.0, 0.0, 0.0}, 300.0});  // nothing is drawn of it
    input.islands = islands;
    ASSERT_EQ(mixed(input), rest) << i;
  }
  // In view by its sphere alone, which is all that is asked.
  islands[1].origin[2] = 200 * kBlock;
  input.islands = islands;
  mixed(input);
  Bytes moving;
  for (int i = 0; i < 10; ++i) {
    islands[1].origin[1] -= kBlock;
    moving = mixed(input);
  }
  EXPECT_NE(moving, rest);
}

TEST_F(Temporal, KeepsPicturesOfAnyEdgeThatTheDeviceHas) {
  KeptFrames kept(device());
  const std::uint32_t edge = device().limits().max_image_edge;
  for (const VkExtent2D size : {VkExtent2D{edge, 1}, VkExtent2D{1, edge}}) {
    const Result<void> made = kept.ensure(size);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(kept.pictures());
    EXPECT_TRUE(kept.keys());
  }
}

TEST_F(Temporal, ASizeOrSettingThatChangesBeginsAnew) {
  const auto world = [&] { add(rough, {-1, 0, -1}, {1, 1, 1}); };
  world();
  const FrameInput input = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  const VkExtent2D small{80, 48};
  RenderSettings other = settings(Antialiasing::kTemporal);
  other.ao_strength = 0.25f;
  drawn(input, settings(Antialiasing::kTemporal), small);
  const Bytes resized_first = picture();
  restart();
  world();
  drawn(input, other, kSize);
  const Bytes other_first = picture();
  restart();
  world();
  settled(input);
  drawn(input, settings(Antialiasing::kTemporal), small);
  EXPECT_EQ(picture(), resized_first);
  settled(input);
  drawn(input, other, kSize);
  EXPECT_EQ(picture(), other_first);
}

TEST_F(Temporal, FollowsTheExposure) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  FrameInput input = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  input.exposure_ev = -1.0f;
  settled(input);
  Bytes found;
  for (int i = 0; i < 10; ++i) {
    *input.exposure_ev += 0.15f;
    found = mixed(input);
  }
  const Bytes truth = exact(input);
  double shift = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) shift += found[i] - truth[i];
  EXPECT_LT(std::abs(shift / static_cast<double>(found.size())), 5.0);
}

TEST_F(Temporal, CostsNothingWhereItIsOff) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  const FrameInput input = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  const Bytes before = hard(input);
  EXPECT_FALSE(has_pass("mix_"));
  mixed(input);
  EXPECT_TRUE(has_pass("mix_"));
  EXPECT_EQ(hard(input), before);
  // Many samples need no history; nor can what meters itself have one.
  drawn(input, settings(Antialiasing::kTemporal, 4), kSize);
  EXPECT_FALSE(has_pass("mix_"));
  FrameInput metered = input;
  metered.exposure_ev.reset();
  drawn(metered, settings(Antialiasing::kTemporal), kSize);
  EXPECT_FALSE(has_pass("mix_"));
}

TEST_F(Temporal, IsEnlargedAndSharesLight) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  const FrameInput input = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  RenderSettings low = settings(Antialiasing::kTemporal);
  low.render_scale = 0.5f;
  low.shading_rate = 4;
  RenderSettings alone = low;
  alone.aa = Antialiasing::kOff;
  for (int i = 0; i < 33; ++i) drawn(input, low, kSize);
  const Bytes found = picture();
  drawn(input, alone, kSize);
  const Bytes off = picture(), truth = exact(input);
  EXPECT_LT(error_of(found, truth), error_of(off, truth));
}

}  // namespace
}  // namespace skerry::render
