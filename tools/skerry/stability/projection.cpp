// Fields of view, picture sizes and distances at their ends: depth must still say where things
// are.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <string>

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

world::BlockId projected_ground(int, int y, int) {
  return y < 0 ? kGrass : kAirBlock;
}

std::uint32_t block_of(std::uint32_t word) {
  return shared::surface_block(word);
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
render::RenderSettings projection_settings() {
  render::RenderSettings out;
  out.shadow_enabled = false;
  return out;
}

struct DepthError {
  double over_allowed = 0.0;  ///< largest error over what is allowed where it is
  double pixels = 0.0;        ///< that were compared
};

/// Compares captured depth with the exact distance to the plane y = 0 for the pixels that show it.
/// Allowed: vertices snap to 1/256 pixel, so the plane's depth may be off by its slope times that
/// on both axes; and sixteen roundings of the depth straight below the eye, the largest of the
/// plane.
void compare_ground(const Frame& frame, const Camera& camera, DepthError& error) {
  const double height = static_cast<double>(camera.position[1]) / 65536.0;
  const auto depth_at = [&](std::uint32_t x, std::uint32_t y) {
    return static_cast<double>(render::kNearPlane) * -ray_of(camera, frame.size, x, y).y / height;
  };
  const double slope_x = std::abs(depth_at(1, 0) - depth_at(0, 0));
  const double slope_y = std::abs(depth_at(0, 1) - depth_at(0, 0));
  const double below = static_cast<double>(render::kNearPlane) / height;
  const double allowed = (slope_x + slope_y) / 256.0 + 16.0 * kHalfUlp * below;
  for (std::uint32_t y = 0; y < frame.size.height; ++y) {
    for (std::uint32_t x = 0; x < frame.size.width; ++x) {
      const std::size_t i = std::size_t{y} * frame.size.width + x;
      if (block_of(frame.words[i]) != kGrass || shared::surface_face(frame.words[i]) != 2u)
        continue;
      const double exact = depth_at(x, y), off = std::abs(frame.depth[i] - exact);
      error.over_allowed = std::max(error.over_allowed, off / allowed);
      ++error.pixels;
    }
  }
}

Result<std::unique_ptr<Stage>> ground_stage(gpu::Device& device) {
  auto stage = Stage::create(device);
  if (!stage) return stage;
  if (Result<void> added = (*stage)->add(projected_ground, {-2, -1, -2}, {2, 0, 2}); !added)
    return added.error();
  return stage;
}

/// Which part of compare_ground's allowance a driver may use: bounds that are those of the platform
/// where it was measured. Others, an H200 with driver 580 among them (0.085 to 0.50), get all of
/// it.
double bound_on(const gpu::Device& device, double lavapipe) {
  return device.info().driver.find("llvmpipe") == std::string::npos ? 1.0 : lavapipe;
}

Result<Rows> fields_of_view(gpu::Device& device) {
  auto stage = ground_stage(device);
  if (!stage) return stage.error();
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  Rows rows;
  for (const auto& [fov, lavapipe] :
       {std::pair{0.1, 0.25}, {1.0, 0.6}, {70.0, 0.04}, {175.0, 0.024}}) {
    DepthError error;
    double non_finite = 0.0, lit = 0.0;
    for (const double pitch : {-80.0, -30.0, -3.0}) {
      const Camera camera = camera_at({0.37, 1.62, 0.21}, 33.0, pitch, fov);
      const auto frame =
          (*stage)->draw(input_of(camera, islands), projection_settings(), {160, 90});
      if (!frame) return frame.error();
      compare_ground(*frame, camera, error);
      non_finite += non_finite_channels(frame->radiance);
      lit += lit_surfaces(*frame);
    }
    const std::string at = fmt::format(", field of view {}", fov);
    rows.push_back({"depth error over what snapping and rounding allow" + at,
                    bound_on(device, lavapipe), if_shown(error.pixels > 0.0, error.over_allowed)});
    rows.push_back({"channels that are not finite" + at, 0.0, if_shown(lit > 0.0, non_finite)});
  }
  return rows;
}

/// A wall of 64 x 64 voxels whose face towards -z is the lattice's plane z = 0.
BlockAt wall_of(world::BlockId block) {
  return [block](int x, int y, int z) {
    return z == 0 && x >= 0 && x < 64 && y >= 0 && y < 64 ? block : world::kAir;
  };
}

/// Edge of a voxel, as a power of two, of a wall wide enough to fill the view at a distance.
std::uint32_t voxel_size_log2_at(double distance) {
  return static_cast<std::uint32_t>(std::max(0.0, std::ceil(std::log2(distance / 8.0))));
}

/// Where a wall's lattice origin is so that its face is `distance` blocks along +z from the world's
/// origin, its lowest x at `left` and its middle at the eye's height.
IslandPlacement wall_at(double distance, double left) {
  const double voxel = std::exp2(voxel_size_log2_at(distance));
  IslandPlacement island{fixed_at({left, -32.0 * voxel, distance}), {1.0, 0.0, 0.0, 0.0}, 0.0};
  island.bounding_radius = 128.0 * voxel;
  return island;
}

constexpr std::array kDistances{0.01, 0.06, 1.0, 30.0, 1e3, 1e5, 1e6};

/// Walls from 0.01 to 10^6 blocks in one picture, each nearer one covering less of it. Looking
/// along +z, +x is on the left: every wall spans from its right end, right of the middle so that
/// its side cannot be seen, to beyond the left border.
Result<Rows> near_and_far(gpu::Device& device) {
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  const Camera camera = camera_at({0.0, 0.0, 0.0}, 0.0, 0.0);
  const VkExtent2D size{168, 94};
  const double tan_x = std::tan(glm::radians(35.0)) * size.width / size.height;
  std::vector<IslandPlacement> islands;
  for (std::size_t i = 0; i < kDistances.size(); ++i) {
    const double right_end = -static_cast<double>(i + 1) / kDistances.size();
    const double distance = kDistances[i];
    islands.push_back(wall_at(distance, right_end * tan_x * distance));
    if (Result<void> added =
            (*stage)->add(wall_of(kStone), {0, 0, 0}, {1, 1, 1}, static_cast<std::uint32_t>(i),
                          voxel_size_log2_at(distance));
        !added)
      return added.error();
  }
  const auto frame = (*stage)->draw(input_of(camera, islands), projection_settings(), size);
  if (!frame) return frame.error();
  double relative = 0.0;
  std::array<double, kDistances.size()> seen{};
  for (std::size_t i = 0; i < frame->words.size(); ++i) {
    if (frame->words[i] == 0) continue;
    const std::size_t wall = shared::surface_island(frame->words[i]);
    // Places are whole units: the wall is where rounding put it.
    const double exact = static_cast<double>(islands[wall].origin[2]) / 65536.0;
    relative =
        std::max(relative,
                 std::abs(static_cast<double>(render::kNearPlane) / frame->depth[i] / exact - 1.0));
    seen[wall] += 1.0;
  }
  const double fewest = *std::min_element(seen.begin(), seen.end());
  // Each wall shows in a seventh of half the width, less a pixel for its border.
  const double share = static_cast<double>((size.width / 2 / kDistances.size() - 1) * size.height);
  // A wall square to the view has one depth: near / w, each rounded, w from three products and
  // their sum, and three planar interpolations: eight roundings, half of them one way. Seen on
  // lavapipe and on an H200: 8.8e-8.
  return Rows{{"relative error of distance, walls at 0.01 to 1e6 blocks together", 4.0 * kHalfUlp,
               if_shown(fewest > 0.0, relative)},
              {"pixels missing of the wall that shows least", 0.0, std::max(0.0, share - fewest)},
              {"channels that are not finite, 0.01 to 1e6 blocks", 0.0,
               if_shown(lit_surfaces(*frame) > 0.0, non_finite_channels(frame->radiance))}};
}

/// Draws two parallel walls and counts the pixels that the farther one wins.
Result<double> lost_pixels(gpu::Device& device, double distance, double separation, double yaw_deg,
                           double pitch_deg) {
  double lost = 0.0;
  // Either order of drawing: the one drawn last wins ties.
  for (const std::size_t nearer : {0u, 1u}) {
    auto stage = Stage::create(device);
    if (!stage) return stage.error();
    const std::uint32_t log2 = voxel_size_log2_at(4.0 * distance);
    std::vector<IslandPlacement> islands;
    for (std::uint32_t i = 0; i < 2; ++i) {
      const double away = distance + (i == nearer ? 0.0 : separation);
      const double voxel = std::exp2(log2);
      islands.push_back(
          {fixed_at({-32.0 * voxel, -32.0 * voxel, away}), {1.0, 0.0, 0.0, 0.0}, 128.0 * voxel});
      if (Result<void> added =
              (*stage)->add(wall_of(i == nearer ? kStone : kSand), {0, 0, 0}, {1, 1, 1}, i, log2);
          !added)
        return added.error();
    }
    const Camera camera = camera_at({0.0, 0.0, 0.0}, yaw_deg, pitch_deg);
    const auto frame = (*stage)->draw(input_of(camera, islands), projection_settings(), {256, 144});
    if (!frame) return frame.error();
    for (const std::uint32_t word : frame->words) lost += block_of(word) != kStone;
  }
  return lost;
}

Result<Rows> close_surfaces(gpu::Device& device) {
  // Facing: depths are right to eight roundings (near_and_far), so distances 16 of them apart
  // differ: d / 2^20. Tilted: vertices snap by up to 1/512 pixel on each axis. A pixel is
  // 2 tan(35 degrees) / 144 = 0.0097 wide a block away; towards the planes' normal the rays' axes
  // have 0.42 and 0.31 of that, and the corner that sees the planes most askew has a ray of 0.109:
  // a distance changes by 0.065 d over a pixel on both axes, and by 2 * 0.065 d / 512 = d / 2^12
  // for two snapped planes.
  constexpr double kFacing = 1.0 / (1 << 20), kTilted = 1.0 / (1 << 12);
  constexpr double kUnit = 1.0 / 65536.0;
  double facing = 0.0, tilted = 0.0;
  for (const double distance : {0.05, 1.0, 30.0, 1e3, 1e5, 1e6}) {
    const auto flat =
        lost_pixels(device, distance, std::max(distance * kFacing, 2.0 * kUnit), 0.0, 0.0);
    if (!flat) return flat.error();
    facing += *flat;
    const auto steep =
        lost_pixels(device, distance, std::max(distance * kTilted, 2.0 * kUnit), 25.0, -20.0);
    if (!steep) return steep.error();
    tilted += *steep;
  }
  return Rows{
      {"pixels the farther of two facing walls wins, d/2^20 apart, d 0.05 to 1e6", 0.0, facing},
      {"pixels the farther of two tilted walls wins, d/2^12 apart, d 0.05 to 1e6", 0.0, tilted}};
}

/// Pictures of every shape: the ground must be where it is, and every pixel written.
Result<Rows> sizes(gpu::Device& device) {
  auto stage = ground_stage(device);
  if (!stage) return stage.error();
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  const std::uint32_t most = device.limits().max_image_edge;
  // Picture, G-buffer words and depth take 12 bytes a pixel: the square that fits 256 MiB.
  const std::uint32_t square = std::min(most, 4729u);
  const std::uint32_t wide = std::min(most, 16384u);
  struct Size {
    VkExtent2D size;
    const char* name;
    double lavapipe;
  };
  Rows rows;
  for (const auto& [size, name, lavapipe] : {Size{{1, 1}, "1x1", 4e-5},
                                             {{wide, 1}, "16384x1", 4e-4},
                                             {{most, 3}, "the longest edge by 3", 2e-3},
                                             {{3, most}, "3 by the longest edge", 0.2},
                                             {{square, square}, "4729x4729", 0.0}}) {
    FrameInput in = input_of(camera_at({0.37, 1.62, 0.21}, 33.0, -30.0), islands);
    in.capture = size.width != square;  // radiance would take as much memory again
    const auto frame = (*stage)->draw(in, projection_settings(), size);
    if (!frame) return frame.error();
    double unwritten = 0.0;
    for (std::size_t i = 3; i < frame->rgba.size(); i += 4) unwritten += frame->rgba[i] != 255;
    const bool lit = std::any_of(frame->rgba.begin(), frame->rgba.end(),
                                 [](std::uint8_t c) { return c != 0 && c != 255; });
    const std::string of = std::string(", ") + name;
    rows.push_back({"pixels not written or not finite" + of, 0.0,
                    if_shown(lit, unwritten + frame->report.pixels.non_finite)});
    if (!in.capture) continue;
    DepthError error;
    compare_ground(*frame, in.camera, error);
    rows.push_back({"depth error over what snapping and rounding allow" + of,
                    bound_on(device, lavapipe), if_shown(error.pixels > 0.0, error.over_allowed)});
  }
  double accepted = 0.0;
  for (const VkExtent2D size : {VkExtent2D{0, 8}, {8, 0}, {most + 1, 8}, {8, most + 1}})
    accepted +=
        static_cast<bool>((*stage)->draw(input_of({}, islands), projection_settings(), size));
  rows.push_back(
      {"pictures without pixels or over the device's limit that were drawn", 0.0, accepted});
  return rows;
}

constexpr Case kProjectionCases[] = {{"projection.fields_of_view", fields_of_view},
                                     {"projection.near_and_far", near_and_far},
                                     {"projection.close_surfaces", close_surfaces},
                                     {"projection.sizes", sizes}};

}  // namespace

std::span<const Case> projection_cases() {
  return kProjectionCases;
}

}  // namespace skerry::tools::stability
