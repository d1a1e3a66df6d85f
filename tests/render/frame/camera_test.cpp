#include "engine/render/frame/camera.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/render/random_scenes.h"
#include "tests/same_bits.h"

namespace skerry::render {
namespace {

Camera random_camera(RandomPlaces& random) {
  Camera camera;
  camera.yaw_deg = random.uniform(-720.0, 720.0);
  camera.pitch_deg = random.uniform(-89.9, 89.9);
  camera.fov_deg = random.uniform(5.0, 150.0);
  return camera;
}

glm::dvec4 clip(const CameraView& view, glm::dvec3 p) {
  return glm::dmat4(view.clip_from_world) * glm::dvec4(p, 1.0);
}

// Yaw 0 looks along +z with -x on the right hand; a quarter turn of yaw looks along +x.
TEST(CameraView, PutsKnownPointsOnTheEdgesOfThePicture) {
  Camera camera;
  camera.fov_deg = 90.0;  // tangent 1 vertically, 2 horizontally at 200x100
  const CameraView south = view_of(camera, 200, 100);
  const auto ndc = [](const CameraView& view, glm::dvec3 p) {
    const glm::dvec4 c = clip(view, p);
    return glm::dvec2(c.x, c.y) / c.w;
  };
  const auto near = [](glm::dvec2 a, glm::dvec2 b) { return glm::length(a - b) < 1e-6; };
  EXPECT_TRUE(near(ndc(south, {0, 0, 7}), {0, 0}));
  EXPECT_TRUE(near(ndc(south, {-14, 0, 7}), {1, 0}));
  EXPECT_TRUE(near(ndc(south, {14, 0, 7}), {-1, 0}));
  EXPECT_TRUE(near(ndc(south, {0, 7, 7}), {0, -1})) << "clip space is y down";
  EXPECT_TRUE(near(ndc(south, {0, -7, 7}), {0, 1}));
  camera.yaw_deg = 90.0;
  const CameraView east = view_of(camera, 200, 100);
  EXPECT_TRUE(near(ndc(east, {3, 0, 0}), {0, 0}));
  EXPECT_TRUE(near(ndc(east, {3, 0, 6}), {1, 0}));
  camera.yaw_deg = 0.0;
  camera.pitch_deg = 90.0;
  const CameraView up = view_of(camera, 200, 100);
  EXPECT_TRUE(near(ndc(up, {0, 3, 0}), {0, 0}));
  EXPECT_TRUE(near(ndc(up, {-6, 3, 0}), {1, 0})) << "looking up keeps the heading";
}

TEST(CameraView, ProjectsEveryPointByTheConventions) {
  RandomPlaces random(1);
  for (int i = 0; i < 2000; ++i) {
    const Camera camera = random_camera(random);
    const double width = static_cast<double>(random.whole(1, 4000));
    const double height = static_cast<double>(random.whole(1, 4000));
    const double x = random.uniform(0.0, width), y = random.uniform(0.0, height);
    const double distance = std::exp(random.uniform(std::log(0.05), std::log(1e6)));
    const glm::dvec3 p = ray_of(camera, x, y, width, height) * distance;
    const CameraView view =
        view_of(camera, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
    const glm::dvec4 c = clip(view, p);
    const double tolerance = 1e-5;
    EXPECT_NEAR(c.w / distance, 1.0, tolerance);
    EXPECT_NEAR((c.x / c.w * 0.5 + 0.5) * width, x + 0.5, tolerance * width);
    EXPECT_NEAR((c.y / c.w * 0.5 + 0.5) * height, y + 0.5, tolerance * height);
    EXPECT_NEAR(c.z / c.w * distance, static_cast<double>(kNearPlane), tolerance * kNearPlane)
        << "reverse-Z depth is near / distance";
  }
}

TEST(CameraView, HasDepthOneAtTheNearPlaneAndNoFarPlane) {
  const CameraView view = view_of({}, 640, 360);
  const auto depth = [&](double distance) {
    const glm::dvec4 c = clip(view, {0.0, 0.0, distance});
    return c.z / c.w;
  };
  EXPECT_EQ(depth(static_cast<double>(kNearPlane)), 1.0);
  EXPECT_GT(depth(0.99 * static_cast<double>(kNearPlane)), 1.0);
  EXPECT_GT(depth(1e12), 0.0);
  EXPECT_LT(depth(1e12), 1e-12);
}

TEST(CameraView, AxesAreOrthonormalAndScaledRaysMeetTheCorners) {
  RandomPlaces random(2);
  for (int i = 0; i < 500; ++i) {
    const CameraView view = view_of(random_camera(random), 320, 180);
    const glm::dvec3 r(view.right), u(view.up), f(view.forward);
    EXPECT_NEAR(glm::length(glm::cross(r, u) + f), 0.0, 1e-6);  // view space looks along -z
    EXPECT_NEAR(glm::length(r), 1.0, 1e-6);
    EXPECT_NEAR(glm::length(u), 1.0, 1e-6);
    const glm::dvec4 c = clip(view, f + r * static_cast<double>(view.tan_half_x) +
                                        u * static_cast<double>(view.tan_half_y));
    EXPECT_NEAR(c.x / c.w, 1.0, 1e-5);
    EXPECT_NEAR(c.y / c.w, -1.0, 1e-5);
  }
}

TEST(CameraView, PlanesHoldExactlyTheVisiblePoints) {
  RandomPlaces random(3);
  int inside_count = 0;
  for (int i = 0; i < 20000; ++i) {
    const Camera camera = random_camera(random);
    const CameraView view = view_of(camera, 640, 360);
    const Axes axes = axes_of(camera);
    const glm::dvec3 p =
        axes.forward * random.uniform(-1.0, 9.0) + random.in_box(random.uniform(0.1, 10.0));
    const glm::dvec4 c = clip(view, p);
    const double border =
        std::min({c.w - std::abs(c.x), c.w - std::abs(c.y), c.w - static_cast<double>(kNearPlane)});
    if (std::abs(border) < 1e-4 * (1.0 + std::abs(c.x) + std::abs(c.y))) continue;
    bool inside = true;
    for (const glm::vec4& plane : view.planes)
      inside = inside && glm::dot(glm::dvec3(plane), p) + static_cast<double>(plane.w) >= 0.0;
    EXPECT_EQ(inside, border > 0.0) << p.x << " " << p.y << " " << p.z;
    inside_count += inside ? 1 : 0;
  }
  EXPECT_GT(inside_count, 2000);
}

TEST(CameraView, PlanesAreUnitSoThatDistancesAreBlocks) {
  RandomPlaces random(4);
  for (int i = 0; i < 200; ++i) {
    const CameraView view = view_of(random_camera(random), 640, 360);
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_NEAR(glm::length(glm::dvec3(view.planes[k])), 1.0, 1e-6);
    EXPECT_EQ(view.planes[5], glm::vec4(0, 0, 0, 1));
  }
}

TEST(CameraView, IsTheSameToTheLastBitAnywhereInTheWorld) {
  RandomPlaces random(5);
  for (int i = 0; i < 50; ++i) {
    Camera camera = random_camera(random);
    const CameraView here = view_of(camera, 640, 360);
    for (const int bits : {24, 40}) {
      camera.position = {kUnits << bits, -(kUnits << bits), (kUnits << bits) + 1};
      const CameraView there = view_of(camera, 640, 360);
      EXPECT_TRUE(same_bits(here, there));
    }
  }
}

}  // namespace
}  // namespace skerry::render
