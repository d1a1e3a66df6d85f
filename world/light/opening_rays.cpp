#include "world/light/opening_rays.h"

#include <bit>

#include "world/light/base/face_records.h"

namespace skerry::world {
namespace {

constexpr std::uint32_t kAll = 65280;  // 255 * 256

template <class Fn>
void for_each_ray(std::uint64_t rays, const Fn& fn) {
  for (std::uint64_t left = rays; left != 0; left &= left - 1)
    fn(static_cast<std::size_t>(std::countr_zero(left)));
}

}  // namespace

OpeningRays::OpeningRays(const AirVolume& air, OpeningRayWays& ways, const VoxelIndex& wanted,
                         const SeenSky& seen)
    : air_(air), ways_(ways), wanted_(wanted), seen_(seen) {}

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
  const int lines = seen_.lines_of_face(wanted_.of(front), face);
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
    if (ways_.has_origins()) ways_.add_origin(front);
  }
  return known_[place->second].rays;
}

bool OpeningRays::passes_glass(IVec3 front, int face) const {
  return known_[places_.at(key_of(front, face))].glass != 0;
}

void OpeningRays::look(Known& face, std::uint64_t rays) const {
  face.rays &= ~rays;
  face.glass &= ~rays;
  for_each_ray(rays, [&](std::size_t ray) {
    if (ways_.end_of(face.front, face.face, ray)) return;
    face.rays |= std::uint64_t{1} << ray;
    if (!air_.stained.empty() && ways_.passes_glass(face.front, face.face, ray))
      face.glass |= std::uint64_t{1} << ray;
  });
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
  ways_.remove_origin(front);
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

void OpeningRays::add_origins() const {
  for (const Known& face : known_) ways_.add_origin(face.front);
}

void OpeningRays::changed(IVec3 front, int face, std::size_t ray) {
  const auto place = places_.find(key_of(front, face));
  if (place != places_.end()) changed_[place->second] |= std::uint64_t{1} << ray;
}

void OpeningRays::changed_from(IVec3 front) {
  for (int face = 0; face < 6; ++face) {
    const auto place = places_.find(key_of(front, face));
    if (place != places_.end()) changed_[place->second] = ~std::uint64_t{0};
  }
}

std::vector<OpeningRays::Face> OpeningRays::follow_changed() {
  std::vector<Face> out;
  for (const auto& [place, rays] : changed_) {
    Known& face = known_[place];
    const Known before = face;
    look(face, rays);
    if (face.rays != before.rays || ((face.glass | before.glass) & rays) != 0)
      out.push_back({face.front, face.face});
  }
  changed_.clear();
  return out;
}

std::size_t OpeningRays::bytes() const {
  constexpr std::size_t kNode = 4 * sizeof(void*);  // of a map's entry, and its share of the table
  return known_.capacity() * sizeof(Known) + places_.size() * kNode + lit_.bytes();
}

}  // namespace skerry::world
