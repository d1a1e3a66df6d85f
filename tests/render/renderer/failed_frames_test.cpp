// A frame that fails half-way leaves nothing behind: tried again, it gives the bytes of a frame
// that nothing disturbed, and so does the next one, which keeps what that frame left.
#include <optional>
#include <set>
#include <string>

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

/// Draws frames of which each allocation fails once, one after another.
class Refusals {
 public:
  explicit Refusals(gpu::Device& device) : device_(device) {
    device_.set_allocation_gate([this](const std::string& name, std::uint64_t) {
      // What has not failed yet fails now, also where as many were granted: what is kept of the
      // frame before may have moved it up.
      if (names_.contains(name) && allowed_-- > 0) return true;
      if (!refused_now_) refused_now_ = name;
      return false;
    });
  }
  ~Refusals() { device_.set_allocation_gate({}); }

  /// @param draw tries once. @return whether it came to an end without being refused anything.
  template <class Draw>
  bool until_drawn(const Draw& draw) {
    // What a failed frame has made stays or not. What fails newly was the next one; then none more
    // is granted at first, so that none is passed over.
    constexpr int kMostTries = 2000;
    int granted = 0;
    for (int i = 0; i < kMostTries; ++i) {
      allowed_ = granted;
      refused_now_.reset();
      const Result<std::uint64_t> value = draw();
      if (!refused_now_) return static_cast<bool>(value);
      EXPECT_FALSE(value) << "a frame without " << *refused_now_;
      granted = names_.insert(*refused_now_).second ? 0 : granted + 1;
    }
    return false;
  }
  const std::set<std::string>& names() const { return names_; }

 private:
  gpu::Device& device_;
  int allowed_ = 0;
  std::optional<std::string> refused_now_;
  std::set<std::string> names_;
};

TEST_F(FailedFrames, TriedAgainGiveTheBytesOfAnUndisturbedFrame) {
  start();
  std::set<std::string> made;
  device().set_allocation_gate([&](const std::string& name, std::uint64_t) {
    made.insert(name);
    return true;
  });
  const std::vector<std::uint8_t> morning = picture_at(9.0), later = picture_at(9.0),
                                  evening = picture_at(17.5), night = picture_at(23.0),
                                  larger = picture_at(23.0, kLarger);
  device().set_allocation_gate({});
  made.erase("readback");  // the test's own
  // The camera meters, so a second look at the same moment is the same picture.
  EXPECT_EQ(later, morning);
  EXPECT_NE(evening, morning);
  EXPECT_NE(night, evening);

  start();
  std::set<std::string> failed;
  const auto disturbed = [&](double hour, VkExtent2D size) {
    {
      Refusals refusals(device());
      EXPECT_TRUE(refusals.until_drawn([&] {
        const Result<std::uint64_t> value = renderer().draw(input(hour), settings_, size);
        renderer().finish();
        return value;
      }));
      failed.insert(refusals.names().begin(), refusals.names().end());
    }
    return picture();
  };
  EXPECT_EQ(disturbed(9.0, kSize), morning);
  EXPECT_EQ(disturbed(9.0, kSize), later);
  // Another count of cascades and no clouds' sun: other maps, other images.
  EXPECT_EQ(disturbed(17.5, kSize), evening);
  EXPECT_EQ(disturbed(23.0, kSize), night);
  // What a frame makes for itself alone is made anew for another size.
  EXPECT_EQ(disturbed(23.0, kLarger), larger);
  EXPECT_GT(made.size(), 20u);
  for (const std::string& name : made) EXPECT_TRUE(failed.contains(name)) << name;
}

}  // namespace
}  // namespace skerry::render
