#include "world/light/bounce_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "world/light/face_records.h"

namespace skerry::world {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kIrradianceOfOctant = kPi / 4.0f;  // under radiance 1

/// Octants in front of a face, and what each pattern of theirs weighs.
struct Hemisphere {
  std::array<int, 4> octants{};
  std::array<float, shared::kSkyPatternCount> weight{};
};

Hemisphere hemisphere_of(int face) {
  const FaceAxes axes(face);
  Hemisphere out;
  for (int quarter = 0; quarter < 4; ++quarter)
    out.octants[static_cast<std::size_t>(quarter)] = (axes.sign < 0 ? 1 << axes.own : 0) |
                                                     (quarter & 1 ? 1 << axes.b : 0) |
                                                     (quarter & 2 ? 1 << axes.c : 0);
  const LobeWeights& weights = lobe_weights(axes.own);
  float sum = 0.0f;
  for (std::size_t k = 0; k < out.weight.size(); ++k)
    sum += out.weight[k] = static_cast<float>(weights.weight[k]);
  for (float& weight : out.weight) weight *= kIrradianceOfOctant / sum;
  return out;
}

const Hemisphere& hemisphere(int face) {
  static const std::array<Hemisphere, 6> kAll{hemisphere_of(0), hemisphere_of(1), hemisphere_of(2),
                                              hemisphere_of(3), hemisphere_of(4), hemisphere_of(5)};
  return kAll[static_cast<std::size_t>(face)];
}

/// Harmonics of the lattice vectors, by octant and pattern.
const std::array<std::array<float, kHarmonics>, kOctants * shared::kSkyPatternCount>&
vector_harmonics() {
  static const auto kAll = [] {
    std::array<std::array<float, kHarmonics>, kOctants * shared::kSkyPatternCount> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
      const IVec3 v = sky_direction(static_cast<int>(i / shared::kSkyPatternCount),
                                    static_cast<int>(i % shared::kSkyPatternCount));
      const glm::vec3 d(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
      const float length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
      out[i] = harmonics_of(d.x / length, d.y / length, d.z / length);
    }
    return out;
  }();
  return kAll;
}

VoxelBits solid_of(const AirVolume& air) {
  VoxelBits solid = air.opaque;
  if (!air.has_leaves) return solid;
  for (int y = 0; y < solid.size().y; ++y)
    for (int x = 0; x < solid.size().x; ++x)
      for (int w = 0; w < solid.row_words(); ++w) solid.row(x, y)[w] |= air.leaves.row(x, y)[w];
  return solid;
}

}  // namespace

BounceLight::Light& BounceLight::Light::add(const Light& other, float weight) {
  mean += weight * other.mean;
  for (std::size_t i = 0; i < shape.size(); ++i) shape[i] += weight * other.shape[i];
  lamps += weight * other.lamps;
  return *this;
}

BounceLight::Light& BounceLight::Light::operator*=(float factor) {
  mean *= factor;
  for (float& value : shape) value *= factor;
  lamps *= factor;
  return *this;
}

// --- Lines ---

BounceLight::Way BounceLight::way_along(IVec3 vector) const {
  struct Place {
    int enter = 0, leave = 0, steps = 0;
    IVec3 offset{};
    auto order() const { return std::tuple(enter, leave, steps); }
  };
  const std::array<int, 3> n{std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)};
  std::vector<IVec3> offsets = voxels_between(vector);
  offsets.push_back(vector);
  std::vector<Place> places;
  for (const IVec3& o : offsets) {
    const std::array<int, 3> at{std::abs(o.x), std::abs(o.y), std::abs(o.z)};
    Place place{0, 8, at[0] + at[1] + at[2], o};
    for (std::size_t a = 0; a < 3; ++a) {
      place.enter = std::max(place.enter, (2 * at[a] - 1) * 4 / n[a]);
      place.leave = std::min(place.leave, (2 * at[a] + 1) * 4 / n[a]);
    }
    places.push_back(place);
  }
  std::ranges::stable_sort(places, {}, &Place::order);
  Way way{vector, {}};
  int group = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i != 0 && places[i].order() != places[i - 1].order()) ++group;
    Touched touched{places[i].offset, solid_.bit_step(places[i].offset), group, {-1, -1, -1}};
    // It can be entered from what the line touches before it, or from where the line begins.
    std::size_t entries = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::array<int, 3> d{vector.x, vector.y, vector.z};
      const int sign = d[static_cast<std::size_t>(axis)] > 0 ? 1 : -1;
      const IVec3 from = places[i].offset + axis_vector(axis, -sign);
      const bool passed =
          from == IVec3{} ||
          std::any_of(way.touched.begin(), way.touched.end(),
                      [&](const Touched& t) { return t.group < group && t.offset == from; });
      if (passed)
        touched.entered[entries++] = static_cast<std::int8_t>(2 * axis + (sign > 0 ? 1 : 0));
    }
    way.touched.push_back(touched);
  }
  return way;
}

/// To the ways of a leaf set.
bool BounceLight::open(IVec3 voxel, int leaf_set) const {
  if (air_.opaque.at(voxel)) return false;
  if (!air_.has_leaves || !air_.leaves.at(voxel)) return true;
  const auto word = static_cast<int>(floor_div(voxel.z, 64));
  return (leaves_that_stop(leaf_set, voxel.x, voxel.y, word) >> (voxel.z & 63) & 1u) == 0;
}

/// Whether a line from a voxel along a vector touches what is not open.
bool BounceLight::stopped(IVec3 from, const Way& way, int leaf_set) const {
  constexpr int kLongest = 4;  // component of a vector
  const IVec3 low = solid_.low(), size = solid_.size();
  const int x = from.x - low.x, y = from.y - low.y;
  const auto closed = [&](const Touched& t) { return !open(from + t.offset, leaf_set); };
  if (x < kLongest || y < kLongest || x >= size.x - kLongest || y >= size.y - kLongest)
    return std::any_of(way.touched.begin(), way.touched.end(), closed);
  const std::ptrdiff_t at = solid_.bit_at(from);
  bool any = false;
  for (const Touched& t : way.touched) any |= solid_.bit(at + t.step);
  if (!any || !air_.has_leaves) return any;
  return std::any_of(way.touched.begin(), way.touched.end(), closed);
}

// --- Faces ---

BounceLight::BounceLight(const LightChunks& chunks, const AirVolume& air, const VoxelIndex& wanted,
                         std::span<const FaceAlbedo> albedo)
    : air_(air), wanted_(wanted), albedo_(albedo) {
  if (wanted_.size() == 0) return;
  solid_ = solid_of(air_);
  numbers_.assign(wanted_.size() * 6, 0);
  // Plants come last: they share the light of the ground that they stand on.
  for (const bool plants : {false, true})
    for (const auto& [at, chunk] : chunks) {
      const IVec3 corner = corner_of(at);
      for (const shared::Quad& quad : chunk->quads)
        for_each_face(quad, [&](const DrawnFace& drawn) {
          if (drawn.plant != plants) return;
          const FaceAxes axes(drawn.direction);
          const IVec3 front = drawn.plant ? IVec3{} : axis_vector(axes.own, axes.sign);
          add_face({corner + drawn.voxel + front,
                    static_cast<std::uint16_t>(drawn.plant ? 0 : quad.material & 0xffffu),
                    static_cast<std::uint8_t>(drawn.direction)});
        });
    }
  for (std::vector<Light>& light : leaving_) light.resize(faces_.size());
  for (int octant = 0; octant < kOctants; ++octant)
    for (int pattern = 0; pattern < static_cast<int>(shared::kSkyPatternCount); ++pattern)
      ways_.push_back(way_along(sky_direction(octant, pattern)));
}

void BounceLight::add_face(Face face) {
  if (!wanted_.has(face.front)) return;
  std::uint32_t& number = numbers_[wanted_.of(face.front) * 6 + face.direction];
  if (number != 0) return;
  faces_.push_back(face);
  number = static_cast<std::uint32_t>(faces_.size());
}

std::uint32_t BounceLight::number_of(IVec3 front, int face) const {
  if (!wanted_.has(front)) return 0;
  return numbers_[wanted_.of(front) * 6 + static_cast<std::size_t>(face)];
}

const BounceLight::Light* BounceLight::received(IVec3 front, int face) const {
  const std::uint32_t number = number_of(front, face);
  return number == 0 ? nullptr : &leaving_[(kSteps - 1) % 2][number - 1];
}

BounceLight::Light BounceLight::reflected(const Face& face, Light light) const {
  const glm::vec3 share =
      face.block < albedo_.size() ? albedo_[face.block][face.direction] / kPi : glm::vec3(0.0f);
  const float before = luminance(light.mean);
  light.mean *= share;
  light.lamps *= share;
  const float kept = before > 0.0f ? luminance(light.mean) / before : luminance(share);
  for (float& shape : light.shape) shape *= kept;
  return light;
}

// --- Light ---

BounceLight::Light BounceLight::direct_of(const Face& face, std::span<const SeenSky> seen,
                                          const LampLightMap& lamps) const {
  const std::size_t voxel = wanted_.of(face.front);
  const Hemisphere& way = hemisphere(face.direction);
  std::array<float, kHarmonics> sum{};
  for (const int octant : way.octants) {
    const std::uint32_t bits = seen[voxel][static_cast<std::size_t>(octant)];
    if (bits == 0) continue;
    for (std::size_t k = 0; k < shared::kSkyPatternCount; ++k) {
      if ((bits >> k & 1u) == 0) continue;
      const auto& basis =
          vector_harmonics()[static_cast<std::size_t>(octant) * shared::kSkyPatternCount + k];
      for (std::size_t i = 0; i < kHarmonics; ++i) sum[i] += way.weight[k] * basis[i];
    }
  }
  Light out;
  out.mean = glm::vec3(sum[0]);
  std::copy(sum.begin() + 1, sum.end(), out.shape.begin());
  if (const auto lit = lamps.find(voxel); lit != lamps.end())
    out.lamps = lit->second[face.direction];
  return out;
}

/// Adds the light of a face of the voxel that the line can come in by.
void BounceLight::add_entered(IVec3 voxel, const Touched& touched, float weight,
                              std::span<const Light> leaving, Light& sum) const {
  for (const std::int8_t face : touched.entered) {
    if (face < 0) break;
    const FaceAxes axes(face);
    const std::uint32_t number = number_of(voxel + axis_vector(axes.own, axes.sign), face);
    if (number == 0) continue;
    sum.add(leaving[number - 1], weight);
    return;
  }
}

void BounceLight::add_from(IVec3 from, std::size_t which, float weight,
                           std::span<const Light> leaving, Light& sum) const {
  const Way& way = ways_[which];
  const int leaf_set = static_cast<int>(which % shared::kSkyPatternCount) % kLeafSets;
  const IVec3 low = air_.opaque.low(), size = air_.opaque.size();
  const auto inside = [&](IVec3 v) {
    return v.x >= low.x && v.x < low.x + size.x && v.y >= low.y && v.y < low.y + size.y &&
           v.z >= low.z && v.z < low.z + size.z;
  };
  while (!stopped(from, way, leaf_set)) {
    from = from + way.vector;
    if (!inside(from)) return;
  }
  // Voxels that are touched at once stop it together.
  std::array<const Touched*, 3> stops{};
  std::size_t count = 0;
  for (const Touched& touched : way.touched) {
    if (count == stops.size() || (count != 0 && touched.group != stops[0]->group)) break;
    if (!open(from + touched.offset, leaf_set)) stops[count++] = &touched;
  }
  for (std::size_t k = 0; k < count; ++k)
    add_entered(from + stops[k]->offset, *stops[k], weight / static_cast<float>(count), leaving,
                sum);
}

/// @param every looks along one vector in so many, others than its neighbours do.
BounceLight::Light BounceLight::gathered_by(const Face& face, const SeenSky& seen,
                                            std::span<const Light> leaving,
                                            std::uint32_t every) const {
  Light sum;
  const Hemisphere& way = hemisphere(face.direction);
  const FaceAxes axes(face.direction);
  const std::array<int, 3> at{face.front.x, face.front.y, face.front.z};
  const int b = at[static_cast<std::size_t>(axes.b)], c = at[static_cast<std::size_t>(axes.c)];
  const std::uint32_t first = static_cast<std::uint32_t>(b + (every == 2 ? c : 2 * c)) % every;
  float looked = 0.0f;
  for (std::size_t k = first; k < shared::kSkyPatternCount; k += every) looked += way.weight[k];
  for (const int octant : way.octants) {
    const std::uint32_t bits = seen[static_cast<std::size_t>(octant)];
    for (std::size_t k = first; k < shared::kSkyPatternCount; k += every)
      if ((bits >> k & 1u) == 0)
        add_from(face.front, static_cast<std::size_t>(octant) * shared::kSkyPatternCount + k,
                 way.weight[k] * (kIrradianceOfOctant / looked), leaving, sum);
  }
  return sum;
}

void BounceLight::follow(int step, int part, std::span<const SeenSky> seen,
                         const LampLightMap& lamps) {
  std::vector<Light>& to = leaving_[static_cast<std::size_t>(step % 2)];
  const std::vector<Light>& from = leaving_[static_cast<std::size_t>(1 - step % 2)];
  const std::size_t count = faces_.size(), p = static_cast<std::size_t>(part);
  for (std::size_t i = count * p / kParts; i < count * (p + 1) / kParts; ++i) {
    const Face& face = faces_[i];
    Light light;
    if (step > 0)
      light = gathered_by(face, seen[wanted_.of(face.front)], from, step == kSteps - 1 ? 2 : 4);
    if (step < kSteps - 1) {
      light += direct_of(face, seen, lamps);
      light = reflected(face, light);
    }
    to[i] = light;
  }
}

}  // namespace skerry::world
