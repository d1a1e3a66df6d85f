// Shadows against exact geometry: no acne on what is lit, edges where they belong, contact at the
// base. Looks at the debug view that shows the share of light a pixel gets.
#include "tests/render/renderer_on_gpu.h"

#include <algorithm>

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{160, 100};

world::BlockId plane(int, int y, int) {
  return y < 0 ? world::block::kStone : world::block::kAirBlock;
}

class SunShadows : public RendererOnGpu {
 protected:
  static RenderSettings shadow_view() {
    RenderSettings settings;
    settings.debug_view = DebugView::kShadow;
    return settings;
  }
  /// Share of light of every pixel, 0..255.
  std::vector<std::uint8_t> light(const FrameInput& input, const RenderSettings& settings) {
    drawn(input, settings, kSize);
    const std::vector<std::uint8_t> pixels = picture();
    std::vector<std::uint8_t> share;
    for (std::size_t i = 0; i < pixels.size(); i += 4) share.push_back(pixels[i]);
    return share;
  }
  static std::vector<IslandPlacement> turned(double yaw_deg) {
    return {{{}, glm::angleAxis(yaw_deg * M_PI / 180.0, glm::dvec3(0.0, 1.0, 0.0)), 5000.0}};
  }
};

/// Light on an open plane from this height up: one pixel below 255 is acne.
struct Height {
  double blocks;
  std::uint32_t voxel_size_log2;  // of the plane: wide enough to fill the view
};

void PrintTo(const Height& height, std::ostream* out) {
  *out << height.blocks << " blocks";
}

class OpenPlane : public SunShadows, public testing::WithParamInterface<Height> {};

TEST_P(OpenPlane, IsFullyLitUnderEverySun) {
  const auto [height, level] = GetParam();
  add(plane, {-1, -1, -1}, {1, 0, 1}, 0, level);
  for (const double island_yaw : {0.0, 27.0}) {
    const std::vector<IslandPlacement> islands = turned(island_yaw);
    for (const double altitude : {5.0, 8.0, 15.0, 30.0, 60.0, 90.0}) {
      for (int azimuth = 0; azimuth < 360; azimuth += altitude == 90.0 ? 360 : 45) {
        FrameInput input;
        input.islands = islands;
        input.sky = sun_at(altitude, azimuth + 3.0);
        input.camera = camera_at({0.3, height, 0.7}, 33.0, -60.0, 50.0);
        const std::vector<std::uint8_t> share = light(input, shadow_view());
        EXPECT_EQ(std::count(share.begin(), share.end(), 255), std::ssize(share))
            << "sun at " << altitude << ", " << azimuth << "; island turned by " << island_yaw;
      }
    }
  }
}

std::string height_name(const testing::TestParamInfo<Height>& height) {
  return "Height" + std::to_string(static_cast<int>(height.param.blocks));
}

INSTANTIATE_TEST_SUITE_P(From, OpenPlane,
                         testing::Values(Height{1.7, 0}, Height{20.0, 1}, Height{90.0, 3},
                                         Height{300.0, 4}),
                         height_name);

constexpr double kCube = 4.0;  // edge [blocks], its lowest corner is the lattice's origin

world::BlockId cube_on_plane(int x, int y, int z) {
  const bool cube = std::min({x, y, z}) >= 0 && std::max({x, y, z}) < static_cast<int>(kCube);
  return cube || y < 0 ? world::block::kStone : world::block::kAirBlock;
}

/// Whether a ray, from its start on, meets the cube grown by `more` on all sides but below.
bool meets_cube(glm::dvec3 from, glm::dvec3 along, double more) {
  double enter = 0.0, leave = 1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = axis == 1 ? 0.0 : -more, high = kCube + more;
    const double a = (low - from[axis]) / along[axis], b = (high - from[axis]) / along[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

/// -1: the plane is in the shadow with all points that a filter of this radius, across the light,
/// can reach; +1: lit with all of them; 0: the edge is near.
int expected_light(glm::dvec3 p, glm::dvec3 to_light, double radius) {
  const std::array<glm::dvec3, 3> axes = light_axes(to_light);
  bool all_lit = true, all_dark = true;
  for (int i = 0; i < 24; ++i) {
    const double angle = i * 2.0 * M_PI / 24.0;
    const glm::dvec3 across = (axes[0] * std::cos(angle) + axes[1] * std::sin(angle)) * radius;
    const glm::dvec3 q = p + across - to_light * (across.y / to_light.y);  // back onto the plane
    const bool dark = meets_cube({q.x, 0.0, q.z}, to_light, 0.0);
    all_lit = all_lit && !dark;
    all_dark = all_dark && dark;
  }
  return all_lit ? 1 : all_dark ? -1 : 0;
}

TEST_F(SunShadows, ACubesShadowLiesWhereTheGeometrySaysAndTouchesItsBase) {
  add(cube_on_plane, {-1, -1, -1}, {1, 1, 1});
  const RenderSettings settings = shadow_view();
  const double texel = 0.08;  // of the first cascade, checked below
  const double radius = std::max(static_cast<double>(settings.shadow_blur), 1.0 * texel);
  int dark_seen = 0, at_base = 0;
  for (const double island_yaw : {0.0, 27.0}) {
    const std::vector<IslandPlacement> islands = turned(island_yaw);
    const glm::dquat lattice_from_world = glm::inverse(islands[0].rotation);
    for (const double altitude : {15.0, 30.0, 45.0, 60.0, 80.0}) {
      for (int azimuth = 0; azimuth < 360; azimuth += 72) {
        FrameInput input;
        input.islands = islands;
        input.sky = sun_at(altitude, azimuth + 11.0);
        // From the side the shadow falls to, so that the cube does not hide its foot.
        const glm::dvec3 away =
            -glm::normalize(glm::dvec3(input.sky.to_sun.x, 0, input.sky.to_sun.z));
        const glm::dvec3 middle = islands[0].rotation * glm::dvec3(kCube / 2, 0.0, kCube / 2);
        const glm::dvec3 eye = middle + away * 14.0 + glm::dvec3(0.0, 11.0, 0.0);
        input.camera = camera_at(eye, std::atan2(-away.x, -away.z) * 180.0 / M_PI, -40.0, 55.0);
        const std::vector<std::uint8_t> share = light(input, settings);
        const glm::dvec3 to_light = lattice_from_world * input.sky.to_sun;
        const glm::dvec3 origin = lattice_from_world * blocks_at(input.camera.position);
        int wrong = 0;
        for (std::uint32_t i = 0; i < share.size(); ++i) {
          const double x = i % kSize.width, y = i / kSize.width;
          const glm::dvec3 ray =
              lattice_from_world * ray_of(input.camera, x, y, kSize.width, kSize.height);
          const glm::dvec3 p = origin - ray * (origin.y / ray.y);
          if (ray.y >= 0.0 || std::abs(p.x) > 60.0 || std::abs(p.z) > 60.0) continue;
          if (meets_cube(origin, ray, 1e-3)) continue;
          // Cracks between quads are another test's matter (geometry_test.cpp).
          if (std::abs(p.x - std::round(p.x)) < 2e-3 || std::abs(p.z - std::round(p.z)) < 2e-3)
            continue;
          const int expected = expected_light(p, to_light, 2.0 * texel + radius);
          if (expected == 0) continue;
          wrong += share[i] != (expected > 0 ? 255 : 0) ? 1 : 0;
          dark_seen += expected < 0 ? 1 : 0;
          const double outside = std::max({-p.x, p.x - kCube, -p.z, p.z - kCube});
          at_base += expected < 0 && outside < 0.1 ? 1 : 0;
        }
        EXPECT_EQ(wrong, 0) << "sun at " << altitude << ", " << azimuth << "; island turned by "
                            << island_yaw;
      }
    }
  }
  EXPECT_GT(dark_seen, 20000);
  EXPECT_GT(at_base, 300) << "pixels within a tenth of a block of the cube's foot were looked at";
  CascadeInput in;
  in.filter_blocks = 2.0 * static_cast<double>(settings.shadow_blur);
  EXPECT_LE(static_cast<double>(make_cascades(in)[0].texel_blocks), texel);
}

// At sunset the maps become those of the moon alone, at sunrise those of both, within one array.
TEST_F(SunShadows, ADayThatFollowsAnotherAllocatesNoMemory) {
  add(plane, {-1, -1, -1}, {1, 0, 1}, 0, 0);
  const std::vector<IslandPlacement> islands = turned(27.0);
  FrameInput input;
  input.islands = islands;
  input.camera = camera_at({0.3, 10.0, 0.7}, 33.0, -60.0, 50.0);
  RenderSettings settings;
  settings.shadow_size = 256;
  int changes = 0;
  std::uint64_t for_both = 0;
  for (int day = 0; day < 2; ++day)
    for (double hour = 0.0; hour < 24.0; hour += 0.25) {
      const Celestial before = input.sky;
      input.sky = celestial_at(hour * 3600.0, 0.5);
      ASSERT_TRUE(input.sky.sun_casts || input.sky.moon_casts) << hour;
      const FrameReport report = drawn(input, settings, kSize);
      if (day == 0) {
        if (hour > 0.0) for_both += report.allocations;
        continue;
      }
      changes += before.sun_casts != input.sky.sun_casts;
      changes += before.moon_casts != input.sky.moon_casts;
      EXPECT_EQ(report.allocations, 0u) << hour;
    }
  EXPECT_GT(for_both, 0u) << "of the array for both, at the first twilight";
  EXPECT_EQ(changes, 4) << "each of the two rises and sets";
}

}  // namespace
}  // namespace skerry::render
