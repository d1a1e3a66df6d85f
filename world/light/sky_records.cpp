// SkyTransfer's records: what has been found, as means at the corners of faces in the GPU's words.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/vec2.hpp>

#include "world/light/base/shared_exponent.h"
#include "world/light/sky_transfer.h"

namespace skerry::world {

/// The voxels about a face: 3 x 3 of them in its plane, the one before the face in the middle.
struct SkyTransfer::Around {
  std::array<IVec3, 9> voxels{};
  std::array<bool, 9> air{};

  /// Those of them about a corner, b + 2 c, that hang together: first the one before the face.
  struct Some {
    std::array<std::size_t, 4> at{};
    std::size_t count = 0;
    auto begin() const { return at.begin(); }
    auto end() const { return at.begin() + static_cast<std::ptrdiff_t>(count); }
  };
  Some about(std::size_t corner) const {
    const std::size_t across = corner & 1 ? 5 : 3, along = corner & 2 ? 7 : 1;
    Some out{{4}, 1};
    if (air[across]) out.at[out.count++] = across;
    if (air[along]) out.at[out.count++] = along;
    if (out.count > 1 && air[across + along - 4]) out.at[out.count++] = across + along - 4;
    return out;
  }
};

using LobeShares = std::array<std::uint32_t, shared::kSkyLobes>;  // of 65280

/// What a face before a voxel sees of the sky.
struct SkyTransfer::View {
  LobeShares lobes{};
  std::optional<std::uint64_t> rays;  // those of OpeningRays that see it, where they are asked
};

namespace {

// Of the ground's sky, that a plant on it takes: 1/4, as BounceLight::kUnderPlant has it.
constexpr std::uint32_t kPartUnderPlant = 4;

/// What a face's lobes see of the sky from a voxel.
LobeShares lobes_from(const SeenSky& seen, std::size_t voxel, int face) {
  LobeShares out{};
  for (const std::size_t fan : fans_of_face(face))
    add_lobes_seen(axis_of(fan), octant_of(fan), seen.of(voxel, fan), out);
  return out;
}

/// Light of an even sky on a face from a voxel, as its lobes say and by colour. All of the sky: the
/// weights of four octants.
struct Tinted {
  glm::vec3 light{0.0f};
  float lobes = 0.0f;
  Tinted& operator+=(const Tinted& other) {
    light += other.light;
    lobes += other.lobes;
    return *this;
  }
};

/// Takes from the lobes what glass takes of a line or a ray, of the colour that it takes least of.
/// @param whole what a line or ray is of its lobe. @param weight of all of an octant's, alike.
void tint_lobe(std::uint32_t& lobe, float whole, float weight, const glm::vec3& left, Tinted& out) {
  const float best = std::max({left.x, left.y, left.z});
  out += {weight * (left - 1.0f), weight * (best - 1.0f)};
  lobe -= std::min(lobe, static_cast<std::uint32_t>(std::lround(whole * (1.0f - best))));
}

/// Takes from the lobes what glass takes of the colour that it takes least of.
Tinted tint_lobes(const SeenSky& seen, const GlassTints& tints, std::size_t voxel, int face,
                  LobeShares& lobes) {
  const LobeWeights& weights = lobe_weights(face / 2);
  Tinted out;
  for (const std::size_t fan : fans_of_face(face)) {
    const std::uint32_t bits = seen.of(voxel, fan);
    for (std::uint32_t left = bits; left != 0; left &= left - 1) {
      const auto weight = static_cast<float>(weights[std::countr_zero(left)]);
      out += {glm::vec3(weight), weight};
    }
    const GlassTints::Tints* its = tints.find(voxel, fan);
    if (its == nullptr) continue;
    for (const GlassTints::Tint& tint : *its) {
      if ((bits >> tint.pattern & 1u) == 0) continue;
      LobeShares whole{};
      add_lobes_seen(axis_of(fan), octant_of(fan), 1u << tint.pattern, whole);
      const std::size_t lobe = lobe_of(axis_of(fan), octant_of(fan), tint.pattern);
      tint_lobe(lobes[lobe], static_cast<float>(whole[lobe]),
                static_cast<float>(weights[tint.pattern]), tint.left, out);
    }
  }
  return out;
}

/// As tint_lobes(), where rays are asked.
Tinted tint_rays(const OpeningRayWays& ways, IVec3 voxel, int face, std::uint64_t rays,
                 LobeShares& lobes) {
  constexpr float kWeight = 4.0f * 65280.0f / OpeningRays::kRays;
  Tinted out;
  for (std::uint64_t left = rays; left != 0; left &= left - 1) {
    const auto ray = static_cast<std::size_t>(std::countr_zero(left));
    const std::size_t lobe = OpeningRays::lobe_of_ray(voxel, face, ray);
    const auto whole =
        static_cast<float>(OpeningRays::lobes(voxel, face, std::uint64_t{1} << ray)[lobe]);
    out += {glm::vec3(kWeight), kWeight};
    tint_lobe(lobes[lobe], whole, kWeight, ways.left_by_glass(voxel, face, ray), out);
  }
  return out;
}

/// Of a voxel of Around, which of its own corners a corner of the one in the middle is.
std::size_t corner_within(std::size_t at, std::size_t corner) {
  return corner ^ (at % 3 != 1 ? 1u : 0u) ^ (at / 3 != 1 ? 2u : 0u);
}

using Corners = std::array<BounceLight::Light, 4>;

std::uint32_t signed_byte(float value) {
  const long byte = std::lround(std::clamp(value, -1.0f, 1.0f) * 127.0f);
  return static_cast<std::uint32_t>(byte) & 255u;
}

/// Colour and shape of all corners together, and the share of each of the brightest.
glm::uvec4 packed(const Corners& corners) {
  BounceLight::Light all;
  float most = 0.0f;
  for (const BounceLight::Light& corner : corners) {
    all.mean += corner.mean;
    for (std::size_t i = 0; i < all.shape.size(); ++i) all.shape[i] += corner.shape[i];
    most = std::max(most, luminance(corner.mean));
  }
  glm::uvec4 out(0);
  if (most <= 0.0f) return out;
  const float sum = luminance(all.mean);
  out.x = pack_shared_exponent(all.mean * (most / sum));
  for (std::size_t i = 0; i < 4; ++i)
    out.y |= static_cast<std::uint32_t>(std::lround(luminance(corners[i].mean) / most * 255.0f))
             << (8 * i);
  for (std::size_t i = 0; i < all.shape.size(); ++i)
    out[static_cast<int>(2 + i / 4)] |= signed_byte(all.shape[i] / sum / shared::kMostBounceShape)
                                        << (8 * (i % 4));
  return out;
}

/// Colour from a key direction, of the brightest corner, and the share of each.
glm::uvec2 packed_from_key(const Corners& corners, std::size_t slot) {
  glm::vec3 sum(0.0f);
  float most = 0.0f;
  for (const BounceLight::Light& corner : corners) {
    sum += corner.keyed[slot];
    most = std::max(most, luminance(corner.keyed[slot]));
  }
  glm::uvec2 out(0);
  if (most <= 0.0f) return out;
  out.x = pack_shared_exponent(sum * (most / luminance(sum)));
  for (std::size_t i = 0; i < 4; ++i)
    out.y |=
        static_cast<std::uint32_t>(std::lround(luminance(corners[i].keyed[slot]) / most * 255.0f))
        << (8 * i);
  return out;
}

glm::uvec4 packed_keyed(const Corners& corners) {
  return {packed_from_key(corners, 0), packed_from_key(corners, 1)};
}

}  // namespace

SkyTransfer::Around SkyTransfer::around(IVec3 front, const FaceAxes& axes) const {
  Around out;
  for (std::size_t at = 0; at < 9; ++at) {
    const int i = static_cast<int>(at);
    out.voxels[at] = front + axis_vector(axes.b, i % 3 - 1) + axis_vector(axes.c, i / 3 - 1);
    out.air[at] = wanted_.has(out.voxels[at]);
  }
  return out;
}

/// What a face's corners receive that other faces have reflected.
SkyTransfer::Corners SkyTransfer::bounced(const Around& around, int face, bool plant) const {
  Corners out{};
  if (!bounces_) return out;
  std::array<std::optional<BounceLight::Light>, 9> lights;
  for (std::size_t at = 0; at < lights.size(); ++at)
    if (around.air[at]) lights[at] = bounces_->received(around.voxels[at], face, plant);
  for (std::size_t corner = 0; corner < 4; ++corner) {
    float count = 0.0f;
    BounceLight::Light& sum = out[corner];
    for (const std::size_t at : around.about(corner)) {
      if (!lights[at]) continue;
      sum += *lights[at];
      count += 1.0f;
    }
    if (count > 0.0f) sum *= 1.0f / count;
  }
  return out;
}

SkyTransfer::View SkyTransfer::view_of(IVec3 voxel, int face) {
  if (!openings_.asks(voxel, face)) return {lobes_from(seen_, wanted_.of(voxel), face), {}};
  const std::uint64_t rays = openings_.seen(voxel, face);
  return {OpeningRays::lobes(voxel, face, rays), rays};
}

/// Takes from views what glass takes of the light from there. @return a colour a corner: that of an
/// even sky's light, as seen; where a corner sees no sky, that of the others.
glm::uvec4 SkyTransfer::tint_corners(const Around& around, int face, std::span<View> views) const {
  std::array<Tinted, 9> tinted{};
  Tinted all;
  for (std::size_t at = 0; at < tinted.size(); ++at) {
    if (!around.air[at]) continue;
    const IVec3 voxel = around.voxels[at];
    View& view = views[at];
    tinted[at] = view.rays ? tint_rays(ways_, voxel, face, *view.rays, view.lobes)
                           : tint_lobes(seen_, tints_, wanted_.of(voxel), face, view.lobes);
    all += tinted[at];
  }
  glm::uvec4 out = white_tint();
  for (std::size_t corner = 0; corner < 4 && all.lobes > 0.0f; ++corner) {
    Tinted sum;
    for (const std::size_t at : around.about(corner)) sum += tinted[at];
    if (sum.lobes <= 0.0f) sum = all;
    out[static_cast<int>(corner)] = pack_shared_exponent(sum.light / sum.lobes);
  }
  return out;
}

/// @param front the voxel before the face. @param plant whether it is that of a plant, which does
/// not shade itself as it does the ground below it.
void SkyTransfer::append_record(IVec3 front, int face, bool plant,
                                std::vector<glm::uvec4>& texels) {
  const FaceAxes axes(face);
  const Around around = this->around(front, axes);
  std::array<View, 9> views{};
  std::array<const LampLight*, 9> lamps{};
  std::array<float, 9> lamps_left{};
  bool tinted = false;
  for (std::size_t at = 0; at < 9; ++at) {
    const IVec3 voxel = around.voxels[at];
    if (!around.air[at]) continue;
    const std::size_t index = wanted_.of(voxel);
    lamps[at] = lamp_light_.find(index);
    views[at] = view_of(voxel, face);
    tinted |= views[at].rays ? openings_.passes_glass(voxel, face) : tints_.has(index);
    const bool under_plant = !plant && face == 2 && air_.has_leaves && air_.plants.at(voxel);
    if (under_plant)
      for (std::uint32_t& lobe : views[at].lobes) lobe -= lobe / kPartUnderPlant;
    lamps_left[at] = under_plant ? 1.0f - BounceLight::kUnderPlant : 1.0f;
  }
  glm::uvec4 tint = white_tint();
  if (tinted) tint = tint_corners(around, face, views);
  const Corners bounces = bounced(around, face, plant);
  std::array<std::uint32_t, 8> words{};
  glm::uvec4 lamp_words(0);
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const Around::Some about = around.about(corner);
    const auto count = static_cast<std::uint32_t>(about.count);
    glm::vec3 lamp_sum(0.0f);
    for (const std::size_t at : about)
      if (lamps[at] != nullptr)
        lamp_sum += lamps_left[at] *
                    lamps[at]->at(static_cast<std::size_t>(face), corner_within(at, corner));
    for (std::size_t lobe = 0; lobe < shared::kSkyLobes; ++lobe) {
      std::uint32_t sum = 0;
      for (const std::size_t at : about) sum += views[at].lobes[lobe];
      words[2 * corner + lobe / 4] |= (sum / count + 128) >> 8 << (8 * (lobe % 4));
    }
    lamp_words[static_cast<int>(corner)] =
        pack_shared_exponent(lamp_sum / static_cast<float>(count) + bounces[corner].lamps);
  }
  texels.emplace_back(words[0], words[1], words[2], words[3]);
  texels.emplace_back(words[4], words[5], words[6], words[7]);
  texels.push_back(lamp_words);
  texels.push_back(packed(bounces));
  if (record_parts().keyed) texels.push_back(packed_keyed(bounces));
  if (tints_.any()) texels.push_back(tint);
}

ChunkSky SkyTransfer::faces_of(IVec3 chunk, std::span<const shared::Quad> quads) {
  const IVec3 corner = corner_of(chunk);
  const auto append = [&](const DrawnFace& face, std::vector<glm::uvec4>& texels) {
    append_record(corner + face.voxel + to_front(face), face.direction, face.plant, texels);
  };
  const ChunkSky packed = pack_faces(quads, append, record_parts());
  return packed.parts.tinted ? with_tints(packed) : packed;
}

const SkyTransfer::Skies& SkyTransfer::make_faces() {
  skies_.clear();
  openings_.take_lit();
  for (const auto& [at, chunk] : chunks_)
    if (!chunk->quads.empty())
      skies_.emplace(at, std::make_shared<const ChunkSky>(faces_of(at, chunk->quads)));
  return skies_;
}

const SkyTransfer::Skies& SkyTransfer::take_key(std::size_t slot) {
  for (auto& [at, sky] : skies_) {
    if (!sky->parts.keyed) return make_faces();  // of the first key direction
    auto now = std::make_shared<ChunkSky>(*sky);
    for_each_record(
        *sky, [&, corner = corner_of(at)](IVec3 local, int direction, std::size_t record) {
          const IVec3 voxel = corner + local;
          const bool plant = direction == 2 && air_.has_leaves && air_.plants.at(voxel);
          const IVec3 front = voxel + to_front({local, direction, plant});
          const glm::uvec2 words =
              packed_from_key(bounced(around(front, FaceAxes(direction)), direction, plant), slot);
          glm::uvec4& keyed = now->texels[record + shared::kIndirectRecordTexels];
          keyed[static_cast<int>(2 * slot)] = words.x;
          keyed[static_cast<int>(2 * slot + 1)] = words.y;
        });
    sky = std::move(now);
  }
  return skies_;
}

}  // namespace skerry::world
