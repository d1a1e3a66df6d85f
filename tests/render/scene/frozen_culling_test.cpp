// Culling changes no picture, and can be frozen to look at it from elsewhere.
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{160, 96};

/// Pillars, leaves and ponds here and there.
world::BlockId grove(int x, int y, int z) {
  const int cell = (x / 9 * 5 + z / 7 * 3) % 11;
  if (y < 0) return cell == 4 && y == -1 ? world::block::kWater : world::block::kGrass;
  if (cell == 2 && x % 9 == 4 && z % 7 == 3 && y < 9) return world::block::kOakLog;
  if (cell == 2 && y >= 6 && y < 10) return world::block::kOakLeaves;
  return cell == 7 && x % 9 == 1 && y < 3 ? world::block::kBricks : world::block::kAirBlock;
}

class FrozenCulling : public RendererOnGpu {
 protected:
  void SetUp() override {
    RendererOnGpu::SetUp();
    if (HasFatalFailure()) return;
    add(grove, {-2, -1, -2}, {2, 1, 2});
    input_.islands = islands_;
    input_.sky = sun_at(40.0, 30.0);
  }
  const std::vector<IslandPlacement> islands_{
      {{}, glm::angleAxis(0.2, glm::dvec3(0.0, 1.0, 0.0)), 300.0}};
  FrameInput input_;
};

TEST_F(FrozenCulling, APictureIsTheSameWithAWiderFrustum) {
  RandomPlaces random(1);
  for (int i = 0; i < 12; ++i) {
    input_.camera =
        camera_at({random.uniform(-60, 60), random.uniform(1.5, 12), random.uniform(-60, 60)},
                  random.uniform(0, 360), random.uniform(-40, 20), 55.0);
    input_.freeze_culling = false;
    const FrameReport culled = drawn(input_, {}, kSize);
    const std::vector<std::uint8_t> expected = picture();
    const double fov = input_.camera.fov_deg;
    input_.camera.fov_deg = 170.0;
    input_.freeze_culling = true;
    drawn(input_, {}, kSize);
    input_.camera.fov_deg = fov;
    const FrameReport wide = drawn(input_, {}, kSize);
    EXPECT_EQ(picture(), expected) << "view " << i;
    EXPECT_GT(wide.camera.sections_passed, culled.camera.sections_passed);
  }
}

TEST_F(FrozenCulling, KeepsItsDrawsWhileTheCameraTurnsAndMoves) {
  input_.camera = camera_at({3.0, 4.0, 5.0}, 20.0, -10.0, 50.0);
  const FrameReport before = drawn(input_, {}, kSize);
  input_.freeze_culling = true;
  drawn(input_, {}, kSize);
  for (const double yaw : {20.0, 110.0, 200.0, 290.0}) {
    input_.camera.yaw_deg = yaw;
    input_.camera.position = fixed_at({3.0 + yaw / 10.0, 6.0, 5.0});
    const FrameReport frozen = drawn(input_, {}, kSize);
    EXPECT_EQ(frozen.camera.sections_passed, before.camera.sections_passed) << yaw;
    EXPECT_EQ(frozen.camera.quads, before.camera.quads) << yaw;
    EXPECT_EQ(frozen.camera.draws, before.camera.draws) << yaw;
  }
  input_.freeze_culling = false;
  const FrameReport after = drawn(input_, {}, kSize);
  EXPECT_NE(after.camera.quads, before.camera.quads) << "the camera looks elsewhere now";
}

}  // namespace
}  // namespace skerry::render
