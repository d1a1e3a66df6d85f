#include "world/light/opening_ray_ways.h"

#include <algorithm>
#include <bit>

#include "world/light/glass_tints.h"

namespace skerry::world {
namespace {

/// A way through a box by numbers of bits, and a register with the steps that are left along each
/// axis until the box ends, each with a bit above it that is cleared when there are none.
class BitWalk {
 public:
  BitWalk(const VoxelBits& box, const OpeningRay& ray, IVec3 from)
      : low_{box.low().x, box.low().y, box.low().z},
        size_{box.size().x, box.size().y, box.size().z},
        to_next_{box.bit_step({1, 0, 0}), box.bit_step({0, 1, 0}), 1, 0},
        bit_(box.bit_at(from)) {
    const std::array<int, 3> at{from.x, from.y, from.z};
    for (std::size_t a = 0; a < 3; ++a) {
      up_[a] = ray.step[a] > 0;
      if (!up_[a]) to_next_[a] = -to_next_[a];
      one_[a] = std::uint64_t{1} << place_of(a);
      const int left = up_[a] ? low_[a] + size_[a] - 1 - at[a] : at[a] - low_[a];
      left_ |= (kNone + static_cast<std::uint64_t>(left)) << place_of(a);
    }
  }
  /// @return whether it is inside then.
  bool pass(std::size_t axis) {
    left_ -= one_[axis];
    bit_ += to_next_[axis];
    return (left_ & kAnyNone) == kAnyNone;
  }
  std::ptrdiff_t bit() const { return bit_; }
  IVec3 voxel() const { return {on_axis(0), on_axis(1), on_axis(2)}; }

 private:
  static constexpr int kBits = 20;  // islands have fewer voxels along an axis
  static constexpr std::uint64_t kNone = std::uint64_t{1} << kBits;
  static constexpr std::uint64_t kAnyNone = kNone | kNone << (kBits + 1) | kNone << 2 * (kBits + 1);
  static int place_of(std::size_t axis) { return static_cast<int>(axis) * (kBits + 1); }
  int on_axis(std::size_t a) const {
    const int steps = static_cast<int>(left_ >> place_of(a) & (kNone - 1));
    return low_[a] + (up_[a] ? size_[a] - 1 - steps : steps);
  }
  std::array<int, 3> low_, size_;
  std::array<bool, 3> up_{};
  std::array<std::ptrdiff_t, 4> to_next_;
  std::array<std::uint64_t, 4> one_{};
  std::ptrdiff_t bit_;
  std::uint64_t left_ = 0;
};

}  // namespace

OpeningRayWays::OpeningRayWays(const AirVolume& air, const LatticeLines& lines)
    : air_(air), lines_(lines) {}

std::optional<OpeningRayWays::End> OpeningRayWays::end_of(IVec3 front, int face,
                                                          std::size_t number) const {
  const OpeningRay& ray = OpeningRaySet::of(front, face).rays[number];
  const VoxelBits& solid = lines_.solid();
  BitWalk walk(solid, ray, front);
  std::optional<End> end;
  for_each_plane(ray, 0, [&](std::size_t axis) {
    if (!walk.pass(axis)) return false;
    if (!solid.bit(walk.bit()) || (air_.has_leaves && lines_.open(walk.voxel(), number)))
      return true;
    end = End{walk.voxel(), static_cast<int>(2 * axis) + (ray.step[axis] > 0 ? 1 : 0)};
    return false;
  });
  return end;
}

/// Calls fn(block, voxels of the ray in it) for stained glass on the way, until it returns false.
template <class Fn>
bool OpeningRayWays::follow(IVec3 front, int face, std::size_t number, const Fn& fn) const {
  const OpeningRay& ray = OpeningRaySet::of(front, face).rays[number];
  glm::ivec3 at = vector_of(front);
  float entered = 0.0f;
  for (RayCrossings crossings(ray);; crossings.pass()) {
    const BlockId block = air_.stained.at({at.x, at.y, at.z});
    if (block != kAir && !fn(block, crossings.length() - entered)) return false;
    entered = crossings.length();
    const std::size_t axis = crossings.axis();
    at[static_cast<int>(axis)] += ray.step[axis];
    const IVec3 voxel{at.x, at.y, at.z};
    if (!lines_.inside(voxel) || !lines_.open(voxel, number)) return true;
  }
}

bool OpeningRayWays::passes_glass(IVec3 front, int face, std::size_t ray) const {
  return !follow(front, face, ray, [](BlockId, float) { return false; });
}

glm::vec3 OpeningRayWays::left_by_glass(IVec3 front, int face, std::size_t ray) const {
  glm::vec3 left(1.0f);
  follow(front, face, ray, [&](BlockId block, float voxels) {
    left *= world::left_by_glass(block, voxels * air_.stained.voxel_blocks());
    return true;
  });
  return left;
}

void OpeningRayWays::begin_origins() {
  const VoxelBits& opaque = air_.opaque;
  const IVec3 size = opaque.size();
  origins_ = VoxelBits(opaque.low(), size, false);
  low_origin_ = opaque.low() + size, high_origin_ = opaque.low();
  cells_.assign(cell_at(size.x - 1, size.y - 1, size.z - 1) / 64 + 1, 0);
  mark_rock();
}

void OpeningRayWays::remove_origin(IVec3 voxel) {
  if (has_origins()) origins_.set(voxel, false);
}

void OpeningRayWays::mark_rock() {
  const VoxelBits& opaque = air_.opaque;
  const IVec3 size = opaque.size();
  // Of 16 cells in a row, those whose voxels are all opaque, by the first bit of each.
  const auto filled = [&](int x, int y, int word) {
    std::uint64_t all = ~std::uint64_t{0};
    for (int j = 0; j < kCell; ++j)
      for (int i = 0; i < kCell; ++i) {
        if (!opaque.has_row(x + i, y + j)) return std::uint64_t{0};
        all &= opaque.row(x + i, y + j)[word];
      }
    all &= all >> 1, all &= all >> 2;
    return all & 0x1111'1111'1111'1111u;
  };
  for (int y = kCell; y + kCell < size.y; y += kCell)
    for (int x = kCell; x + kCell < size.x; x += kCell)
      for (int w = 0; w < opaque.row_words(); ++w) {
        std::uint64_t rock = filled(x, y, w);
        for (int j = -kCell; j <= kCell && rock != 0; j += kCell)
          for (int i = -kCell; i <= kCell && rock != 0; i += kCell) {
            const std::uint64_t its = filled(x + i, y + j, w);
            const std::uint64_t before = w == 0 ? 0 : filled(x + i, y + j, w - 1) >> (64 - kCell);
            const std::uint64_t after =
                w + 1 == opaque.row_words() ? 0 : filled(x + i, y + j, w + 1) << (64 - kCell);
            rock &= its & (its << kCell | before) & (its >> kCell | after);
          }
        for (; rock != 0; rock &= rock - 1) {
          const std::size_t cell = cell_at(x, y, 64 * w + std::countr_zero(rock));
          cells_[cell / 64] |= kRock << cell % 64;
        }
      }
}

// Rock that comes is not marked: it would stop ways back sooner, but they find the same.
void OpeningRayWays::opened(IVec3 voxel) {
  const IVec3 low = origins_.low();
  const IVec3 at{voxel.x - low.x, voxel.y - low.y, voxel.z - low.z};
  for (int y = -kCell; y <= kCell; y += kCell)
    for (int x = -kCell; x <= kCell; x += kCell)
      for (int z = -kCell; z <= kCell; z += kCell) {
        const IVec3 other = at + IVec3{x, y, z};
        if (!origins_.inside(low + other)) continue;
        const std::size_t cell = cell_at(other.x, other.y, other.z);
        cells_[cell / 64] &= ~(kRock << cell % 64);
      }
}

void OpeningRayWays::add_origin(IVec3 voxel) {
  origins_.set(voxel);
  const auto least = [](IVec3 a, IVec3 b) {
    return IVec3{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  };
  const auto most = [](IVec3 a, IVec3 b) {
    return IVec3{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
  };
  low_origin_ = least(low_origin_, voxel), high_origin_ = most(high_origin_, voxel);
  const IVec3 low = origins_.low();
  const std::size_t cell = cell_at(voxel.x - low.x, voxel.y - low.y, voxel.z - low.z);
  cells_[cell / 64] |= kHasOrigin << cell % 64;
}

std::size_t OpeningRayWays::bytes() const {
  return origins_.bytes() + cells_.capacity() * sizeof(std::uint64_t);
}

}  // namespace skerry::world
