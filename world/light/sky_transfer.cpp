#include "world/light/sky_transfer.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include "engine/core/check.h"
#include "world/voxel/chunk.h"

namespace skerry::world {

/// A row of voxels of which a line passes the one at z + by.
struct SkyTransfer::PassedRow {
  const std::uint64_t* words = nullptr;
  int by = 0;  ///< -4 to 4
};

namespace {

// Share of a strong lamp's range, whose end is where its light is the least that counts, within
// which surfaces reflect it: beyond, it is less than four times as much.
constexpr float kBouncedShare = 0.5f;

// Beyond a quarter more, numbers of voxels that edits may make before all is begun anew.
constexpr std::size_t kSpareNumbers = 65536;

/// Which voxels rays pass: air, and some of the leaves and plants.
VoxelBits open_to(const AirVolume& air, int leaf_set) {
  const IVec3 low = air.opaque.low(), size = air.opaque.size();
  VoxelBits open(low, size, true);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      std::uint64_t* row = open.row(x, y);
      const std::uint64_t* opaque = air.opaque.row(x, y);
      for (int w = 0; w < open.row_words(); ++w) row[w] = ~opaque[w];
      if (!air.has_leaves) continue;
      const std::uint64_t *leaves = air.leaves.row(x, y), *plants = air.plants.row(x, y);
      for (int w = 0; w < open.row_words(); ++w) {
        const int z = low.z / 64 + w;
        if (leaves[w] != 0)
          row[w] &= ~(leaves[w] & leaves_that_stop(leaf_set, low.x + x, low.y + y, z));
        if (plants[w] != 0)
          row[w] &= ~(plants[w] & plants_that_stop(leaf_set, low.x + x, low.y + y, z));
      }
    }
  }
  return open;
}

/// Bit z: whether all rows pass a line there. The number of words is known to the compiler: most
/// rows have few, which then stay in registers. @param rows `by` is 0 or more of all, or 0 or less.
template <bool forward, std::size_t kWords, class Row>
std::array<std::uint64_t, kWords> passed_by_all(std::span<const Row> rows, std::size_t word) {
  std::array<std::uint64_t, kWords> out;
  out.fill(~std::uint64_t{0});
  for (const Row& row : rows) {
    const std::uint64_t* words = row.words + word;
    if (row.by == 0) {
      for (std::size_t i = 0; i < kWords; ++i) out[i] &= words[i];
    } else if (forward) {
      for (std::size_t i = 0; i < kWords; ++i)
        out[i] &= words[i] >> row.by | words[i + 1] << (64 - row.by);
    } else {
      for (std::size_t i = 0; i < kWords; ++i)
        out[i] &= words[i] << -row.by | (words + i)[-1] >> (64 + row.by);
    }
  }
  return out;
}

}  // namespace

SkyTransfer::SkyTransfer(LightChunks chunks, std::span<const FaceAlbedo> albedo, int bounces,
                         int spare, const KeyDirections& keys)
    : chunks_(std::move(chunks)),
      air_(air_volume_of(chunks_, 2 + spare)),
      lines_(air_),
      tints_(air_, lines_, wanted_),
      ways_(air_, lines_),
      openings_(air_, ways_, wanted_, seen_) {
  const IVec3 low = air_.opaque.low(), size = air_.opaque.size();
  if (size.x == 0) return;
  VoxelBits wanted(low, size, false);
  const auto want = [&](IVec3 voxel) {
    if (!air_.opaque.at(voxel)) wanted.set(voxel);
  };
  for (const auto& [at, chunk] : chunks_) {
    const IVec3 corner = corner_of(at);
    for (const shared::Quad& quad : chunk->quads)
      for_each_face(quad, [&](const DrawnFace& face) {
        const FaceAxes axes(face.direction);
        const IVec3 front = corner + face.voxel + to_front(face);
        for (int b = -1; b <= 1; ++b)
          for (int c = -1; c <= 1; ++c)
            want(front + axis_vector(axes.b, b) + axis_vector(axes.c, c));
      });
  }
  wanted_ = VoxelIndex(std::move(wanted));
  most_numbers_ = wanted_.size() + wanted_.size() / 4 + kSpareNumbers;
  seen_ = SeenSky(wanted_.size());
  if (!albedo.empty())
    bounces_.emplace(chunks_, air_, lines_, ways_, wanted_, tints_, albedo, bounces, keys);
}

void SkyTransfer::look(int octant) {
  if (seen_.empty()) return;
  VoxelBits passed(air_.opaque.low(), air_.opaque.size(), true);
  const int sets = air_.has_leaves ? kLeafSets : 1;
  for (int set = 0; set < sets; ++set) {
    const VoxelBits open = open_to(air_, set);
    for (int axis = 0; axis < 3; ++axis)
      for (int pattern = set; pattern < static_cast<int>(shared::kSkyPatternCount); pattern += sets)
        look_along(fan_of(axis, octant), pattern, open, passed);
  }
  for (int axis = 0; axis < 3; ++axis) tints_.look(fan_of(axis, octant));
}

// From the far end of the box on: what a voxel sees is what the voxel one vector further lets past,
// if the line between them is clear. Rows at a time, 64 voxels a word. @param passed working
// memory.
void SkyTransfer::look_along(std::size_t fan, int pattern, const VoxelBits& open,
                             VoxelBits& passed) {
  const IVec3 d = sky_direction(octant_of(fan), pattern);
  const std::vector<LineVoxel> voxels = line_voxels(d, axis_of(fan));
  const auto look = [&](std::span<const PassedRow> rows, int x, int y) {
    if (d.z > 0) {
      look_from_row<true>(fan, pattern, x, y, rows, open, passed);
    } else {
      look_from_row<false>(fan, pattern, x, y, rows, open, passed);
    }
  };
  constexpr int kLongest = 4;  // component of a vector
  const IVec3 size = open.size();
  std::vector<PassedRow> rows(voxels.size());
  for (int i = 0; i < size.y; ++i) {
    const int y = d.y > 0 ? size.y - 1 - i : i;
    const bool y_within = y >= kLongest && y < size.y - kLongest;
    bool ready = false;  // rows are those of the row before this one
    for (int x = 0; x < size.x; ++x) {
      if (y_within && x >= kLongest && x < size.x - kLongest && ready) {
        for (PassedRow& row : rows) row.words += open.row_step();
        look(rows, x, y);
        continue;
      }
      std::size_t count = 0;
      for (const LineVoxel& voxel : voxels) {
        const IVec3& o = voxel.offset;
        const VoxelBits& of = &voxel == &voxels.back() ? passed : open;
        if (of.has_row(x + o.x, y + o.y)) rows[count++] = {of.row(x + o.x, y + o.y), o.z};
      }
      ready = count == rows.size();
      look(std::span(rows).first(count), x, y);
    }
  }
}

template <bool forward>
void SkyTransfer::look_from_row(std::size_t fan, int pattern, int x, int y,
                                std::span<const PassedRow> rows, const VoxelBits& open,
                                VoxelBits& passed) {
  std::uint64_t* row = passed.row(x, y);
  const std::uint64_t* clear = open.row(x, y);
  const std::uint64_t* wanted = wanted_.chosen().row(x, y);
  const std::uint32_t* first = wanted_.row(x, y);
  const auto look = [&]<std::size_t kWords>(std::size_t from) {
    const auto sky = passed_by_all<forward, kWords>(rows, from);
    for (std::size_t i = 0; i < kWords; ++i) {
      const std::size_t w = from + i;
      row[w] = sky[i] & clear[w];
      if ((sky[i] & wanted[w]) == 0) continue;
      std::size_t at = first[w];
      for (std::uint64_t left = wanted[w]; left != 0; left &= left - 1, ++at)
        seen_.of(at, fan) |=
            static_cast<std::uint16_t>((sky[i] >> std::countr_zero(left) & 1) << pattern);
    }
  };
  const auto words = static_cast<std::size_t>(open.row_words());
  std::size_t w = 0;
  for (; w + 4 <= words; w += 4) look.template operator()<4>(w);
  if (words - w == 3) look.template operator()<3>(w);
  if (words - w == 2) look.template operator()<2>(w);
  if (words - w == 1) look.template operator()<1>(w);
}

std::vector<SkyTransfer::Lamp> SkyTransfer::lamps_of(const LightChunk& chunk, IVec3 at) {
  const IVec3 corner = corner_of(at);
  const glm::vec3 from(static_cast<float>(corner.x), static_cast<float>(corner.y),
                       static_cast<float>(corner.z));
  std::vector<Lamp> out;
  for (const WeakLamp& lamp : chunk.lamps)
    out.push_back({{lamp.place + from, lamp.intensity, lamp.range}, lamp.range, true});
  for (const StrongLamp& lamp : chunk.strong)
    out.push_back(
        {{lamp.place + from, lamp.intensity, lamp.range}, lamp.range * kBouncedShare, false});
  return out;
}

// In the order of chunks and their lamps: sums of floats depend on it.
void SkyTransfer::spread_lamps() {
  if (seen_.empty()) return;
  for (const auto& [at, chunk] : chunks_)
    for (const Lamp& lamp : lamps_of(*chunk, at))
      if (lamp.weak || bounces_) spread(lamp, lamp.weak ? lamp_light_ : all_lamps_);
  if (!bounces_) return;
  lamp_light_.for_each(
      [&](std::size_t number, const LampLight& light) { all_lamps_.add(number, light); });
}

void SkyTransfer::spread(const Lamp& lamp, LampLightMap& into) const {
  for_each_reached(lamp, [&](IVec3 at) {
    const LampLight light = light_of_lamp(air_, lamp.lamp, at);
    if (!is_dark(light)) into.add(wanted_.of(at), light);
  });
}

std::size_t SkyTransfer::bytes() const {
  return seen_.bytes() + ways_.bytes() + openings_.bytes() + lamp_light_.bytes() +
         all_lamps_.bytes() + tints_.bytes() + (bounces_ ? bounces_->bytes() : 0);
}

void SkyTransfer::follow_bounces(int step, int part) {
  if (bounces_ && !seen_.empty()) bounces_->follow(step, part, seen_, all_lamps_);
}

void SkyTransfer::set_key(std::size_t slot, const glm::vec3& to_body) {
  bounces_->set_key(slot, to_body);
}

void SkyTransfer::follow_key(std::size_t slot, int step, int part) {
  bounces_->follow_key(slot, step, part);
}

}  // namespace skerry::world
