// Fields of view, picture sizes and distances at their ends: depth must still tell where things
// are.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using render::Camera;
using render::FrameInput;
using render::IslandPlacement;
using world::block::kAirBlock;
using world::block::kGrass;
using world::block::kSand;
using world::block::kStone;

constexpr double kHalfUlp = 1.0 / (1 << 24);  // of a float, relative

world::BlockId ground(int, int y, int) {
  return y < 0 ? kGrass : kAirBlock;
}

std::uint32_t block_of(std::uint32_t word) {
  return word & 0xffffu;
}

FrameInput input_of(const Camera& camera, std::span<const IslandPlacement> islands) {
  FrameInput in;
  in.camera = camera;
  in.islands = islands;
  in.sky = sun_towards({0.3, 1.0, -0.2});
  in.capture = true;
  return in;
}

/// Without shadow maps, which far things would stretch for nothing.
render::RenderSettings settings() {
  render::RenderSettings out;
  out.shadows = false;
  return out;
}

struct DepthError {
  double over_allowed = 0.0;  ///< largest error over what is allowed where it is
  double relative = 0.0;      ///< largest error of the distance over the distance
  double pixels = 0.0;        ///< that were compared
};

/// Compares captured depth with the exact distance to the plane y = 0 for the pixels that show it.
/// Allowed: vertices snap to 1/256 pixel, so the plane's depth may be off by its slope times that
/// on both axes; and sixteen roundings of the largest depth of a face. Faces reach behind the eye,
/// so that is 1.
void compare_ground(const Frame& frame, const Camera& camera, DepthError& error) {
  const double height = static_cast<double>(camera.position[1]) / 65536.0;
  const auto depth_at = [&](std::uint32_t x, std::uint32_t y) {
    return static_cast<double>(render::kNearPlane) * -ray_of(camera, frame.size, x, y).y / height;
  };
  const double slope_x = std::abs(depth_at(1, 0) - depth_at(0, 0));
  const double slope_y = std::abs(depth_at(0, 1) - depth_at(0, 0));
  const double allowed = (slope_x + slope_y) / 256.0 + 16.0 * kHalfUlp;
  for (std::uint32_t y = 0; y < frame.size.height; ++y) {
    for (std::uint32_t x = 0; x < frame.size.width; ++x) {
      const std::size_t i = std::size_t{y} * frame.size.width + x;
      if (block_of(frame.words[i]) != kGrass || (frame.words[i] >> 16 & 7u) != 2u) continue;
      const double exact = depth_at(x, y), off = std::abs(frame.depth[i] - exact);
      error.over_allowed = std::max(error.over_allowed, off / allowed);
      error.relative = std::max(error.relative, std::abs(exact / frame.depth[i] - 1.0));
      ++error.pixels;
    }
  }
}

Result<std::unique_ptr<Stage>> ground_stage(gpu::Device& device) {
  auto stage = Stage::create(device);
  if (!stage) return stage;
  if (Result<void> added = (*stage)->add(ground, {-2, -1, -2}, {2, 0, 2}); !added)
    return added.error();
  return stage;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Result<Rows> fields_of_view(gpu::Device& device) {
  auto stage = ground_stage(device);
  if (!stage) return stage.error();
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  Rows rows;
  for (const double fov : {0.1, 1.0, 70.0, 175.0}) {
    DepthError error;
    double non_finite = 0.0;
    for (const double pitch : {-80.0, -30.0, -3.0}) {
      const Camera camera = camera_at({0.37, 1.62, 0.21}, 33.0, pitch, fov);
      const auto frame = (*stage)->draw(input_of(camera, islands), settings(), {160, 90});
      if (!frame) return frame.error();
      compare_ground(*frame, camera, error);
      non_finite += non_finite_channels(frame->radiance);
    }
    const std::string at = ", field of view " + std::to_string(fov).substr(0, fov < 1.0     ? 3
                                                                              : fov < 10.0  ? 1
                                                                              : fov < 100.0 ? 2
                                                                                            : 3);
    std::fprintf(stderr, "fov %g relative %g pixels %g\n", fov, error.relative, error.pixels);
    rows.push_back({"depth error over what snapping and rounding allow" + at, 1.0,
                    error.pixels > 0.0 ? error.over_allowed : kNan});
    rows.push_back({"channels that are not finite" + at, 0.0, non_finite});
  }
  return rows;
}

constexpr Case kCases[] = {{"projection.fields_of_view", fields_of_view}};

}  // namespace

std::span<const Case> projection_cases() {
  return kCases;
}

}  // namespace skerry::tools::stability
