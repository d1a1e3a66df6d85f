#include "world/vdb_import/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

namespace skerry::world {
namespace {

// Share of a voxel's edge by which a matrix may miss whole blocks and still be taken for them: what
// single precision in the program that wrote the file leaves.
constexpr double kSlack = 1e-6;

bool near(double a, double b, double scale) {
  return std::abs(a - b) <= kSlack * scale;
}

glm::dmat3 about_y(double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {{c, 0.0, -s}, {0.0, 1.0, 0.0}, {s, 0.0, c}};
}

glm::dmat3 axes(UpAxis up) {
  if (up == UpAxis::kY) return glm::dmat3(1.0);
  return {{1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};  // (x, y, z) to (x, z, -y)
}

/// Whether a matrix only scales, evenly and by whole blocks or by the whole part of one, and swaps
/// or mirrors axes. Then it is made exact.
bool snap_to_axes(glm::dmat3& m) {
  const double size = std::cbrt(std::abs(glm::determinant(m)));
  const double whole = std::max(1.0, std::floor(size + 0.5));
  if (!near(size, whole, size)) return false;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      double& element = m[column][row];
      const double wanted = std::abs(element) < 0.5 * size ? 0.0 : std::copysign(whole, element);
      if (!near(element, wanted, size)) return false;
      element = wanted;
    }
  }
  return true;
}

/// The turn about +y in a matrix of grids that stand upright, evenly scaled; else 0.
double yaw_of(const glm::dmat3& from_upright) {
  const glm::dvec3 x = from_upright[0], y = from_upright[1], z = from_upright[2];
  const double size = glm::length(y);
  const bool upright = near(y.x, 0.0, size) && near(y.z, 0.0, size) && y.y > 0.0 &&
                       near(x.y, 0.0, size) && near(z.y, 0.0, size);
  const bool even =
      near(glm::length(x), size, size) && near(x.x, z.z, size) && near(x.z, -z.x, size);
  return upright && even ? std::atan2(-x.z, x.x) : 0.0;
}

/// How far outwards from a solid voxel its solid reaches: 0..1 voxel.
double reach_of(const VolumeField& field, const SolidRule& rule, IVec3 at, int axis, int step) {
  if (rule.nearest) return 0.5;
  const double inside = static_cast<double>(field.at(at));
  (axis == 0 ? at.x : axis == 1 ? at.y : at.z) += step;
  const float value = field.at(at);
  if (rule(value)) return 1.0;  // that voxel, or a tile, goes on from here
  const double outside = static_cast<double>(value);
  return (static_cast<double>(rule.threshold) - inside) / (outside - inside);
}

}  // namespace

Affine Affine::inverse() const {
  const glm::dmat3 back = glm::inverse(linear);
  return {back, -(back * shift)};
}

Bounds Bounds::none() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
}

void Bounds::add(glm::dvec3 point) {
  low = glm::min(low, point);
  high = glm::max(high, point);
}

Bounds image_of(const Affine& map, const Bounds& box) {
  Bounds out = Bounds::none();
  for (int corner = 0; corner < 8; ++corner) {
    out.add(
        map({(corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
             (corner & 4) != 0 ? box.high.z : box.low.z}));
  }
  return out;
}

Affine blocks_from_index(const VolumeGrid& grid, double blocks_per_unit, UpAxis up) {
  const glm::dmat4& m = grid.world_from_index;
  const glm::dmat3 turn = axes(up) * blocks_per_unit;
  return {turn * glm::dmat3(m), turn * glm::dvec3(m[3])};
}

double voxel_size(const VolumeGrid& grid) {
  return std::cbrt(std::abs(glm::determinant(glm::dmat3(grid.world_from_index))));
}

Bounds content_of(const VolumeField& field, const SolidRule& rule) {
  Bounds box = Bounds::none();
  const auto add = [&](IVec3 low, IVec3 high) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const auto& [at, step] : {std::pair(low, -1), std::pair(high, 1)}) {
        const double place = std::array{at.x, at.y, at.z}[static_cast<std::size_t>(axis)];
        // No reach exceeds one voxel, so that most voxels need no closer look.
        if (step < 0 ? place - 1.0 >= box.low[axis] : place + 1.0 <= box.high[axis]) continue;
        const double edge = place + step * reach_of(field, rule, at, axis, step);
        box.low[axis] = std::min(box.low[axis], edge);
        box.high[axis] = std::max(box.high[axis], edge);
      }
    }
  };
  for (const VolumeTile& tile : field.grid().tiles) {
    const std::int32_t last = tile.edge - 1;
    const IVec3& at = tile.origin;
    if (rule(tile.value)) add(at, {at.x + last, at.y + last, at.z + last});
  }
  for (const VolumeBrick& brick : field.grid().bricks) {
    for (std::int32_t i = 0; i < 512; ++i) {
      if (!rule(brick.values[static_cast<std::size_t>(i)])) continue;
      const IVec3& at = brick.origin;
      const IVec3 voxel{at.x + (i >> 6), at.y + (i >> 3 & 7), at.z + (i & 7)};
      add(voxel, voxel);
    }
  }
  return box;
}

Result<Placement> place(const VolumeGrid& grid, const Bounds& content, double blocks_per_unit,
                        UpAxis up) {
  const Affine to_blocks = blocks_from_index(grid, blocks_per_unit, up);
  const glm::dvec3 corner = glm::floor((content.low + content.high) * 0.5) - 0.5;
  const glm::dvec3 origin = to_blocks(corner);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(origin[axis]) <= static_cast<double>(kMaxBlock)))
      return Error{"it lies beyond the world's edge, 2^40 blocks from its origin"};
  }
  Placement out;
  out.origin = moved({}, origin);
  out.yaw_rad = yaw_of(to_blocks.linear * glm::inverse(axes(up)));
  glm::dmat3 linear = about_y(-out.yaw_rad) * to_blocks.linear;
  out.exact = snap_to_axes(linear);
  out.lattice_from_index = {linear, -(linear * corner)};
  out.index_from_lattice = out.lattice_from_index.inverse();
  return out;
}

}  // namespace skerry::world
