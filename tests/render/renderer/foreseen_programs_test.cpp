// Programs and memory of frames to come are made before they are needed.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "shaders/shared/light.h"
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{64, 48};
constexpr double kNoon = 12.0 * 3600.0, kDusk = 18.05 * 3600.0, kMidnight = 0.0;

world::BlockId meadow_with_pond(int x, int y, int z) {
  const bool in_pond = y == -1 && x >= 10 && x < 20 && z >= 10 && z < 20;
  if (in_pond) return static_cast<world::BlockId>(world::block::kWater);
  if (y == 0 && x == 12 && z == 6) return world::block::kOakLeaves;
  return y < 0 ? world::block::kGrass : world::block::kAirBlock;
}

class ForeseenPrograms : public RendererOnGpu {
 protected:
  void SetUp() override {
    RendererOnGpu::SetUp();
    if (!HasFatalFailure()) begin();
  }
  void begin() {
    ASSERT_TRUE(renderer().occupancy());
    add(meadow_with_pond, {0, -1, 0}, {1, 0, 1});
  }
  FrameInput input(double time_s, double moon_phase) const {
    FrameInput in;
    in.islands = islands_;
    in.light_islands = light_islands_;
    in.sky = celestial_at(time_s, moon_phase);
    in.camera = camera_at({15.0, 8.0, -3.0}, 0.0, -30.0);  // towards the pond
    return in;
  }
  FrameInput dull() const {
    FrameInput in = input(kNoon, 0.0);
    in.camera = camera_at({15.0, 8.0, -3.0}, 180.0, -30.0);
    return in;
  }
  /// Frames that show what the dull one does not, one thing after another and together.
  std::vector<FrameInput> lively() const {
    std::vector<FrameInput> out;
    for (const double time_s : {kNoon, kDusk, kMidnight})
      for (const double moon : {0.0, 0.5})
        for (const bool lit : {false, true}) {
          out.push_back(input(time_s, moon));
          if (lit) out.back().lights = lamps_;
          out.push_back(out.back());
          out.back().camera.pitch_deg = 80.0;  // sky alone, stars
          out.push_back(out.back());
          out.back().camera.yaw_deg = 90.0;
          out.back().camera.pitch_deg = 10.0;
          out.push_back(out[out.size() - 3]);
          out.back().camera_medium = world::block::kWater;
          out.push_back(out[out.size() - 4]);
          out.back().marker = BlockMarker{0, {12.0, 0.0, 6.0}, {13.0, 1.0, 7.0}, 0.5f};
        }
    return out;
  }
  /// By day, with a lamp by the pond.
  FrameInput lit() const {
    FrameInput in = input(kNoon, 0.0);
    in.lights = lamps_;
    return in;
  }
  /// From now on; `names` must outlive the gate. Without shadow maps, of which a body has none
  /// until it shines: by day those of the moon would double their memory.
  void note_allocations(std::vector<std::string>& names) {
    device().set_allocation_gate([&names](const std::string& name, std::uint64_t) {
      if (name != "shadow maps") names.push_back(name);
      return true;
    });
  }
  struct Late {
    int programs = 0;
    std::vector<std::string> allocations;  // what they are for
  };
  /// What the lively frames wait for, after dull ones.
  Late made_late(const RenderSettings& settings, bool foresee, int dull_frames = 1) {
    restart();
    begin();
    if (foresee) renderer().foresee_programs();
    drawn(dull(), settings, kSize);
    renderer().wait_for_programs();
    EXPECT_EQ(renderer().programs_to_come(), 0u);
    for (int i = 1; i < dull_frames; ++i) drawn(dull(), settings, kSize);
    Late late;
    note_allocations(late.allocations);
    for (const FrameInput& in : lively()) late.programs += drawn(in, settings, kSize).programs_made;
    device().set_allocation_gate({});
    return late;
  }

  void expect_none_late(const RenderSettings& settings, int dull_frames = 1) {
    const Late late = made_late(settings, true, dull_frames);
    EXPECT_EQ(late.programs, 0);
    EXPECT_EQ(late.allocations, std::vector<std::string>{});
  }

 private:
  std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  std::vector<std::uint32_t> light_islands_{0};
  std::vector<shared::Light> lamps_ = [] {
    shared::Light lamp{};
    lamp.kind = shared::kLightPoint;
    lamp.position = {0.0f, -6.0f, 12.0f};
    lamp.range = 20.0f;
    lamp.intensity = glm::vec3(5.0f);
    return std::vector<shared::Light>{lamp};
  }();
};

TEST_F(ForeseenPrograms, AFrameInStepsTellsEachPassAndDrawsTheSamePicture) {
  const RenderSettings settings;
  FrameInput in = input(kDusk, 0.5);
  drawn(in, settings, kSize);
  const std::vector<std::uint8_t> whole = picture();
  restart();
  begin();
  std::vector<std::uint32_t> told;
  std::uint32_t all = 0;
  renderer().step_frames([&](std::uint32_t done, std::uint32_t passes) {
    told.push_back(done);
    all = passes;
    device().run_now([](VkCommandBuffer) {});  // as who shows how far it is
    device().collect();
  });
  drawn(in, settings, kSize);
  EXPECT_EQ(picture(), whole);
  EXPECT_GT(all, 10u);
  std::vector<std::uint32_t> each(all);
  std::iota(each.begin(), each.end(), 0u);
  EXPECT_EQ(told, each);
  renderer().step_frames({});
  drawn(in, settings, kSize);
  EXPECT_EQ(told.size(), all);
}

TEST_F(ForeseenPrograms, WhatComesNewlyIntoViewNeedsNoProgramOrMemoryInItsFrame) {
  const Late unforeseen = made_late({}, false);
  EXPECT_GT(unforeseen.programs, 10) << "frames that foresee nothing make their own";
  EXPECT_GT(unforeseen.allocations.size(), 10u);
  // Memory for them stays while nothing needs it.
  expect_none_late({}, 30);
}

TEST_F(ForeseenPrograms, FramesGoOnWhereThereIsNoMemoryForThose) {
  drawn(dull(), {}, kSize);
  device().set_allocation_gate([](const std::string&, std::uint64_t) { return false; });
  renderer().foresee_programs();
  drawn(dull(), {}, kSize);
  device().set_allocation_gate({});
  const std::vector<std::uint8_t> after = picture();
  restart();
  begin();
  drawn(dull(), {}, kSize);
  EXPECT_EQ(picture(), after);
}

TEST_F(ForeseenPrograms, AreThoseOfTheSettingsInForce) {
  RenderSettings cloudy;
  cloudy.clouds.coverage = 0.5f;
  cloudy.bloom.intensity = 0.2f;
  expect_none_late(cloudy);
  if (!long_tests()) return;  // each makes the programs of a renderer anew
  RenderSettings plain;
  plain.shadow_enabled = false;
  plain.lights_shadows = 0;
  plain.indirect = Indirect::kOff;
  plain.ao_strength = 0.0f;
  expect_none_late(plain);
  RenderSettings shared_light;
  shared_light.shading_rate = 4;
  expect_none_late(shared_light);
  RenderSettings without;
  without.leave_out.add(Feature::kMoon);
  without.leave_out.add(Feature::kWater);
  expect_none_late(without);
  without.leave_out.add(Feature::kLights);
  expect_none_late(without);
}

TEST_F(ForeseenPrograms, AreForeseenAnewWhenSettingsChange) {
  renderer().foresee_programs();
  drawn(dull(), {}, kSize);
  renderer().wait_for_programs();
  RenderSettings plain;
  plain.indirect = Indirect::kOff;
  plain.shadow_enabled = false;
  plain.lights_shadows = 0;
  drawn(dull(), plain, kSize);
  EXPECT_GT(renderer().programs_to_come(), 0u);
  renderer().wait_for_programs();
  for (const FrameInput& in : lively()) EXPECT_EQ(drawn(in, plain, kSize).programs_made, 0);
}

TEST_F(ForeseenPrograms, OfOtherSettingsAreNotWaitedForByAFrameThatMayLag) {
  RenderSettings cloudy;
  cloudy.clouds.coverage = 0.5f;
  cloudy.bloom.intensity = 0.2f;
  FrameInput in = dull();
  drawn(in, cloudy, kSize);
  const std::vector<std::uint8_t> after = picture();
  restart();
  begin();
  renderer().foresee_programs();
  drawn(in, {}, kSize);
  renderer().wait_for_programs();
  const std::vector<std::uint8_t> before = picture();
  ASSERT_NE(before, after);
  in.may_lag = true;
  int lagging = 0;
  for (; lagging < 100000; ++lagging) {
    const FrameReport report = drawn(in, cloudy, kSize);
    ASSERT_EQ(report.programs_made, 0);
    ASSERT_EQ(renderer().lagged(), report.lagged);
    if (!report.lagged) break;
    ASSERT_EQ(picture(), before);
  }
  EXPECT_GT(lagging, 0);
  EXPECT_EQ(picture(), after);
}

TEST_F(ForeseenPrograms, OfOtherSettingsAreMadeWhileMapsAreDrawnAhead) {
  FrameInput in = dull();
  in.sky = celestial_at(15.0 * 3600.0, 0.0);
  in.may_lag = true;
  renderer().foresee_programs();
  drawn(in, {}, kSize);
  renderer().wait_for_programs();
  // The coarse maps must reach further: they are drawn to spare layers, and shown from there.
  in.reach_blocks *= 1.1;
  const FrameReport ahead = drawn(in, {}, kSize);
  EXPECT_TRUE(std::ranges::any_of(
      ahead.passes, [](const gpu::PassTime& p) { return p.name == "draw_shadow_ahead"; }));
  RenderSettings cloudy;
  cloudy.clouds.coverage = 0.5f;
  EXPECT_TRUE(drawn(in, cloudy, kSize).lagged);
  renderer().wait_for_programs();
  EXPECT_FALSE(drawn(in, cloudy, kSize).lagged);
}

TEST_F(ForeseenPrograms, OfOtherSettingsAreWaitedForByAnExactFrame) {
  RenderSettings cloudy;
  cloudy.clouds.coverage = 0.5f;
  drawn(dull(), cloudy, kSize);
  const std::vector<std::uint8_t> after = picture();
  restart();
  begin();
  renderer().foresee_programs();
  drawn(dull(), {}, kSize);
  const FrameReport report = drawn(dull(), cloudy, kSize);
  EXPECT_GT(report.programs_made, 0);
  EXPECT_FALSE(report.lagged);
  EXPECT_EQ(picture(), after);
}

TEST_F(ForeseenPrograms, OfMixedFramesAreMadeBeforeThereIsGeometry) {
  RenderSettings mixed;
  mixed.aa = Antialiasing::kTemporal;
  restart();
  ASSERT_TRUE(renderer().occupancy());
  renderer().foresee_programs();
  drawn(dull(), mixed, kSize);
  renderer().wait_for_programs();
  begin();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(drawn(dull(), mixed, kSize).programs_made, 0) << i;
}

TEST_F(ForeseenPrograms, LeaveThePictureAsItIs) {
  const FrameInput in = lively().front();
  drawn(in, {}, kSize);
  const std::vector<std::uint8_t> alone = picture();
  restart();
  begin();
  renderer().foresee_programs();
  drawn(dull(), {}, kSize);
  drawn(in, {}, kSize);
  EXPECT_EQ(picture(), alone);
}

TEST_F(ForeseenPrograms, ExpectedOnesAreThereForTheFrame) {
  ASSERT_TRUE(renderer().indirect());
  for (const FrameInput& in : {lively().front(), lit()}) {
    renderer().expect(in, {}, kSize);
    renderer().wait_for_programs();
    EXPECT_EQ(drawn(in, {}, kSize).programs_made, 0);
  }
}

TEST_F(ForeseenPrograms, ExpectedOnesLeaveThePictureAsItIs) {
  const FrameInput in = lively().front();
  ASSERT_TRUE(renderer().indirect());
  drawn(in, {}, kSize);
  const std::vector<std::uint8_t> alone = picture();
  restart();
  FrameInput empty = in;
  empty.islands = {};
  renderer().expect(empty, {}, kSize);
  begin();
  ASSERT_TRUE(renderer().indirect());
  renderer().expect(in, {}, kSize);
  drawn(in, {}, kSize);
  EXPECT_EQ(picture(), alone);
}

TEST_F(ForeseenPrograms, ExpectedOfAnEmptyWorldAreThoseOfOneWithWaterAndLamps) {
  const FrameInput in = lit();
  restart();
  ASSERT_TRUE(renderer().occupancy());
  FrameInput empty = in;
  empty.islands = {};
  renderer().expect(empty, {}, kSize);
  renderer().wait_for_programs();
  begin();
  ASSERT_TRUE(renderer().indirect());
  EXPECT_EQ(drawn(in, {}, kSize).programs_made, 0);
}

TEST_F(ForeseenPrograms, NoneAreExpectedWhereThereIsNoMemoryForTheFrame) {
  device().set_allocation_gate([](const std::string&, std::uint64_t) { return false; });
  renderer().expect(lively().front(), {}, kSize);
  device().set_allocation_gate({});
  EXPECT_EQ(renderer().programs_to_come(), 0u);
  EXPECT_GT(drawn(lively().front(), {}, kSize).programs_made, 0);
}

}  // namespace
}  // namespace skerry::render
