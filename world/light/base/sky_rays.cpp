#include "world/light/base/sky_rays.h"

#include <algorithm>
#include <cmath>

#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr std::uint32_t kAll = 65280;  // 255 * 256

/// Cosine-weighted share of a pattern's cell in its octant, of kAll: by its own component along the
/// axis and the other two in order. Integrals over the sphere, 9 million points; a test repeats
/// them.
double cell_share(int along, int least, int most) {
  struct Row {
    std::array<int, 3> key;
    double share;
  };
  static constexpr std::array<Row, 10> kRows{{{{1, 1, 1}, 3766.1},
                                              {{1, 1, 2}, 2160.1},
                                              {{2, 1, 1}, 4033.0},
                                              {{1, 2, 2}, 2530.8},
                                              {{2, 1, 2}, 6556.7},
                                              {{1, 1, 4}, 1652.4},
                                              {{4, 1, 1}, 9347.0},
                                              {{1, 2, 4}, 1216.7},
                                              {{2, 1, 4}, 4031.6},
                                              {{4, 1, 2}, 7183.9}}};
  for (const Row& row : kRows)
    if (row.key == std::array{along, least, most}) return row.share;
  return 0.0;
}

LobeWeights make_weights(int axis) {
  LobeWeights out{};
  for (std::size_t k = 0; k < out.size(); ++k) {
    const glm::ivec3 p = shared::kSkyPatterns[k];
    const int along = p[axis], b = p[(axis + 1) % 3], c = p[(axis + 2) % 3];
    out[k] =
        static_cast<std::uint32_t>(std::lround(cell_share(along, std::min(b, c), std::max(b, c))));
  }
  return out;
}

/// For each byte of an octant's bits, the sums of the lobes that it is part of, from the first on.
struct SeenTable {
  static constexpr std::size_t kMost = 3;  // lobes
  std::array<std::array<std::array<std::uint32_t, kMost>, 256>, 2> sums{};
  std::size_t first = shared::kSkyLobes;
};

SeenTable make_table(int axis, int octant) {
  const LobeWeights& weights = lobe_weights(axis);
  SeenTable table;
  for (std::size_t k = 0; k < weights.size(); ++k)
    table.first = std::min(table.first, lobe_of(axis, octant, k));
  const auto place = [&](std::size_t k) { return lobe_of(axis, octant, k) - table.first; };
  std::array<double, SeenTable::kMost> whole{};
  for (std::size_t k = 0; k < weights.size(); ++k) whole[place(k)] += weights[k];
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t bits = 0; bits < 256; ++bits) {
      std::array<double, SeenTable::kMost> sum{};
      for (std::size_t i = 0; i < 8; ++i)
        if (bits >> i & 1u) sum[place(half * 8 + i)] += weights[half * 8 + i];
      for (std::size_t lobe = 0; lobe < sum.size(); ++lobe)
        if (whole[lobe] > 0.0)
          table.sums[half][bits][lobe] =
              static_cast<std::uint32_t>(std::lround(kAll * sum[lobe] / whole[lobe]));
    }
  }
  return table;
}

std::vector<SeenTable> make_tables() {
  std::vector<SeenTable> out;
  for (int axis = 0; axis < 3; ++axis)
    for (int octant = 0; octant < kOctants; ++octant) out.push_back(make_table(axis, octant));
  return out;
}

}  // namespace

IVec3 sky_direction(int octant, int pattern) {
  const glm::ivec3 p = shared::kSkyPatterns[pattern];
  return {octant & 1 ? -p.x : p.x, octant & 2 ? -p.y : p.y, octant & 4 ? -p.z : p.z};
}

std::vector<LineVoxel> line_voxels(IVec3 direction, int face_axis) {
  const std::array<int, 3> d{direction.x, direction.y, direction.z};
  const std::array<int, 3> n{std::abs(d[0]), std::abs(d[1]), std::abs(d[2])};
  const bool by_turns = (n[0] + n[1] + n[2]) % 2 == 0;
  const auto crosses_first = [&](std::size_t a, std::size_t b) {  // a < b
    return ((d[a] > 0) == (d[3 - a - b] > 0)) != by_turns;
  };
  struct Crossing {
    int at = 0;
    std::size_t axis = 0;
  };
  std::vector<Crossing> crossings;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int i = 0; i < n[axis]; ++i) {
      const int halves = static_cast<int>(axis) == face_axis ? 2 * i + 2 : 2 * i + 1;
      crossings.push_back({halves * 4 / n[axis], axis});
    }
  std::ranges::sort(crossings, [&](const Crossing& one, const Crossing& other) {
    if (one.at != other.at || one.axis == other.axis) return one.at < other.at;
    return one.axis < other.axis ? crosses_first(one.axis, other.axis)
                                 : !crosses_first(other.axis, one.axis);
  });
  std::vector<LineVoxel> out;
  std::array<int, 3> offset{};
  for (const Crossing& crossing : crossings) {
    offset[crossing.axis] += d[crossing.axis] > 0 ? 1 : -1;
    out.push_back(
        {{offset[0], offset[1], offset[2]}, static_cast<int>(crossing.axis), crossing.at});
  }
  return out;
}

std::array<std::size_t, 4> fans_of_face(int face) {
  const int axis = face / 2, first = (axis + 1) % 3, second = (axis + 2) % 3;
  const int behind = face % 2 << axis;  // faces of odd directions look along -axis
  return {fan_of(axis, behind), fan_of(axis, behind | 1 << first),
          fan_of(axis, behind | 1 << second), fan_of(axis, behind | 1 << first | 1 << second)};
}

std::uint64_t leaves_that_stop(int leaf_set, int x, int y, int z_word) {
  const std::uint64_t place = hash3(static_cast<std::uint32_t>(leaf_set), x, y, z_word);
  return mix64(place + 0x9e3779b97f4a7c15u);
}

std::uint64_t plants_that_stop(int leaf_set, int x, int y, int z_word) {
  return leaves_that_stop(leaf_set, x, y, z_word) &
         leaves_that_stop(leaf_set + kLeafSets, x, y, z_word);
}

const LobeWeights& lobe_weights(int axis) {
  static const std::array<LobeWeights, 3> kWeights{make_weights(0), make_weights(1),
                                                   make_weights(2)};
  return kWeights[static_cast<std::size_t>(axis)];
}

std::size_t lobe_of(int axis, int octant, std::size_t pattern) {
  const glm::vec3 p(shared::kSkyPatterns[pattern]);
  const float sine = p.y / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
  return shared::sky_lobe(static_cast<std::uint32_t>(axis), static_cast<std::uint32_t>(octant),
                          sine);
}

void add_lobes_seen(int axis, int octant, std::uint32_t seen,
                    std::array<std::uint32_t, shared::kSkyLobes>& sum) {
  static const std::vector<SeenTable> kTables = make_tables();
  const SeenTable& table = kTables[static_cast<std::size_t>(axis * kOctants + octant)];
  const auto &low = table.sums[0][seen & 255u], &high = table.sums[1][seen >> 8 & 255u];
  for (std::size_t i = 0; i < SeenTable::kMost && table.first + i < sum.size(); ++i)
    sum[table.first + i] = std::min(kAll, sum[table.first + i] + low[i] + high[i]);
}

}  // namespace skerry::world
