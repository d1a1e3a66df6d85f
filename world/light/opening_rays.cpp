#include "world/light/opening_rays.h"

#include <algorithm>

#include "world/light/base/face_records.h"
#include "world/light/base/opening_ray_sets.h"
#include "world/light/glass_tints.h"

namespace skerry::world {
namespace {

constexpr std::uint32_t kAll = 65280;  // 255 * 256

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

template <class Fn>
void for_each_ray(std::uint64_t rays, const Fn& fn) {
  for (std::uint64_t left = rays; left != 0; left &= left - 1)
    fn(static_cast<std::size_t>(std::countr_zero(left)));
}

}  // namespace

OpeningRays::OpeningRays(const AirVolume& air, const LatticeLines& lines, const VoxelIndex& wanted,
                         const SeenSky& seen)
    : air_(air), lines_(lines), wanted_(wanted), seen_(seen) {}

void OpeningRays::take_lit() {
  const VoxelBits& wanted = wanted_.chosen();
  lit_ = VoxelBits(wanted.low(), wanted.size(), false);
  for_each_voxel(wanted, [&](IVec3 voxel) {
    if (is_lit_now(voxel)) lit_.set(voxel);
  });
  if (known_.empty()) mark_rock();
}

std::size_t OpeningRays::cell_at(int x, int y, int z) const {
  const auto cells = [](int voxels) { return (voxels + kCell - 1) / kCell; };
  return static_cast<std::size_t>(
      2 *
      ((y / kCell * cells(fronts_.size().x) + x / kCell) * cells(fronts_.size().z) + z / kCell));
}

void OpeningRays::mark_rock() {
  const VoxelBits& opaque = air_.opaque;
  fronts_ = VoxelBits(opaque.low(), opaque.size(), false);
  low_front_ = opaque.low() + opaque.size(), high_front_ = opaque.low();
  const IVec3 size = opaque.size();
  cells_.assign(cell_at(size.x - 1, size.y - 1, size.z - 1) / 64 + 1, 0);
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
void OpeningRays::clear_rock_about(IVec3 voxel) {
  const IVec3 low = fronts_.low();
  const IVec3 at{voxel.x - low.x, voxel.y - low.y, voxel.z - low.z};
  for (int y = -kCell; y <= kCell; y += kCell)
    for (int x = -kCell; x <= kCell; x += kCell)
      for (int z = -kCell; z <= kCell; z += kCell) {
        const IVec3 other = at + IVec3{x, y, z};
        if (!fronts_.inside(low + other)) continue;
        const std::size_t cell = cell_at(other.x, other.y, other.z);
        cells_[cell / 64] &= ~(kRock << cell % 64);
      }
}

void OpeningRays::add_front(IVec3 voxel) {
  fronts_.set(voxel);
  const auto least = [](IVec3 a, IVec3 b) {
    return IVec3{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  };
  const auto most = [](IVec3 a, IVec3 b) {
    return IVec3{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
  };
  low_front_ = least(low_front_, voxel), high_front_ = most(high_front_, voxel);
  const IVec3 low = fronts_.low();
  const std::size_t cell = cell_at(voxel.x - low.x, voxel.y - low.y, voxel.z - low.z);
  cells_[cell / 64] |= kHasFront << cell % 64;
}

// Of voxels beside opaque ones alone: views of others may be kept or not, as edits went.
bool OpeningRays::is_lit_now(IVec3 voxel) const {
  if (!wanted_.has(voxel) || !sees_sky_at(wanted_.of(voxel))) return false;
  for (int face = 0; face < 6; ++face)
    if (air_.opaque.at(voxel + to_front({{}, face, false}))) return true;
  return false;
}

bool OpeningRays::sees_sky_at(std::size_t number) const {
  std::uint32_t any = 0;
  for (std::size_t fan = 0; fan < kFans; ++fan) any |= seen_.of(number, fan);
  return any != 0;
}

bool OpeningRays::retake_lit(IVec3 voxel) {
  const bool now = is_lit_now(voxel);
  if (lit_.at(voxel) == now || !lit_.inside(voxel)) return false;
  lit_.set(voxel, now);
  return true;
}

bool OpeningRays::is_near_lit(IVec3 voxel) const {
  constexpr std::uint64_t kBoth = (std::uint64_t{1} << (2 * kNear + 1)) - 1;
  const IVec3 low = lit_.low();
  const int x = voxel.x - low.x, y = voxel.y - low.y, z = voxel.z - low.z - kNear;
  const int word = z < 0 ? -1 : z / 64, shift = z & 63;
  for (int j = -kNear; j <= kNear; ++j)
    for (int i = -kNear; i <= kNear; ++i) {
      if (!lit_.has_row(x + i, y + j)) continue;
      const std::uint64_t* row = lit_.row(x + i, y + j) + word;
      const std::uint64_t next = shift == 0 ? 0 : row[1] << (64 - shift);
      if (((row[0] >> shift | next) & kBoth) != 0) return true;
    }
  return false;
}

bool OpeningRays::asks(IVec3 front, int face) const {
  const std::size_t number = wanted_.of(front);
  int lines = 0;
  for (const std::size_t fan : fans_of_face(face)) lines += std::popcount(seen_.of(number, fan));
  return lines <= kFewLines && (lines > 0 || is_near_lit(front));
}

std::uint64_t OpeningRays::key_of(IVec3 front, int face) {
  constexpr int kBits = 20;  // a coordinate; islands have fewer voxels
  const auto part = [](int v) {
    return static_cast<std::uint64_t>(v) & ((std::uint64_t{1} << kBits) - 1);
  };
  return part(front.x) | part(front.y) << kBits | part(front.z) << 2 * kBits |
         static_cast<std::uint64_t>(face) << 3 * kBits;
}

std::uint64_t OpeningRays::seen(IVec3 front, int face) {
  const auto [place, is_new] =
      places_.emplace(key_of(front, face), static_cast<std::uint32_t>(known_.size()));
  if (is_new) {
    look(known_.emplace_back(Known{front, face, 0, 0}), ~std::uint64_t{0});
    add_front(front);
  }
  return known_[place->second].rays;
}

bool OpeningRays::passes_glass(IVec3 front, int face) const {
  return known_[places_.at(key_of(front, face))].glass != 0;
}

template <class Fn>
bool OpeningRays::follow(IVec3 front, int face, std::size_t number, const Fn& fn) const {
  const OpeningRay& ray = OpeningRaySet::of(front, face).rays[number];
  glm::ivec3 at = vector_of(front);
  float entered = 0.0f;
  for (RayCrossings crossings(ray);; crossings.pass()) {
    const BlockId block = air_.stained.at({at.x, at.y, at.z});
    if (block != kAir) fn(block, crossings.length() - entered);
    entered = crossings.length();
    const std::size_t axis = crossings.axis();
    at[static_cast<int>(axis)] += ray.step[axis];
    const IVec3 voxel{at.x, at.y, at.z};
    if (!lines_.inside(voxel)) return true;
    if (!lines_.open(voxel, number)) return false;
  }
}

bool OpeningRays::comes_to_sky(IVec3 front, int face, std::size_t number) const {
  const OpeningRay& ray = OpeningRaySet::of(front, face).rays[number];
  const VoxelBits& solid = lines_.solid();
  BitWalk walk(solid, ray, front);
  bool sky = false;
  for_each_plane(ray, 0, [&](std::size_t axis) {
    sky = !walk.pass(axis);
    if (sky) return false;
    return !solid.bit(walk.bit()) || (air_.has_leaves && lines_.open(walk.voxel(), number));
  });
  return sky;
}

void OpeningRays::look(Known& face, std::uint64_t rays) const {
  face.rays &= ~rays;
  face.glass &= ~rays;
  if (air_.stained.empty()) {
    for_each_ray(rays, [&](std::size_t ray) {
      face.rays |= static_cast<std::uint64_t>(comes_to_sky(face.front, face.face, ray)) << ray;
    });
    return;
  }
  for_each_ray(rays, [&](std::size_t ray) {
    bool glass = false;
    if (!follow(face.front, face.face, ray, [&](BlockId, float) { glass = true; })) return;
    face.rays |= std::uint64_t{1} << ray;
    face.glass |= static_cast<std::uint64_t>(glass) << ray;
  });
}

glm::vec3 OpeningRays::left_by_glass_on(IVec3 front, int face, std::size_t ray) const {
  glm::vec3 left(1.0f);
  follow(front, face, ray, [&](BlockId block, float voxels) {
    left *= left_by_glass(block, voxels * air_.stained.voxel_blocks());
  });
  return left;
}

std::array<std::uint32_t, shared::kSkyLobes> OpeningRays::lobes(IVec3 front, int face,
                                                                std::uint64_t rays) {
  std::array<std::uint32_t, shared::kSkyLobes> out{};
  const OpeningRaySet& set = OpeningRaySet::of(front, face);
  for (std::size_t lobe = 0; lobe < out.size(); ++lobe)
    out[lobe] = kAll * static_cast<std::uint32_t>(std::popcount(rays & set.of_lobe[lobe])) /
                static_cast<std::uint32_t>(std::popcount(set.of_lobe[lobe]));
  return out;
}

std::size_t OpeningRays::lobe_of_ray(IVec3 front, int face, std::size_t ray) {
  return OpeningRaySet::of(front, face).lobes[ray];
}

void OpeningRays::forget(IVec3 front) {
  fronts_.set(front, false);
  for (int face = 0; face < 6; ++face) {
    const auto place = places_.find(key_of(front, face));
    if (place == places_.end()) continue;
    const std::uint32_t at = place->second;
    places_.erase(place);
    if (at + 1 != known_.size()) {
      known_[at] = known_.back();
      places_[key_of(known_[at].front, known_[at].face)] = at;
    }
    known_.pop_back();
  }
}

/// Calls fn(place in known_, ray) for the faces of a direction from which a ray passes a voxel, or
/// would if nothing stopped it before, but not those behind rock. All rays of a set go alike from
/// wherever they begin, so their ways are gone back here. A ray passes a voxel at most one away,
/// along each axis, from where another of its direction does that passes the same voxel: where one
/// is in the middle of rock, so are all that come from further back.
template <class Fn>
void OpeningRays::for_each_through(IVec3 voxel, int face, const Fn& fn) const {
  const IVec3 low = fronts_.low();
  const std::array<int, 3> at{voxel.x - low.x, voxel.y - low.y, voxel.z - low.z};
  const std::array<int, 3> below{voxel.x - low_front_.x, voxel.y - low_front_.y,
                                 voxel.z - low_front_.z},
      above{high_front_.x - voxel.x, high_front_.y - voxel.y, high_front_.z - voxel.z};
  const std::size_t parity = OpeningRaySet::parity_of(voxel);
  for (std::size_t own = 0; own < OpeningRaySet::kSets; ++own) {
    const OpeningRaySet& set = OpeningRaySet::of(own, face);
    for (std::size_t ray = 0; ray < kRays; ++ray) {
      std::array<int, 3> step{}, most{};
      for (std::size_t a = 0; a < 3; ++a) {
        const bool down = (set.down[ray] >> a & 1) != 0;
        step[a] = down ? -1 : 1;
        most[a] = down ? above[a] : below[a];
      }
      /// @return whether what lies further back may be of interest.
      const auto ask = [&](const std::array<int, 3>& steps, bool is_of_set) {
        if (steps[0] > most[0] || steps[1] > most[1] || steps[2] > most[2]) return false;
        const std::array<int, 3> its{at[0] - step[0] * steps[0], at[1] - step[1] * steps[1],
                                     at[2] - step[2] * steps[2]};
        const std::uint64_t cell = bits_of_cell(cell_at(its[0], its[1], its[2]));
        if ((cell & kRock) != 0) return false;
        if (!is_of_set || (cell & kHasFront) == 0) return true;
        const IVec3 front = low + IVec3{its[0], its[1], its[2]};
        if (!fronts_.bit(fronts_.bit_at(front))) return true;
        const auto place = places_.find(key_of(front, face));
        if (place != places_.end()) fn(place->second, ray);
        return true;
      };
      bool on = true;
      for (const OpeningRaySet::Steps& steps : set.steps(ray, parity ^ own)) {
        on = ask({steps[0], steps[1], steps[2]}, true);
        if (!on) break;
      }
      if (!on) continue;
      const OpeningRaySet::Steps& counted = set.after_counted[ray];
      std::array<int, 3> steps{counted[0], counted[1], counted[2]};
      if (!ask(steps, false)) continue;
      for_each_plane(set.rays[ray], OpeningRaySet::kCountedPlanes, [&](std::size_t axis) {
        ++steps[axis];
        return ask(steps,
                   OpeningRaySet::parity_of({steps[0], steps[1], steps[2]}) == (parity ^ own));
      });
    }
  }
}

std::vector<OpeningRays::Face> OpeningRays::changed(std::span<const IVec3> voxels) {
  for (const IVec3& voxel : voxels)
    if (!air_.opaque.at(voxel)) clear_rock_about(voxel);
  std::map<std::uint32_t, std::uint64_t> again;
  for (const IVec3& voxel : voxels)
    for (int face = 0; face < 6; ++face) {
      const auto own = places_.find(key_of(voxel, face));
      if (own != places_.end()) again[own->second] = ~std::uint64_t{0};
      for_each_through(voxel, face, [&](std::uint32_t place, std::size_t ray) {
        again[place] |= std::uint64_t{1} << ray;
      });
    }
  std::vector<Face> out;
  for (const auto& [place, rays] : again) {
    Known& face = known_[place];
    const Known before = face;
    look(face, rays);
    if (face.rays != before.rays || ((face.glass | before.glass) & rays) != 0)
      out.push_back({face.front, face.face});
  }
  return out;
}

std::size_t OpeningRays::bytes() const {
  constexpr std::size_t kNode = 4 * sizeof(void*);  // of a map's entry, and its share of the table
  const auto bytes_of = [](const VoxelBits& bits) {
    return static_cast<std::size_t>(bits.row_step()) * static_cast<std::size_t>(bits.size().x) *
           static_cast<std::size_t>(bits.size().y) * sizeof(std::uint64_t);
  };
  return known_.capacity() * sizeof(Known) + places_.size() * kNode + bytes_of(lit_) +
         bytes_of(fronts_) + cells_.capacity() * sizeof(std::uint64_t);
}

}  // namespace skerry::world
