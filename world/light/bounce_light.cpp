#include "world/light/bounce_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <utility>

#include "world/light/base/face_records.h"
#include "world/light/base/shared_exponent.h"
#include "world/voxel/blocks.h"

namespace skerry::world {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kIrradianceOfOctant = kPi / 4.0f;  // under radiance 1
constexpr float kShapeSteps = 127.0f;
constexpr std::uint32_t kFirstEvery = 4, kLastEvery = 2;
constexpr std::uint8_t kDeepest = 32;  // voxels: below, water is as if it was so deep

/// Fans of a face, and what each pattern of theirs weighs.
struct Hemisphere {
  std::array<std::size_t, 4> fans{};
  std::array<float, shared::kSkyPatternCount> weight{};
};

Hemisphere hemisphere_of(int face) {
  Hemisphere out;
  out.fans = fans_of_face(face);
  const LobeWeights& weights = lobe_weights(face / 2);
  float sum = 0.0f;
  for (std::size_t k = 0; k < out.weight.size(); ++k)
    sum += out.weight[k] = static_cast<float>(weights[k]);
  for (float& weight : out.weight) weight *= kIrradianceOfOctant / sum;
  return out;
}

const Hemisphere& hemisphere(int face) {
  static const std::array<Hemisphere, 6> kAll{hemisphere_of(0), hemisphere_of(1), hemisphere_of(2),
                                              hemisphere_of(3), hemisphere_of(4), hemisphere_of(5)};
  return kAll[static_cast<std::size_t>(face)];
}

/// Null: the line passes no glass.
const GlassTints::Tint* tint_of(const GlassTints::Tints& tints, std::size_t pattern) {
  const auto found = std::ranges::find(tints, pattern, &GlassTints::Tint::pattern);
  return found == tints.end() ? nullptr : &*found;
}

/// Harmonics of a lattice vector.
const std::array<float, kHarmonics>& harmonics_along(std::size_t fan, std::size_t pattern) {
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
  return kAll[static_cast<std::size_t>(octant_of(fan)) * shared::kSkyPatternCount + pattern];
}

bool is_liquid(const shared::Quad& quad) {
  return block_types()[shared::surface_block(quad.material)].liquid;
}

}  // namespace

glm::vec3 left_by_water(float blocks) {
  constexpr float kIndex = 1.333f, kAlbedo = 0.45f, kMirroredBack = 0.475f;
  const glm::vec3 down = left_by_glass(block::kWater, 1.18f * blocks), twice = down * down;
  return 0.933f * 0.933f / (kIndex * kIndex) * twice /
         (1.0f - kAlbedo * kMirroredBack * twice * twice);
}

BounceLight::Light& BounceLight::Light::add(const Light& other, float weight) {
  mean += weight * other.mean;
  for (std::size_t i = 0; i < shape.size(); ++i) shape[i] += weight * other.shape[i];
  lamps += weight * other.lamps;
  for (std::size_t slot = 0; slot < keyed.size(); ++slot) keyed[slot] += weight * other.keyed[slot];
  return *this;
}

BounceLight::Light& BounceLight::Light::operator*=(float factor) {
  mean *= factor;
  for (float& value : shape) value *= factor;
  lamps *= factor;
  for (glm::vec3& light : keyed) light *= factor;
  return *this;
}

BounceLight::Light& BounceLight::Light::tint(const glm::vec3& left) {
  const float before = luminance(mean);
  mean *= left;
  lamps *= left;
  for (glm::vec3& light : keyed) light *= left;
  const float kept = before > 0.0f ? luminance(mean) / before : luminance(left);
  for (float& value : shape) value *= kept;
  return *this;
}

BounceLight::PackedLight BounceLight::packed(const Light& light) {
  PackedLight out{pack_shared_exponent(light.mean), pack_shared_exponent(light.lamps), {}, {}};
  for (std::size_t slot = 0; slot < out.keyed.size(); ++slot)
    out.keyed[slot] = pack_shared_exponent(light.keyed[slot]);
  const float most = luminance(light.mean) * shared::kMostBounceShape;
  if (most <= 0.0f) return out;
  for (std::size_t i = 0; i < out.shape.size(); ++i)
    out.shape[i] = static_cast<std::int8_t>(
        std::lround(std::clamp(light.shape[i] / most, -1.0f, 1.0f) * kShapeSteps));
  return out;
}

BounceLight::Light BounceLight::unpacked(const PackedLight& light) {
  Light out{unpack_shared_exponent(light.mean), {}, unpack_shared_exponent(light.lamps), {}};
  for (std::size_t slot = 0; slot < out.keyed.size(); ++slot)
    out.keyed[slot] = unpack_shared_exponent(light.keyed[slot]);
  const float step = luminance(out.mean) * (shared::kMostBounceShape / kShapeSteps);
  for (std::size_t i = 0; i < out.shape.size(); ++i)
    out.shape[i] = step * static_cast<float>(light.shape[i]);
  return out;
}

// --- Faces ---

BounceLight::BounceLight(const LightChunks& chunks, const AirVolume& air, const LatticeLines& lines,
                         OpeningRayWays& ways, const VoxelIndex& wanted, const GlassTints& tints,
                         std::span<const FaceAlbedo> albedo, int bounces, const KeyDirections& keys)
    : steps_(bounces + 1),
      air_(air),
      lines_(lines),
      ways_(ways),
      wanted_(wanted),
      tints_(tints),
      albedo_(albedo) {
  numbers_.assign(wanted_.size() * 6, 0);
  if (!chunks.empty()) voxel_blocks_ = chunks.begin()->second->voxel_blocks;
  water_ = find_water(chunks);
  for (const auto& [at, chunk] : chunks) {
    const IVec3 corner = corner_of(at);
    for (const shared::Quad& quad : chunk->quads)
      for_each_face(quad, [&](const DrawnFace& drawn) {
        set_face(corner + drawn.voxel + to_front(drawn), drawn.direction,
                 static_cast<std::uint16_t>(shared::surface_block(quad.material)), drawn.plant);
      });
  }
  relit_.clear();
  make_room();
  for (std::vector<PackedLight>& light : leaving_) light.resize(faces_.size());
  for (std::size_t slot = 0; slot < keys.size(); ++slot)
    if (keys[slot]) set_key(slot, *keys[slot]);
}

void BounceLight::make_room() {
  sources_.resize(faces_.size());
  if (tints_.any()) glass_on_rays_.resize(faces_.size(), 0);
}

BounceLight::Number BounceLight::number_of(IVec3 front, int direction) const {
  if (!wanted_.has(front)) return 0;
  return numbers_[wanted_.of(front) * 6 + static_cast<std::size_t>(direction)];
}

std::optional<BounceLight::Light> BounceLight::received(IVec3 front, int direction,
                                                        bool plant) const {
  const Number number = number_of(front, direction);
  if (number == 0) return std::nullopt;
  const auto last = static_cast<std::size_t>(steps_ - 1);
  Light light = unpacked(leaving_[last][number - 1]);
  if (plant || !faces_[number - 1].plant) return light;
  light *= 1.0f - kUnderPlant;
  return light.add(unpacked(leaving_[last - 1][number - 1]), kUnderPlant * kPi);
}

bool BounceLight::set_face(IVec3 front, int direction, std::uint16_t block, bool plant) {
  if (!wanted_.has(front)) return false;
  Number& number = numbers_[wanted_.of(front) * 6 + static_cast<std::size_t>(direction)];
  const bool is_new = number == 0;
  if (is_new) {
    if (free_faces_.empty()) {
      faces_.emplace_back();
      number = static_cast<Number>(faces_.size());
    } else {
      number = 1 + free_faces_.back();
      free_faces_.pop_back();
    }
    faces_[number - 1] = {.front = front,
                          .direction = static_cast<std::uint8_t>(direction),
                          .depth = depth_of(front)};
    relit_.add(number - 1);
  }
  Face& face = faces_[number - 1];
  face.plant |= plant;
  if (plant || (face.ground && face.block == block)) return is_new;
  face.ground = true;
  face.block = block;
  relit_.add(number - 1);
  return is_new;
}

void BounceLight::remove_face(IVec3 front, int direction, bool plant) {
  if (!wanted_.has(front)) return;
  Number& number = numbers_[wanted_.of(front) * 6 + static_cast<std::size_t>(direction)];
  if (number == 0) return;
  Face& face = faces_[number - 1];
  if (plant) {
    face.plant = false;
  } else {
    face.ground = false;
    face.block = 0;
    relit_.add(number - 1);
  }
  if (face.ground || face.plant) return;
  free_faces_.push_back(number - 1);
  number = 0;
}

void BounceLight::move_voxels(std::span<const VoxelIndex::Moved> moved) {
  numbers_.resize(wanted_.size() * 6, 0);
  for (const VoxelIndex::Moved& m : moved)
    std::copy_n(numbers_.begin() + static_cast<std::ptrdiff_t>(m.from * 6), 6,
                numbers_.begin() + static_cast<std::ptrdiff_t>(m.to * 6));
}

void BounceLight::forget_voxel(std::size_t number) {
  for (std::size_t i = number * 6; i < number * 6 + 6; ++i) numbers_[i] = 0;
}

BounceLight::Light BounceLight::reflected(const Face& face, Light light) const {
  const glm::vec3 share =
      face.block < albedo_.size() ? albedo_[face.block][face.direction] / kPi : glm::vec3(0.0f);
  light.tint(share);
  if (face.depth == 0) return light;
  const glm::vec3 lamps = light.lamps;  // may stand in the water
  light.tint(left_of(face)).lamps = lamps;
  return light;
}

// --- Water ---

/// In columns, from each surface down to the ground or to where the water ends.
std::vector<BounceLight::Water> BounceLight::find_water(const LightChunks& chunks) const {
  std::vector<IVec3> surfaces, ends;
  for (const auto& [at, chunk] : chunks)
    for (const shared::Quad& quad : chunk->quads)
      if (is_liquid(quad))
        for_each_face(quad, [&, corner = corner_of(at)](const DrawnFace& face) {
          if (face.direction == 2) surfaces.push_back(corner + face.voxel);
          if (face.direction == 3) ends.push_back(corner + face.voxel);
        });
  std::ranges::sort(ends);
  std::vector<Water> out;
  for (IVec3 voxel : surfaces)
    for (std::uint8_t depth = 1; lines_.inside(voxel) && !lines_.is_opaque(voxel); --voxel.y) {
      out.push_back({voxel, depth});
      if (std::ranges::binary_search(ends, voxel)) break;
      if (depth < kDeepest) ++depth;
    }
  std::ranges::sort(out, {}, [](const Water& one) { return std::pair(one.voxel, one.depth); });
  return out;
}

std::uint8_t BounceLight::depth_of(IVec3 voxel) const {
  const auto found = std::ranges::lower_bound(water_, voxel, {}, &Water::voxel);
  return found != water_.end() && found->voxel == voxel ? found->depth : std::uint8_t{0};
}

glm::vec3 BounceLight::left_of(const Face& face) const {
  // A face that looks up lies at its voxel's lower end.
  const float depth = static_cast<float>(face.depth) - (face.direction == 2 ? 0.0f : 0.5f);
  return left_by_water(depth * voxel_blocks_);
}

bool BounceLight::moves_water(std::span<const IVec3> changed, bool surfaces) const {
  return surfaces || (!water_.empty() && std::ranges::any_of(changed, [&](IVec3 voxel) {
           return depth_of(voxel) != 0 || depth_of(voxel + IVec3{0, 1, 0}) != 0;
         }));
}

void BounceLight::take_water(const LightChunks& chunks) {
  std::vector<Water> before = std::exchange(water_, find_water(chunks));
  const auto look = [&](IVec3 voxel) {
    if (!wanted_.has(voxel)) return;
    const std::uint8_t depth = depth_of(voxel);
    const std::size_t base = wanted_.of(voxel) * 6;
    for (std::size_t direction = 0; direction < 6; ++direction)
      if (const Number number = numbers_[base + direction])
        if (std::exchange(faces_[number - 1].depth, depth) != depth) relit_.add(number - 1);
  };
  for (const std::vector<Water>* all : {&before, &water_})
    for (const Water& one : *all) look(one.voxel);
}

// --- Lines and rays ---

/// The face that a line or ray comes in by, or the plant that stops it. @param voxel that stops it.
BounceLight::Source BounceLight::source_of(IVec3 voxel, int entered) const {
  const Number face = number_of(voxel + to_front({{}, entered, false}), entered);
  if (face != 0) return face;
  const Number plant = number_of(voxel, 2);
  return plant != 0 && faces_[plant - 1].plant ? plant : kNothing;
}

BounceLight::Source BounceLight::source_at(IVec3 last, std::size_t way) const {
  const LatticeLines::Passed& stop = lines_.way(way).passed[lines_.passed_before_stop(last, way)];
  return source_of(last + stop.offset, stop.entered);
}

/// Which of the vectors of an octant a face looks along: every so many from there, others than its
/// neighbours do.
std::uint32_t BounceLight::first_of(const Face& face, std::uint32_t every) const {
  const FaceAxes axes(face.direction);
  const std::array<int, 3> at{face.front.x, face.front.y, face.front.z};
  const int b = at[static_cast<std::size_t>(axes.b)], c = at[static_cast<std::size_t>(axes.c)];
  return static_cast<std::uint32_t>(b + (every == 2 ? c : 2 * c)) % every;
}

/// Calls fn(place in a face's sources) for each of its lines along a pattern of a quarter: of the
/// first reflections, of the last, or neither.
template <class Fn>
void BounceLight::for_each_line(const Face& face, std::size_t quarter, std::size_t pattern,
                                const Fn& fn) const {
  const auto line = [&](std::uint32_t every) {
    return quarter * (kPatterns / every) + pattern / every;
  };
  if (pattern % kFirstEvery == first_of(face, kFirstEvery)) fn(line(kFirstEvery));
  if (pattern % kLastEvery == first_of(face, kLastEvery)) fn(kFirstLines + line(kLastEvery));
}

/// What comes along a line that does not end at the sky.
BounceLight::Source BounceLight::look(IVec3 from, std::size_t way) const {
  const std::optional<IVec3> last = lines_.end_of(from, way);
  return last ? source_at(*last, way) : kNothing;
}

void BounceLight::look_along_ray(Number number, std::size_t ray) {
  const Face& face = faces_[number];
  const auto end = ways_.end_of(face.front, face.direction, ray);
  const Source source = end ? source_of(end->voxel, end->entered) : kNothing;
  sources_[number][ray] = source;
  if (glass_on_rays_.empty()) return;
  const std::uint64_t bit = std::uint64_t{1} << ray;
  if (source != kNothing && ways_.passes_glass(face.front, face.direction, ray))
    glass_on_rays_[number] |= bit;
  else
    glass_on_rays_[number] &= ~bit;
}

void BounceLight::look_along(Number number, const SeenSky& seen) {
  Face& face = faces_[number];
  face.rays = has_rays(face, seen);
  if (face.rays) {
    for (std::size_t ray = 0; ray < kLastRays; ++ray) look_along_ray(number, ray);
    return;
  }
  const std::size_t voxel = wanted_.of(face.front);
  std::array<Source, kLines>& sources = sources_[number];
  std::size_t quarter = 0;
  for (const std::size_t fan : hemisphere(face.direction).fans) {
    const std::uint32_t bits = seen.of(voxel, fan);
    for (std::size_t k = 0; k < kPatterns; ++k) {
      std::optional<Source> source;  // looked for once, and only for those that look there
      for_each_line(face, quarter, k, [&](std::size_t line) {
        if (!source)
          source =
              (bits >> k & 1u) != 0 ? kNothing : look(face.front, LatticeLines::way_number(fan, k));
        sources[line] = *source;
      });
    }
    ++quarter;
  }
}

void BounceLight::set_line(IVec3 voxel, std::size_t way, Source source) {
  make_room();
  const std::size_t fan = way / kPatterns;
  const int axis = axis_of(fan), direction = 2 * axis + (octant_of(fan) >> axis & 1);
  const Number number = number_of(voxel, direction);
  if (number == 0 || faces_[number - 1].rays) return;
  const auto& fans = hemisphere(direction).fans;
  const auto quarter =
      static_cast<std::size_t>(std::find(fans.begin(), fans.end(), fan) - fans.begin());
  for_each_line(faces_[number - 1], quarter, way % kPatterns, [&](std::size_t line) {
    if (std::exchange(sources_[number - 1][line], source) == source) return;
    relooked_.add(number - 1);
    add_reader(source, number - 1);
  });
}

void BounceLight::look_again(Number number, const SeenSky& seen) {
  look_along(number, seen);
  relooked_.add(number);
  for (const Source source : sources_[number]) add_reader(source, number);
  if (faces_[number].rays && ways_.has_origins()) ways_.add_origin(faces_[number].front);
}

void BounceLight::look_from(IVec3 voxel, const SeenSky& seen) {
  const std::size_t base = wanted_.of(voxel) * 6;
  make_room();
  for (std::size_t direction = 0; direction < 6; ++direction)
    if (const Number number = numbers_[base + direction]) look_again(number - 1, seen);
}

void BounceLight::choose_rays(IVec3 voxel, const SeenSky& seen) {
  const std::size_t base = wanted_.of(voxel) * 6;
  for (std::size_t direction = 0; direction < 6; ++direction) {
    const Number number = numbers_[base + direction];
    if (number == 0 || faces_[number - 1].rays == has_rays(faces_[number - 1], seen)) continue;
    look_again(number - 1, seen);
  }
}

void BounceLight::add_origins() const {
  for (const Face& face : faces_)
    if (face.rays && number_of(face.front, face.direction) != 0) ways_.add_origin(face.front);
}

void BounceLight::follow_ray(IVec3 front, int face, std::size_t ray) {
  if (ray >= kLastRays) return;
  const Number number = number_of(front, face);
  if (number == 0 || !faces_[number - 1].rays) return;
  const bool had_glass = !glass_on_rays_.empty() && (glass_on_rays_[number - 1] >> ray & 1) != 0;
  const Source before = sources_[number - 1][ray];
  look_along_ray(number - 1, ray);
  const Source source = sources_[number - 1][ray];
  const bool has_glass = !glass_on_rays_.empty() && (glass_on_rays_[number - 1] >> ray & 1) != 0;
  if (source == before && !had_glass && !has_glass) return;
  relooked_.add(number - 1);
  if (source != before) add_reader(source, number - 1);
}

void BounceLight::relight(IVec3 voxel) {
  const std::size_t base = wanted_.of(voxel) * 6;
  for (std::size_t direction = 0; direction < 6; ++direction)
    if (const Number number = numbers_[base + direction]) relit_.add(number - 1);
}

void BounceLight::retint(IVec3 voxel) {
  relight(voxel);
  const std::size_t base = wanted_.of(voxel) * 6;
  for (std::size_t direction = 0; direction < 6; ++direction)
    if (const Number number = numbers_[base + direction]) relooked_.add(number - 1);
}

void BounceLight::shade_behind(IVec3 voxel) {
  for (const std::optional<BodyRays>& body : bodies_)
    if (body)
      body->for_each_behind(voxel, [&](IVec3 behind) {
        if (wanted_.has(behind)) relight(behind);
      });
}

// --- Light ---

/// Of the sky, what a face loses to glass: to be taken from its direct light.
BounceLight::Light BounceLight::lost_to_glass(std::size_t voxel, const Face& face,
                                              const SeenSky& seen) const {
  const Hemisphere& way = hemisphere(face.direction);
  Light lost;
  for (const std::size_t fan : way.fans) {
    const GlassTints::Tints* tints = tints_.find(voxel, fan);
    if (tints == nullptr) continue;
    const std::uint32_t bits = seen.of(voxel, fan);
    for (const GlassTints::Tint& tint : *tints) {
      if ((bits >> tint.pattern & 1u) == 0) continue;
      const auto& basis = harmonics_along(fan, tint.pattern);
      const glm::vec3 share = (1.0f - tint.left) * way.weight[tint.pattern];
      lost.mean += share * basis[0];
      for (std::size_t i = 0; i < lost.shape.size(); ++i)
        lost.shape[i] += luminance(share) * basis[i + 1];
    }
  }
  return lost;
}

BounceLight::Light BounceLight::direct_of(const Face& face, const SeenSky& seen,
                                          const LampLightMap& lamps) const {
  const std::size_t voxel = wanted_.of(face.front);
  const Hemisphere& way = hemisphere(face.direction);
  std::array<float, kHarmonics> sum{};
  for (const std::size_t fan : way.fans) {
    const std::uint32_t bits = seen.of(voxel, fan);
    if (bits == 0) continue;
    for (std::size_t k = 0; k < shared::kSkyPatternCount; ++k) {
      if ((bits >> k & 1u) == 0) continue;
      const auto& basis = harmonics_along(fan, k);
      for (std::size_t i = 0; i < kHarmonics; ++i) sum[i] += way.weight[k] * basis[i];
    }
  }
  Light out;
  out.mean = glm::vec3(sum[0]);
  std::copy(sum.begin() + 1, sum.end(), out.shape.begin());
  if (tints_.has(voxel)) {
    out.add(lost_to_glass(voxel, face, seen), -1.0f);
    out.mean = glm::max(out.mean, glm::vec3(0.0f));  // but for rounding
  }
  if (const LampLight* lit = lamps.find(voxel)) out.lamps = (*lit)[face.direction];
  return out;
}

/// Direct light from the key directions.
void BounceLight::look_at_bodies(Number number) {
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot)
    if (bodies_[slot])
      from_body_[slot][number] = pack_shared_exponent(
          bodies_[slot]->on_face(faces_[number].front, faces_[number].direction));
}

/// Of lines or rays that a step takes.
std::span<const BounceLight::Source> BounceLight::sources_of(Number number, int step) const {
  const std::span<const Source> all(sources_[number]);
  if (faces_[number].rays) return all.first(is_last(step) ? kLastRays : kFirstRays);
  return is_last(step) ? all.last(kLastLines) : all.first(kFirstLines);
}

/// Calls fn(face, share of its light, what glass leaves of it or null) for the faces at which a
/// face's lines or rays end.
template <class Fn>
void BounceLight::for_each_sender(Number number, int step, const Fn& fn) const {
  const Face& face = faces_[number];
  const std::span<const Source> sources = sources_of(number, step);
  if (face.rays) {
    const std::uint64_t glass = glass_on_rays_.empty() ? 0 : glass_on_rays_[number];
    const float weight = kPi / static_cast<float>(sources.size());
    for (std::size_t ray = 0; ray < sources.size(); ++ray) {
      if (sources[ray] == kNothing) continue;
      if ((glass >> ray & 1) == 0) {
        fn(sources[ray] - 1, weight, nullptr);
        continue;
      }
      const glm::vec3 left = ways_.left_by_glass(face.front, face.direction, ray);
      fn(sources[ray] - 1, weight, &left);
    }
    return;
  }
  const Hemisphere& way = hemisphere(face.direction);
  const std::uint32_t every = is_last(step) ? kLastEvery : kFirstEvery,
                      first = first_of(face, every);
  float looked = 0.0f;
  for (std::size_t k = first; k < kPatterns; k += every) looked += way.weight[k];
  const float whole = kIrradianceOfOctant / looked;
  const std::size_t voxel = tints_.any() ? wanted_.of(face.front) : 0;
  const Source* source = sources.data();
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    const GlassTints::Tints* tints = tints_.any() ? tints_.find(voxel, way.fans[quarter]) : nullptr;
    for (std::size_t k = first; k < kPatterns; k += every, ++source) {
      if (*source == kNothing) continue;
      const float weight = way.weight[k] * whole;
      const GlassTints::Tint* tint = tints ? tint_of(*tints, k) : nullptr;
      fn(*source - 1, weight, tint ? &tint->left : nullptr);
    }
  }
}

/// What comes along a face's lines of what left other faces at the step before.
BounceLight::Light BounceLight::gathered(Number number, int step) const {
  const std::vector<PackedLight>& leaving = leaving_[static_cast<std::size_t>(step - 1)];
  Light sum;
  for_each_sender(number, step, [&](Number from, float share, const glm::vec3* left) {
    Light light = unpacked(leaving[from]);
    if (left) light.tint(*left);
    sum.add(light, share);
  });
  return sum;
}

BounceLight::PackedLight BounceLight::light_of(Number number, int step, const SeenSky& seen,
                                               const LampLightMap& lamps) const {
  const Face& face = faces_[number];
  Light light;
  if (step > 0) light = gathered(number, step);
  if (is_last(step)) return packed(light);
  light += direct_of(face, seen, lamps);
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot)
    if (bodies_[slot]) light.keyed[slot] += unpack_shared_exponent(from_body_[slot][number]);
  return packed(reflected(face, light));
}

void BounceLight::follow(int step, int part, const SeenSky& seen, const LampLightMap& lamps) {
  const std::size_t count = faces_.size(), p = static_cast<std::size_t>(part);
  for (std::size_t i = count * p / kParts; i < count * (p + 1) / kParts; ++i) {
    const auto number = static_cast<Number>(i);
    if (step == 0) {
      look_along(number, seen);
      look_at_bodies(number);
    }
    leaving_[static_cast<std::size_t>(step)][i] = light_of(number, step, seen, lamps);
  }
}

void BounceLight::set_key(std::size_t slot, const glm::vec3& to_body) {
  bodies_[slot].emplace(air_, to_body);
  from_body_[slot].assign(faces_.size(), 0);
  make_room();
}

// As light_of() has it for all light.
void BounceLight::follow_key(std::size_t slot, int step, int part) {
  const std::size_t count = faces_.size(), p = static_cast<std::size_t>(part);
  for (std::size_t i = count * p / kParts; i < count * (p + 1) / kParts; ++i) {
    const auto number = static_cast<Number>(i);
    if (!exists(number)) continue;
    const Face& face = faces_[i];
    std::uint32_t& direct = from_body_[slot][i];
    if (step == 0)
      direct = pack_shared_exponent(bodies_[slot]->on_face(face.front, face.direction));
    glm::vec3 sum(0.0f);
    if (step > 0) {
      const std::vector<PackedLight>& before = leaving_[static_cast<std::size_t>(step - 1)];
      for_each_sender(number, step, [&](Number from, float share, const glm::vec3* left) {
        glm::vec3 light = unpack_shared_exponent(before[from].keyed[slot]);
        if (left) light *= *left;
        sum += share * light;
      });
    }
    Light light;
    light.keyed[slot] = sum;
    if (!is_last(step)) {
      light.keyed[slot] += unpack_shared_exponent(direct);
      light = reflected(face, light);
    }
    leaving_[static_cast<std::size_t>(step)][i].keyed[slot] =
        pack_shared_exponent(light.keyed[slot]);
  }
}

std::size_t BounceLight::bytes() const {
  std::size_t bytes = numbers_.size() * sizeof(Number) + faces_.size() * sizeof(Face) +
                      sources_.size() * sizeof(sources_[0]) + readers_.size() * sizeof(Number) +
                      water_.size() * sizeof(Water) + glass_on_rays_.size() * sizeof(std::uint64_t);
  for (const std::vector<std::uint32_t>& from : from_body_)
    bytes += from.size() * sizeof(std::uint32_t);
  for (const std::vector<PackedLight>& light : leaving_)
    bytes += light.size() * sizeof(PackedLight);
  return bytes;
}

/// By counting, then filling from the ends.
void BounceLight::list_readers() {
  if (!first_reader_.empty()) return;
  first_reader_.assign(faces_.size() + 1, 0);
  for (const std::array<Source, kLines>& sources : sources_)
    for (const Source source : sources)
      if (source != kNothing) ++first_reader_[source - 1];
  std::uint32_t sum = 0;
  for (std::uint32_t& first : first_reader_) first = sum += first;
  readers_.resize(sum);
  for (Number reader = 0; reader < sources_.size(); ++reader)
    for (const Source source : sources_[reader])
      if (source != kNothing) readers_[--first_reader_[source - 1]] = reader;
}

void BounceLight::add_reader(Source source, Number reader) {
  if (source == kNothing) return;
  std::vector<Number>& readers = more_readers_[source - 1];
  if (!readers.empty() && readers.back() == reader) return;
  readers.push_back(reader);
  ++more_count_;
}

/// Whether a face receives at a step what has changed at the step before.
bool BounceLight::comes_from(Number number, int step, const Marked& changed) const {
  return std::ranges::any_of(sources_of(number, step), [&](Source source) {
    return source != kNothing && changed.has(source - 1);
  });
}

std::vector<BounceLight::Changed> BounceLight::follow_changes(const SeenSky& seen,
                                                              const LampLightMap& lamps) {
  list_readers();
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot)
    if (bodies_[slot]) from_body_[slot].resize(faces_.size());
  for (const Number number : relit_.all())
    if (exists(number)) look_at_bodies(number);
  std::array<Marked, 2> changed;  // by parity of the step
  for (int step = 0; step < steps_; ++step) {
    std::vector<PackedLight>& leaving = leaving_[static_cast<std::size_t>(step)];
    leaving.resize(faces_.size());
    const auto parity = static_cast<std::size_t>(step % 2);
    const Marked& before = changed[1 - parity];
    Marked& now = changed[parity];
    now.clear();
    const auto look = [&](Number number) {
      if (!exists(number)) return;
      const PackedLight light = light_of(number, step, seen, lamps);
      if (light == std::exchange(leaving[number], light)) return;
      now.add(number);
    };
    const bool last = is_last(step);
    if (!last)
      for (const Number number : relit_.all()) look(number);
    if (step == 0) continue;
    const auto done = [&](Number number) { return !last && relit_.has(number); };
    for (const Number number : relooked_.all())
      if (!done(number)) look(number);
    Marked tried;
    const auto try_all = [&](std::span<const Number> readers) {
      for (const Number reader : readers) {
        if (tried.has(reader) || done(reader) || relooked_.has(reader)) continue;
        tried.add(reader);
        if (comes_from(reader, step, before)) look(reader);
      }
    };
    for (const Number number : before.all()) {
      if (number + 1 < first_reader_.size())
        try_all(
            {readers_.data() + first_reader_[number], readers_.data() + first_reader_[number + 1]});
      if (const auto more = more_readers_.find(number); more != more_readers_.end())
        try_all(more->second);
    }
  }
  relit_.clear();
  relooked_.clear();
  std::vector<Changed> out;
  const auto last = static_cast<std::size_t>(steps_ - 1) % 2;
  for (const Number number : changed[last].all())
    out.push_back({faces_[number].front, faces_[number].direction});
  for (const Number number : changed[1 - last].all())
    if (faces_[number].plant && !changed[last].has(number))
      out.push_back({faces_[number].front, faces_[number].direction});
  return out;
}

}  // namespace skerry::world
