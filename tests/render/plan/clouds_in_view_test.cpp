// Whether clouds can show, against rays and clipped boxes in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/render/plan/in_view.h"
#include "tests/render/random_scenes.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{640, 360};

Camera random_camera(RandomPlaces& random) {
  return camera_at({}, random.uniform(0.0, 360.0), random.uniform(-89.0, 89.0),
                   random.uniform(20.0, 110.0));
}

shared::FrameConstants frame_of(const Camera& camera) {
  FrameInput input;
  input.camera = camera;
  return build_tables(input, {}, kSize, {}).constants;
}

/// Whether a ray through any pixel is in the layer before it has faded out.
bool rays_meet(const shared::CloudLayer& layer, const Camera& camera) {
  const double height = layer.place.y, top = layer.thickness;
  for (double y = 0.0; y < kSize.height; y += 0.5)
    for (double x = 0.0; x < kSize.width; x += 8.0) {
      const double rise = glm::normalize(ray_of(camera, x, y, kSize.width, kSize.height)).y;
      const double to = height < 0.0 ? -height / rise : (top - height) / rise;
      if (height >= 0.0 && height <= top) return true;
      if (to > 0.0 && to < double{shared::kLayerFadeEnd}) return true;
    }
  return false;
}

TEST(CloudsInView, AreWhereARayMeetsTheLayer) {
  RandomPlaces random(21);
  int seen = 0, unseen = 0, needless = 0;
  constexpr int kRounds = 600;
  for (int i = 0; i < kRounds; ++i) {
    const Camera camera = random_camera(random);
    shared::CloudConstants clouds{};
    clouds.layer.thickness = static_cast<float>(random.uniform(10.0, 600.0));
    clouds.layer.place.y = static_cast<float>(random.uniform(-1500.0, 1500.0));
    const bool told = clouds_in_view(clouds, true, 0, frame_of(camera));
    EXPECT_FALSE(clouds_in_view(clouds, false, 0, frame_of(camera))) << "there is no layer";
    if (rays_meet(clouds.layer, camera)) {
      EXPECT_TRUE(told) << "round " << i;
      ++seen;
    } else {
      ++(told ? needless : unseen);
    }
  }
  EXPECT_GT(seen, kRounds / 4);
  EXPECT_GT(unseen, kRounds / 8);
  EXPECT_LT(needless, kRounds / 25);
}

TEST(CloudsInView, AreWhereAnEyeIsWithinTheLayerOrJustBesideIt) {
  for (const float height : {-0.001f, 0.0f, 100.0f, 200.0f, 200.001f})
    for (const double pitch : {-89.0, 0.0, 89.0}) {
      shared::CloudConstants clouds{};
      clouds.layer.thickness = 200.0f;
      clouds.layer.place.y = height;
      EXPECT_TRUE(clouds_in_view(clouds, true, 0, frame_of(camera_at({}, 30.0, pitch)))) << height;
    }
}

/// A turned box in the world, and the same as a volume of clouds.
struct RandomVolume {
  explicit RandomVolume(RandomPlaces& random) {
    const glm::dquat turn = random.turn();
    const glm::dvec3 at = random.in_box(300.0);
    const double voxel = random.uniform(0.2, 4.0);
    const glm::dvec3 low = random.in_box(20.0), size = glm::abs(random.in_box(60.0));
    for (std::size_t i = 0; i < box.size(); ++i)
      box[i] = at + turn * (voxel *
                            (low + size * glm::dvec3(i & 1 ? 1 : 0, i & 2 ? 1 : 0, i & 4 ? 1 : 0)));
    const glm::dmat3 index_from_world = glm::mat3_cast(glm::conjugate(turn)) / voxel;
    const auto row = [&](int r) {
      const glm::dvec3 axis(index_from_world[0][r], index_from_world[1][r], index_from_world[2][r]);
      return glm::vec4(glm::dvec4(axis, -glm::dot(axis, at)));
    };
    volume.index_x = row(0);
    volume.index_y = row(1);
    volume.index_z = row(2);
    volume.low = glm::vec3(low);
    volume.high = glm::vec3(low + size);
  }
  Box box;
  shared::CloudVolume volume{};
};

TEST(CloudsInView, AreWhereClippingLeavesAVolume) {
  RandomPlaces random(22);
  int seen = 0, unseen = 0, needless = 0;
  constexpr int kRounds = 4000;
  for (int i = 0; i < kRounds; ++i) {
    const Camera camera = random_camera(random);
    const RandomVolume here(random), behind(random);
    shared::CloudConstants clouds{};
    clouds.volumes[0] = here.volume;
    clouds.volumes[1] = behind.volume;
    const bool told = clouds_in_view(clouds, false, 1, frame_of(camera));
    const auto planes = frustum_of(camera, kSize.width, kSize.height);
    if (box_meets(here.box, planes)) {
      EXPECT_TRUE(told) << "round " << i;
      ++seen;
    } else {
      ++(told ? needless : unseen);
    }
    shared::CloudConstants alone{};
    alone.volumes[0] = behind.volume;
    EXPECT_EQ(clouds_in_view(clouds, false, 2, frame_of(camera)),
              told || clouds_in_view(alone, false, 1, frame_of(camera)));
  }
  EXPECT_GT(seen, kRounds / 20);
  EXPECT_GT(unseen, kRounds / 4);
  EXPECT_LT(needless, kRounds / 10);
}

}  // namespace
}  // namespace skerry::render
