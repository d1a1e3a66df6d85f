#include "engine/render/light/cascades.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>

#include "engine/core/check.h"
#include "engine/render/frame/celestial.h"

namespace skerry::render {
namespace {

__extension__ using Int128 = __int128;

constexpr double kUnitsPerBlock = 65536.0;
constexpr int kAxisBits = 52;      // axes are rounded to multiples of 2^-52 for exact products
constexpr int kSnapDivisor = 16;   // a snap step is this part of the map's width
constexpr double kEdgeTexels = 8;  // spare ones: of the narrowest filter, and four more

using IntAxis = std::array<std::int64_t, 3>;

IntAxis rounded_axis(glm::dvec3 axis) {
  IntAxis result;
  for (int i = 0; i < 3; ++i) {
    result[static_cast<std::size_t>(i)] = std::llround(std::ldexp(axis[i], kAxisBits));
  }
  return result;
}

Int128 dot(const IntAxis& axis, const FixedPos& v) {
  return Int128{axis[0]} * v[0] + Int128{axis[1]} * v[1] + Int128{axis[2]} * v[2];
}

/// a / b rounded to nearest, halves up; b > 0.
std::int64_t nearest_multiple(Int128 a, Int128 b) {
  const Int128 shifted = a + b / 2;
  const Int128 quotient = shifted / b - (shifted % b < 0 ? 1 : 0);
  return static_cast<std::int64_t>(quotient);
}

/// Light-space layout of one map; lengths in units of 1/65536 block.
struct Window {
  std::int64_t texel, step, half;  // edge of a texel, snap step, half the map's width
  std::int64_t back, reach;        // extent from the centre to the far side and towards the light
};

std::int64_t snap_units(std::int64_t texel, int map_size) {
  return texel * std::max(1, map_size / kSnapDivisor);
}

Window window_of(const CascadeInput& in, double radius) {
  const double needed = radius + in.filter_blocks;
  // half >= needed + step / 2 + edge, where step = width / 16 and edge = kEdgeTexels texels.
  const double half = needed / (1.0 - 1.0 / kSnapDivisor - 2.0 * kEdgeTexels / in.map_size);
  Window w;
  // An even texel keeps half the width whole for odd map sizes.
  w.texel = 2 * static_cast<std::int64_t>(std::ceil(half * kUnitsPerBlock / in.map_size));
  w.step = snap_units(w.texel, in.map_size);
  w.half = w.texel * in.map_size / 2;
  w.back = static_cast<std::int64_t>(std::ceil(needed * kUnitsPerBlock)) + w.step / 2 + 1;
  w.reach = w.back + static_cast<std::int64_t>(std::ceil(in.caster_reach_blocks * kUnitsPerBlock));
  return w;
}

/// Clip from positions whose light-space coordinates relative to the window's centre are axes * p +
/// offset [blocks].
glm::mat4 clip_matrix(const std::array<glm::dvec3, 3>& axes, glm::dvec3 offset, const Window& w) {
  const double half = static_cast<double>(w.half) / kUnitsPerBlock;
  const double depth = static_cast<double>(w.back + w.reach) / kUnitsPerBlock;
  const glm::dvec3 scale{1.0 / half, -1.0 / half, 1.0 / depth};
  const glm::dvec3 shift =
      scale * offset + glm::dvec3(0.0, 0.0, static_cast<double>(w.back) / kUnitsPerBlock / depth);
  glm::mat4 m(0.0f);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      m[column][row] = static_cast<float>(scale[row] * axes[static_cast<std::size_t>(row)][column]);
    }
    m[3][column] = static_cast<float>(shift[column]);
  }
  m[3][3] = 1.0f;
  return m;
}

std::array<glm::vec4, 6> window_planes(const std::array<glm::dvec3, 3>& axes, glm::dvec3 offset,
                                       const Window& w) {
  const double half = static_cast<double>(w.half) / kUnitsPerBlock;
  const double back = static_cast<double>(w.back) / kUnitsPerBlock;
  const double reach = static_cast<double>(w.reach) / kUnitsPerBlock;
  const auto plane = [&](std::size_t axis, double sign, double extent) {
    return glm::vec4(glm::dvec4(sign * axes[axis], extent + sign * offset[static_cast<int>(axis)]));
  };
  return {plane(0, 1.0, half),  plane(0, -1.0, half), plane(1, 1.0, half),
          plane(1, -1.0, half), plane(2, 1.0, back),  plane(2, -1.0, reach)};
}

FixedPos from_pivot(const CascadeInput& in, const FixedPos& pivot) {
  FixedPos out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = in.camera[i] - in.anchor[i] - pivot[i];
  return out;
}

/// A window's snap step [units * 2^-52].
Int128 snap_step(const Window& w) {
  return Int128{w.step} << kAxisBits;
}

CascadeKey key_of(const CascadeInput& in, const std::array<glm::dvec3, 3>& axes, const Window& w) {
  CascadeKey key;
  key.texel_units = w.texel;
  key.depth_units = w.back + w.reach;
  key.back_units = w.back;
  key.map_size = in.map_size;
  key.pivot = in.pivot;
  for (std::size_t i = 0; i < 3; ++i) {
    const IntAxis axis = rounded_axis(axes[i]);
    std::copy(axis.begin(), axis.end(),
              key.light_axes.begin() + static_cast<std::ptrdiff_t>(3 * i));
    key.cell[i] = nearest_multiple(dot(axis, from_pivot(in, key.pivot)), snap_step(w));
  }
  return key;
}

/// With the radius that the map covers about the camera.
Cascade cascade_in(const CascadeInput& in, const std::array<glm::dvec3, 3>& axes, const Window& w,
                   const CascadeKey& key) {
  Cascade c;
  c.key = key;
  glm::dvec3
      camera_offset;  // the camera's light-space place relative to the snapped centre [blocks]
  std::array<Int128, 3> snapped;  // the centre's light-space place from the pivot [units * 2^-52]
  glm::dvec3 centre_from_pivot{0.0};  // [units]
  for (std::size_t i = 0; i < 3; ++i) {
    const Int128 place = dot(rounded_axis(axes[i]), from_pivot(in, key.pivot));
    snapped[i] = snap_step(w) * key.cell[i];
    camera_offset[static_cast<int>(i)] =
        std::ldexp(static_cast<double>(place - snapped[i]), -kAxisBits) / kUnitsPerBlock;
    centre_from_pivot += std::ldexp(static_cast<double>(snapped[i]), -kAxisBits) * axes[i];
  }
  // The centre must be a whole place in the world; what rounding moved it by goes into its matrix,
  // exactly.
  glm::dvec3 centre_offset;
  FixedPos rounded;
  for (std::size_t i = 0; i < 3; ++i) {
    rounded[i] = std::llround(centre_from_pivot[static_cast<int>(i)]);
    c.centre[i] = in.anchor[i] + key.pivot[i] + rounded[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Int128 place = dot(rounded_axis(axes[i]), rounded);
    centre_offset[static_cast<int>(i)] =
        std::ldexp(static_cast<double>(place - snapped[i]), -kAxisBits) / kUnitsPerBlock;
  }
  c.clip_from_world = clip_matrix(axes, camera_offset, w);
  c.clip_from_centre = clip_matrix(axes, centre_offset, w);
  c.planes = window_planes(axes, camera_offset, w);
  const glm::dvec3 aside = glm::abs(camera_offset);
  const double width = static_cast<double>(w.half) - kEdgeTexels * static_cast<double>(w.texel);
  const double covered = std::min(width / kUnitsPerBlock - std::max(aside.x, aside.y),
                                  static_cast<double>(w.back) / kUnitsPerBlock - aside.z);
  c.radius = static_cast<float>(covered - in.filter_blocks);
  c.texel_blocks = static_cast<float>(static_cast<double>(w.texel) / kUnitsPerBlock);
  c.depth_blocks = static_cast<float>(static_cast<double>(w.back + w.reach) / kUnitsPerBlock);
  return c;
}

Cascade cascade_about(const CascadeInput& in, const std::array<glm::dvec3, 3>& axes,
                      double radius) {
  const Window w = window_of(in, radius);
  Cascade c = cascade_in(in, axes, w, key_of(in, axes, w));
  c.radius = static_cast<float>(radius);
  return c;
}

void check_cascade_input(const CascadeInput& input) {
  SKERRY_ASSERT(std::isfinite(glm::dot(input.to_light, input.to_light)) &&
                glm::dot(input.to_light, input.to_light) > 0.0);
  SKERRY_ASSERT(input.near_blocks > 0.0 && input.near_blocks < input.far_blocks &&
                input.far_blocks <= 1e6);
  SKERRY_ASSERT(input.caster_reach_blocks >= 0.0 && input.caster_reach_blocks <= 1e7);
  SKERRY_ASSERT(input.filter_blocks >= 0.0 && input.filter_blocks <= 1e6);
  SKERRY_ASSERT(input.map_size >= 64 && input.map_size <= 16384);
  SKERRY_ASSERT(input.count >= 1 && input.count <= kCascadeCount);
}

}  // namespace

std::array<glm::vec4, 6> planes_about(const Cascade& cascade, const VkRect2D& part) {
  std::array<glm::vec4, 6> planes = cascade.planes;
  const float texel = 2.0f / static_cast<float>(cascade.key.map_size);  // in clip coordinates
  const std::array<int, 2> first{part.offset.x, part.offset.y};
  const std::array<std::uint32_t, 2> count{part.extent.width, part.extent.height};
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::vec4 row = glm::row(cascade.clip_from_world, static_cast<int>(i));
    const float low = texel * static_cast<float>(first[i] - 1) - 1.0f;
    const float high = low + texel * static_cast<float>(count[i] + 2);
    const float length = glm::length(glm::vec3(row));
    planes[2 * i] = glm::vec4(glm::vec3(row), row.w - low) / length;
    planes[2 * i + 1] = glm::vec4(-glm::vec3(row), high - row.w) / length;
  }
  return planes;
}

std::vector<double> cascade_radii(double near_blocks, double far_blocks, int count, double split) {
  // F. Zhang et al., Parallel-Split Shadow Maps for Large-Scale Virtual Environments, VRCIA 2006.
  std::vector<double> radii;
  for (int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i + 1) / count;
    const double logarithmic = near_blocks * std::pow(far_blocks / near_blocks, t);
    const double uniform = near_blocks + (far_blocks - near_blocks) * t;
    radii.push_back(split * logarithmic + (1.0 - split) * uniform);
  }
  radii.back() = far_blocks;
  return radii;
}

std::array<glm::dvec3, 3> light_axes(glm::dvec3 to_light) {
  const glm::dvec3 back = glm::normalize(to_light);
  glm::dvec3 right = glm::cross(kCelestialPole, back);
  constexpr double kAtPole =
      1e-3;  // sine of the angle to the pole, where no sun or moon ever stands
  if (glm::dot(right, right) < kAtPole * kAtPole)
    right = glm::cross(glm::dvec3(0.0, 0.0, 1.0), back);
  right = glm::normalize(right);
  return {right, glm::cross(back, right), back};
}

Cascade cascade_of(const CascadeKey& key, const CascadeInput& input) {
  Window w{};
  w.texel = key.texel_units;
  w.step = snap_units(w.texel, key.map_size);
  w.half = w.texel * key.map_size / 2;
  w.back = key.back_units;
  w.reach = key.depth_units - key.back_units;
  return cascade_in(input, light_axes(input.to_light), w, key);
}

Cascade make_cascade(const CascadeInput& input, int index) {
  check_cascade_input(input);
  SKERRY_ASSERT(index >= 0 && index < input.count);
  const std::vector<double> radii =
      cascade_radii(input.near_blocks, input.far_blocks, input.count, input.split);
  return cascade_about(input, light_axes(input.to_light), radii[static_cast<std::size_t>(index)]);
}

std::vector<Cascade> make_cascades(const CascadeInput& input) {
  check_cascade_input(input);
  const std::array<glm::dvec3, 3> axes = light_axes(input.to_light);
  std::vector<Cascade> cascades;
  for (const double radius :
       cascade_radii(input.near_blocks, input.far_blocks, input.count, input.split))
    cascades.push_back(cascade_about(input, axes, radius));
  return cascades;
}

}  // namespace skerry::render
