#include "world/light/opening_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "world/light/base/face_records.h"
#include "world/light/glass_tints.h"

namespace skerry::world {
namespace {

constexpr std::uint32_t kAll = 65280;  // 255 * 256
constexpr int kSets = 8;               // of rays a face direction

// Of changed voxels, the most that are looked for among rays; beyond, all are followed again.
constexpr std::size_t kMostChanged = 16;

// Of rays to a voxel so far away a grid of their directions leaves few, which are asked each.
constexpr float kFar = 8.0f;          // voxels
constexpr float kAboutVoxel = 0.88f;  // radius of a ball about it, and a little more
constexpr int kCells = 16;            // of the grid, along both axes of the face

// Planes that a ray crosses whose order is kept; it is followed anew where it gets further.
constexpr std::size_t kKeptPlanes = 512;
constexpr std::size_t kPlanesAWord = 32;

struct Ray {
  std::array<float, 3> first{}, every{};  // length up to the first plane across an axis; then
  std::array<int, 3> step{};
  /// Two bits a plane, the first lowest: its axis.
  std::array<std::uint64_t, kKeptPlanes / kPlanesAWord> planes{};
};

/// Where a ray crosses planes, one after the other.
class Crossings {
 public:
  explicit Crossings(const Ray& ray) : ray_(ray), next_(ray.first) {}
  /// Of the next plane.
  std::size_t axis() const {
    const std::size_t near = next_[1] < next_[0] ? 1 : 0;
    return next_[2] < next_[near] ? 2 : near;
  }
  float length() const { return next_[axis()]; }
  void pass() {
    const std::size_t axis = this->axis();
    next_[axis] += ray_.every[axis];
  }

 private:
  const Ray& ray_;
  std::array<float, 3> next_;
};

struct RaySet {
  std::array<Ray, OpeningRays::kRays> rays{};
  std::array<std::uint8_t, OpeningRays::kRays> lobes{};
  std::array<std::uint64_t, shared::kSkyLobes> of_lobe{};
  std::array<std::array<float, OpeningRays::kRays>, 3> directions{};  // by axis
  /// Rays that a voxel may be on which lies in the direction of a cell, kFar away or more.
  std::array<std::uint64_t, kCells * kCells> of_cell{};
};

int cell_of(float component) {
  return std::clamp(static_cast<int>((component + 1.0f) * (kCells / 2.0f)), 0, kCells - 1);
}

/// Point of a (0, 2)-sequence in base 2 (Kollig and Keller 2002, Efficient Multidimensional
/// Sampling): each 2^k in a row, the first of them a multiple of 2^k, are as even as so many can
/// be.
std::array<double, 2> point_of_sequence(std::uint32_t number) {
  std::uint32_t u = 0, v = 0;
  for (std::uint32_t left = number, bit = 1u << 31, sum = 1u << 31; left != 0;
       left >>= 1, bit >>= 1, sum ^= sum >> 1)
    if ((left & 1u) != 0) u ^= bit, v ^= sum;
  const double step = std::exp2(-32.0);
  return {u * step, v * step};
}

/// From the unit square to the unit disc, areas in proportion (Shirley and Chiu 1997, A Low
/// Distortion Map Between Disk and Square).
glm::dvec2 in_disc(glm::dvec2 square) {
  const glm::dvec2 p = 2.0 * square - 1.0;
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const double radius = wide ? p.x : p.y;
  const double part = std::numbers::pi / 4.0 * (wide ? p.y / p.x : p.x / p.y);
  return wide ? glm::dvec2(radius * std::cos(part), radius * std::sin(part))
              : glm::dvec2(radius * std::sin(part), radius * std::cos(part));
}

// Sets follow each other in one sequence: they are even by themselves, and together those of four
// faces side by side. Density goes with the cosine.
RaySet make_set(int face, int set) {
  const FaceAxes axes(face);
  RaySet out;
  for (std::size_t i = 0; i < OpeningRays::kRays; ++i) {
    // In the middle of the cells that points of all sets lie in, none of them on the face's axes.
    constexpr double kHalfCell = 0.5 / static_cast<double>(kSets * OpeningRays::kRays);
    const auto [u, v] = point_of_sequence(
        static_cast<std::uint32_t>(static_cast<std::size_t>(set) * OpeningRays::kRays + i));
    const glm::dvec2 level = in_disc({u + kHalfCell, v + kHalfCell});
    glm::dvec3 d(0.0);
    d[axes.own] = axes.sign * std::sqrt(1.0 - glm::dot(level, level));
    d[axes.b] = level.x;
    d[axes.c] = level.y;
    std::uint32_t octant = 0;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      Ray& ray = out.rays[i];
      ray.step[axis] = d[a] > 0.0 ? 1 : -1;
      ray.every[axis] = static_cast<float>(1.0 / std::abs(d[a]));
      ray.first[axis] = a == axes.own ? ray.every[axis] : 0.5f * ray.every[axis];
      out.directions[axis][i] = static_cast<float>(d[a]);
      if (d[a] <= 0.0) octant |= 1u << a;
    }
    Crossings crossings(out.rays[i]);
    for (std::size_t at = 0; at < kKeptPlanes; ++at, crossings.pass())
      out.rays[i].planes[at / kPlanesAWord] |= std::uint64_t{crossings.axis()}
                                               << 2 * (at % kPlanesAWord);
    const std::uint32_t lobe = shared::sky_lobe(static_cast<std::uint32_t>(axes.own), octant,
                                                static_cast<float>(std::abs(d.y)));
    out.lobes[i] = static_cast<std::uint8_t>(lobe);
    out.of_lobe[lobe] |= std::uint64_t{1} << i;
    const auto reaches = [&](double component, int cell) {
      const double low = -1.0 + cell * 2.0 / kCells, off = static_cast<double>(kAboutVoxel / kFar);
      return component > low - off && component < low + 2.0 / kCells + off;
    };
    for (int b = 0; b < kCells; ++b)
      for (int c = 0; c < kCells; ++c)
        if (reaches(d[axes.b], b) && reaches(d[axes.c], c))
          out.of_cell[static_cast<std::size_t>(b * kCells + c)] |= std::uint64_t{1} << i;
  }
  return out;
}

const RaySet& set_of(IVec3 front, int face) {
  static const std::vector<RaySet> sets = [] {
    std::vector<RaySet> all;
    for (int direction = 0; direction < 6; ++direction)
      for (int set = 0; set < kSets; ++set) all.push_back(make_set(direction, set));
    return all;
  }();
  const FaceAxes axes(face);
  const std::array<int, 3> odd{front.x & 1, front.y & 1, front.z & 1};
  const auto part = [&](int axis) { return odd[static_cast<std::size_t>(axis)]; };
  return sets[static_cast<std::size_t>(face * kSets + part(axes.b) + 2 * part(axes.c) +
                                       4 * part(axes.own))];
}

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
  if (lit_.at(voxel)) return true;
  for (int y = -kNear; y <= kNear; ++y)
    for (int x = -kNear; x <= kNear; ++x)
      for (int z = -kNear; z <= kNear; ++z)
        if (lit_.at(voxel + IVec3{x, y, z})) return true;
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
  if (is_new) look(known_.emplace_back(Known{front, face, 0, 0}), ~std::uint64_t{0});
  return known_[place->second].rays;
}

bool OpeningRays::passes_glass(IVec3 front, int face) const {
  return known_[places_.at(key_of(front, face))].glass != 0;
}

template <class Fn>
bool OpeningRays::follow(IVec3 front, int face, std::size_t number, const Fn& fn) const {
  const Ray& ray = set_of(front, face).rays[number];
  glm::ivec3 at = vector_of(front);
  float entered = 0.0f;
  for (Crossings crossings(ray);; crossings.pass()) {
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

// Numbers of bits, and a register with the steps that are left along each axis until the volume
// ends, each with a bit above it that is cleared when there are none.
bool OpeningRays::comes_to_sky(IVec3 front, int face, std::size_t number) const {
  constexpr int kBits = 20;
  constexpr std::uint64_t kNone = std::uint64_t{1} << kBits;
  constexpr std::uint64_t kAnyNone = kNone | kNone << (kBits + 1) | kNone << 2 * (kBits + 1);
  const Ray& ray = set_of(front, face).rays[number];
  const VoxelBits& solid = lines_.solid();
  const IVec3 low = solid.low(), size = solid.size();
  const std::array<int, 3> from{front.x - low.x, front.y - low.y, front.z - low.z},
      edge{size.x, size.y, size.z};
  std::array<std::ptrdiff_t, 4> to_next{solid.bit_step({1, 0, 0}), solid.bit_step({0, 1, 0}), 1, 0};
  std::array<std::uint64_t, 4> one{};
  std::uint64_t left = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto place = static_cast<int>(a) * (kBits + 1);
    const bool up = ray.step[a] > 0;
    if (!up) to_next[a] = -to_next[a];
    one[a] = std::uint64_t{1} << place;
    left |= (kNone + static_cast<std::uint64_t>(up ? edge[a] - 1 - from[a] : from[a])) << place;
  }
  std::ptrdiff_t bit = solid.bit_at(front);
  for (std::uint64_t planes : ray.planes)
    for (std::size_t i = 0; i < kPlanesAWord; ++i, planes >>= 2) {
      const std::size_t axis = planes & 3;
      left -= one[axis];
      if ((left & kAnyNone) != kAnyNone) return true;
      bit += to_next[axis];
      if (!solid.bit(bit)) continue;
      if (!air_.has_leaves) return false;
      const auto voxel = [&](std::size_t a) {
        const int steps = static_cast<int>(left >> (a * (kBits + 1)) & (kNone - 1));
        const std::array<int, 3> lowest{low.x, low.y, low.z};
        return lowest[a] + (ray.step[a] > 0 ? edge[a] - 1 - steps : steps);
      };
      if (!lines_.open({voxel(0), voxel(1), voxel(2)}, number)) return false;
    }
  return follow(front, face, number, [](BlockId, float) {});
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
  const RaySet& set = set_of(front, face);
  for (std::size_t lobe = 0; lobe < out.size(); ++lobe)
    out[lobe] = kAll * static_cast<std::uint32_t>(std::popcount(rays & set.of_lobe[lobe])) /
                static_cast<std::uint32_t>(std::popcount(set.of_lobe[lobe]));
  return out;
}

std::size_t OpeningRays::lobe_of_ray(IVec3 front, int face, std::size_t ray) {
  return set_of(front, face).lobes[ray];
}

void OpeningRays::forget(IVec3 front) {
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

// A ray touches a voxel only if it comes as near to its middle as its corners are.
std::uint64_t OpeningRays::rays_to(const Known& face, IVec3 voxel) const {
  const FaceAxes axes(face.face);
  glm::vec3 way(static_cast<float>(voxel.x - face.front.x),
                static_cast<float>(voxel.y - face.front.y),
                static_cast<float>(voxel.z - face.front.z));
  way[axes.own] += 0.5f * static_cast<float>(axes.sign);
  if (way[axes.own] * static_cast<float>(axes.sign) < -kAboutVoxel) return 0;
  const float distance2 = glm::dot(way, way);
  const RaySet& set = set_of(face.front, face.face);
  std::uint64_t out = 0, may = ~std::uint64_t{0};
  if (distance2 >= kFar * kFar) {
    const float length = std::sqrt(distance2);
    may = set.of_cell[static_cast<std::size_t>(cell_of(way[axes.b] / length) * kCells +
                                               cell_of(way[axes.c] / length))];
  }
  // In doubles: over some hundred voxels squares of floats would lose what corners need.
  const double nearest = static_cast<double>(distance2) -
                         static_cast<double>(kAboutVoxel) * static_cast<double>(kAboutVoxel);
  const glm::dvec3 to(way);
  for_each_ray(may, [&](std::size_t i) {
    const glm::dvec3 ray(set.directions[0][i], set.directions[1][i], set.directions[2][i]);
    const double along = glm::dot(to, ray);  // up to where it comes nearest
    const bool touches = nearest <= 0.0 || (along > 0.0 && along * along >= nearest);
    out |= static_cast<std::uint64_t>(touches) << i;
  });
  return out;
}

std::vector<OpeningRays::Face> OpeningRays::changed(std::span<const IVec3> voxels) {
  std::vector<Face> out;
  if (voxels.empty()) return out;
  for (Known& face : known_) {
    std::uint64_t rays = voxels.size() > kMostChanged ? ~std::uint64_t{0} : 0;
    if (rays == 0)
      for (const IVec3& voxel : voxels) rays |= rays_to(face, voxel);
    if (rays == 0) continue;
    const Known before = face;
    look(face, rays);
    if (face.rays != before.rays || ((face.glass | before.glass) & rays) != 0)
      out.push_back({face.front, face.face});
  }
  return out;
}

std::size_t OpeningRays::bytes() const {
  constexpr std::size_t kNode = 4 * sizeof(void*);  // of a map's entry, and its share of the table
  return known_.capacity() * sizeof(Known) + places_.size() * kNode +
         static_cast<std::size_t>(lit_.row_words() + 2) * static_cast<std::size_t>(lit_.size().x) *
             static_cast<std::size_t>(lit_.size().y) * sizeof(std::uint64_t);
}

}  // namespace skerry::world
