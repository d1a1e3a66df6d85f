#include "world/light/sky_transfer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "engine/core/check.h"
#include "world/voxel/chunk.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr int kLeafSets = 8;  // leaves stop different rays by different sets of voxels

/// Which voxels rays pass: air, and half of the leaves.
VoxelBits open_to(const AirVolume& air, int leaf_set) {
  const IVec3 low = air.opaque.low(), size = air.opaque.size();
  VoxelBits open(low, size, true);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      std::uint64_t* row = open.row(x, y);
      const std::uint64_t* opaque = air.opaque.row(x, y);
      const std::uint64_t* leaves = air.has_leaves ? air.leaves.row(x, y) : nullptr;
      for (int w = 0; w < open.row_words(); ++w) {
        row[w] = ~opaque[w];
        if (!leaves || leaves[w] == 0) continue;
        const std::uint64_t place =
            hash3(static_cast<std::uint32_t>(leaf_set), low.x + x, low.y + y, low.z / 64 + w);
        row[w] &= ~(leaves[w] & mix64(place + 0x9e3779b97f4a7c15u));
      }
    }
  }
  return open;
}

/// A row, moved so that bit z has what stood at z + by.
inline void and_row(std::uint64_t* into, const std::uint64_t* row, int by, int words) {
  if (by == 0) {
    for (int w = 0; w < words; ++w) into[w] &= row[w];
  } else if (by > 0) {
    for (int w = 0; w < words; ++w) into[w] &= row[w] >> by | row[w + 1] << (64 - by);
  } else {
    for (int w = 0; w < words; ++w) into[w] &= row[w] << -by | row[w - 1] >> (64 + by);
  }
}

}  // namespace

SkyTransfer::SkyTransfer(const LightChunks& chunks) : chunks_(chunks), air_(air_volume_of(chunks)) {
  const IVec3 low = air_.opaque.low(), size = air_.opaque.size();
  if (size.x == 0) return;
  wanted_ = VoxelBits(low, size, false);
  for (const auto& [at, chunk] : chunks_) {
    const IVec3 corner = corner_of(at);
    for (const shared::Quad& quad : chunk->quads)
      for_each_face(quad, [&](const DrawnFace& face) {
        const FaceAxes axes(face.direction);
        IVec3 front = corner + face.voxel;
        if (!face.plant) front = front + axis_vector(axes.own, axes.sign);
        for (int b = -1; b <= 1; ++b)
          for (int c = -1; c <= 1; ++c)
            want(front + axis_vector(axes.b, b) + axis_vector(axes.c, c));
      });
  }
  std::uint32_t count = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int w = 0; w < wanted_.row_words(); ++w) {
        ranks_.push_back(count);
        count += static_cast<std::uint32_t>(std::popcount(wanted_.row(x, y)[w]));
      }
  seen_.assign(count, Seen{});
}

void SkyTransfer::want(IVec3 voxel) {
  if (!air_.opaque.at(voxel)) wanted_.set(voxel);
}

std::size_t SkyTransfer::index_of(IVec3 voxel) const {
  const IVec3 p{voxel.x - wanted_.low().x, voxel.y - wanted_.low().y, voxel.z - wanted_.low().z};
  const int words = wanted_.row_words();
  const auto word = static_cast<std::size_t>((p.y * wanted_.size().x + p.x) * words + p.z / 64);
  const std::uint64_t before =
      wanted_.row(p.x, p.y)[p.z / 64] & ((std::uint64_t{1} << p.z % 64) - 1);
  return ranks_[word] + static_cast<std::size_t>(std::popcount(before));
}

void SkyTransfer::look(int octant) {
  if (seen_.empty()) return;
  VoxelBits passed(air_.opaque.low(), air_.opaque.size(), true);
  const int sets = air_.has_leaves ? kLeafSets : 1;
  for (int set = 0; set < sets; ++set) {
    const VoxelBits open = open_to(air_, set);
    for (int pattern = set; pattern < static_cast<int>(shared::kSkyPatternCount); pattern += sets)
      look_along(octant, pattern, open, passed);
  }
}

// From the far end of the box on: what a voxel sees is what the voxel one vector further lets past,
// if the line between them is clear. Rows at a time, 64 voxels a word. @param passed working
// memory.
void SkyTransfer::look_along(int octant, int pattern, const VoxelBits& open, VoxelBits& passed) {
  const IVec3 d = sky_direction(octant, pattern);
  const std::vector<IVec3> between = voxels_between(d);
  const IVec3 size = open.size();
  const int words = open.row_words();
  std::vector<std::uint64_t> sees(static_cast<std::size_t>(words));
  const auto bit = static_cast<std::uint16_t>(1u << pattern);
  for (int i = 0; i < size.y; ++i) {
    const int y = d.y > 0 ? size.y - 1 - i : i;
    for (int x = 0; x < size.x; ++x) {
      std::fill(sees.begin(), sees.end(), ~std::uint64_t{0});
      if (open.has_row(x + d.x, y + d.y))
        and_row(sees.data(), passed.row(x + d.x, y + d.y), d.z, words);
      for (const IVec3& o : between)
        if (open.has_row(x + o.x, y + o.y))
          and_row(sees.data(), open.row(x + o.x, y + o.y), o.z, words);
      std::uint64_t* row = passed.row(x, y);
      const std::uint64_t* clear = open.row(x, y);
      const std::uint64_t* wanted = wanted_.row(x, y);
      const std::uint32_t* rank = &ranks_[static_cast<std::size_t>((y * size.x + x) * words)];
      for (int w = 0; w < words; ++w) {
        const std::uint64_t sky = sees[static_cast<std::size_t>(w)];
        row[w] = sky & clear[w];
        if ((sky & wanted[w]) == 0) continue;
        std::size_t at = rank[w];
        for (std::uint64_t left = wanted[w]; left != 0; left &= left - 1, ++at)
          if (sky >> std::countr_zero(left) & 1) seen_[at][static_cast<std::size_t>(octant)] |= bit;
      }
    }
  }
}

// In the order of chunks and their lamps: sums of floats depend on it.
void SkyTransfer::spread_lamps() {
  if (seen_.empty()) return;
  for (const auto& [at, chunk] : chunks_) {
    const IVec3 corner = corner_of(at);
    for (WeakLamp lamp : chunk->lamps) {
      lamp.place += glm::vec3(static_cast<float>(corner.x), static_cast<float>(corner.y),
                              static_cast<float>(corner.z));
      spread(lamp);
    }
  }
}

/// @param lamp place from the lattice's origin.
void SkyTransfer::spread(const WeakLamp& lamp) {
  const auto voxel = [](float v) { return static_cast<int>(std::floor(v)); };
  const glm::vec3 low = lamp.place - lamp.range, high = lamp.place + lamp.range;
  for (int y = voxel(low.y); y <= voxel(high.y); ++y)
    for (int x = voxel(low.x); x <= voxel(high.x); ++x)
      for (int z = voxel(low.z); z <= voxel(high.z); ++z) {
        const IVec3 at{x, y, z};
        if (!wanted_.at(at)) continue;
        const LampLight light = light_of_lamp(air_, lamp, at);
        if (std::ranges::all_of(light, [](const glm::vec3& l) { return l == glm::vec3(0.0f); }))
          continue;
        LampLight& sum = lamp_light_[index_of(at)];
        for (std::size_t face = 0; face < 6; ++face) sum[face] += light[face];
      }
}

namespace {

/// What a face's lobes see, of 65280, and its lamps' light, summed over voxels.
struct LobeSums {
  std::array<std::uint32_t, shared::kSkyLobes> sum{};
  std::uint32_t voxels = 0;
  glm::vec3 lamps{0.0f};
  std::uint32_t byte(std::size_t lobe) const { return (sum[lobe] / voxels + 128) >> 8; }
};

}  // namespace

/// @param front the voxel before the face.
void SkyTransfer::append_record(IVec3 front, int face, std::vector<glm::uvec4>& texels) const {
  const FaceAxes axes(face);
  std::array<std::array<std::uint32_t, shared::kSkyLobes>, 9> views{};
  std::array<bool, 9> air{};
  std::array<glm::vec3, 9> lamps{};
  for (int i = 0; i < 9; ++i) {
    const IVec3 voxel = front + axis_vector(axes.b, i % 3 - 1) + axis_vector(axes.c, i / 3 - 1);
    const auto at = static_cast<std::size_t>(i);
    air[at] = wanted_.at(voxel);
    if (!air[at]) continue;
    const std::size_t index = index_of(voxel);
    if (const auto lit = lamp_light_.find(index); lit != lamp_light_.end())
      lamps[at] = lit->second[static_cast<std::size_t>(face)];
    const Seen& seen = seen_[index];
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int octant = (axes.sign < 0 ? 1 << axes.own : 0) | (quarter & 1 ? 1 << axes.b : 0) |
                         (quarter & 2 ? 1 << axes.c : 0);
      const std::array<std::uint32_t, 2> lobes =
          lobes_seen(axes.own, seen[static_cast<std::size_t>(octant)]);
      views[at][static_cast<std::size_t>(2 * quarter)] = lobes[0];
      views[at][static_cast<std::size_t>(2 * quarter + 1)] = lobes[1];
    }
  }
  std::array<std::uint32_t, 8> words{};
  glm::uvec4 lamp_words(0);
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const std::size_t across = corner & 1 ? 5 : 3, along = corner & 2 ? 7 : 1;
    const std::array<std::size_t, 4> about{4, across, along, across + along - 4};
    LobeSums sums;
    for (std::size_t i = 0; i < 4; ++i) {
      if (i != 0 && !air[about[i]]) continue;
      if (i == 3 && !air[across] && !air[along]) continue;
      ++sums.voxels;
      sums.lamps += lamps[about[i]];
      for (std::size_t lobe = 0; lobe < shared::kSkyLobes; ++lobe)
        sums.sum[lobe] += views[about[i]][lobe];
    }
    for (std::size_t lobe = 0; lobe < shared::kSkyLobes; ++lobe)
      words[2 * corner + lobe / 4] |= sums.byte(lobe) << (8 * (lobe % 4));
    lamp_words[static_cast<int>(corner)] =
        glm::packF3x9_E1x5(sums.lamps / static_cast<float>(sums.voxels));
  }
  texels.emplace_back(words[0], words[1], words[2], words[3]);
  texels.emplace_back(words[4], words[5], words[6], words[7]);
  texels.push_back(lamp_words);
}

ChunkSky SkyTransfer::faces_of(IVec3 chunk, std::span<const shared::Quad> quads) const {
  const IVec3 corner = corner_of(chunk);
  return pack_faces(quads, [&](const DrawnFace& face, std::vector<glm::uvec4>& texels) {
    const FaceAxes axes(face.direction);
    const IVec3 front = face.plant ? IVec3{} : axis_vector(axes.own, axes.sign);
    append_record(corner + face.voxel + front, face.direction, texels);
  });
}

std::map<IVec3, ChunkSky> SkyTransfer::faces() const {
  std::map<IVec3, ChunkSky> out;
  for (const auto& [at, chunk] : chunks_)
    if (!chunk->quads.empty()) out.emplace(at, faces_of(at, chunk->quads));
  return out;
}

}  // namespace skerry::world
