// A frame that fails half-way leaves nothing behind: tried again, it gives the bytes of a frame
// that nothing disturbed, and so does the next one, which keeps what that frame left.
#include <set>

#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{64, 48}, kLarger{192, 144};

/// Ground with a wall, a pool and a lamp over it: shadows, water, lights and clouds.
world::BlockId court(int x, int y, int z) {
  if (y < 4)
    return x > 20 && x < 40 && z > 30 && y == 3 ? world::block::kWater : world::block::kStone;
  return x == 10 && y < 20 ? world::block::kStone : world::block::kAirBlock;
}

class FailedFrames : public RendererOnGpu {
 protected:
  std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 120.0}};
  std::vector<shared::Light> lights_;
  RenderSettings settings_;

  void start() {
    restart();
    add(court, {0, 0, 0}, {1, 1, 1});
    shared::Light lamp{};
    lamp.kind = shared::kLightPoint;
    lamp.intensity = glm::vec3(20.0f);
    lamp.range = 30.0f;
    lamp.position = {30.0f, 8.0f, 30.0f};
    lights_ = {lamp};
    settings_.shadow_size = 256;
    settings_.clouds.coverage = 0.5f;
    settings_.bloom.intensity = 0.2f;
  }
  FrameInput input(double hour) {
    FrameInput in;
    in.camera.position = {32 * 65536, 24 * 65536, -20 * 65536};
    in.camera.pitch_deg = -20.0;
    in.islands = islands_;
    in.lights = lights_;
    in.sky = celestial_at(hour * 3600.0, 0.5);
    in.exposure_ev.reset();
    return in;
  }
  std::vector<std::uint8_t> picture_at(double hour, VkExtent2D size = kSize) {
    drawn(input(hour), settings_, size);
    return picture();
  }
};

/// What an allocation that failed was for, from between the quotes of the message.
std::string failed_at(const std::string& message) {
  const std::size_t from = message.find('\''), to = message.find('\'', from + 1);
  return from == std::string::npos ? message : message.substr(from + 1, to - from - 1);
}

TEST_F(FailedFrames, TriedAgainGiveTheBytesOfAnUndisturbedFrame) {
  start();
  const std::vector<std::uint8_t> morning = picture_at(9.0), later = picture_at(9.0),
                                  evening = picture_at(17.5), night = picture_at(23.0),
                                  larger = picture_at(23.0, kLarger);
  // The camera meters, so a second look at the same moment is the same picture.
  EXPECT_EQ(later, morning);
  EXPECT_NE(evening, morning);
  EXPECT_NE(night, evening);

  start();
  std::set<std::string> failed;
  int failures = 0;
  const auto disturbed = [&](double hour, VkExtent2D size) {
    std::uint64_t room = 0;
    for (int i = 0; i < 200; ++i) {
      // What has retired does not count: it would make room for what is to fail.
      device().run_now([](VkCommandBuffer) {});
      device().set_memory_budget(device().memory_total() + room);
      const Result<std::uint64_t> value = renderer().draw(input(hour), settings_, size);
      renderer().finish();
      if (value) break;
      failed.insert(failed_at(value.error().message));
      ++failures;
      room = room + room / 4 + 4096;
    }
    device().set_memory_budget(UINT64_MAX);
    return picture();
  };
  EXPECT_EQ(disturbed(9.0, kSize), morning);
  EXPECT_EQ(disturbed(9.0, kSize), later);
  // Another count of cascades and no clouds' sun: other maps, other images.
  EXPECT_EQ(disturbed(17.5, kSize), evening);
  EXPECT_EQ(disturbed(23.0, kSize), night);
  // What a frame makes for itself alone is made anew for another size.
  EXPECT_EQ(disturbed(23.0, kLarger), larger);
  EXPECT_GT(failures, 20);
  for (const char* name : {"shadow maps", "picture", "bloom 1"})
    EXPECT_TRUE(failed.contains(name))
        << name << " never failed, but " << testing::PrintToString(failed);
}

}  // namespace
}  // namespace skerry::render
