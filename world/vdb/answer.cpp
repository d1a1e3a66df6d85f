#include "world/vdb/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/matrix.hpp>
#include <map>
#include <optional>
#include <type_traits>

namespace skerry::world {
namespace {

constexpr std::uint64_t kMagic = 0x334c4f564b53ull;  // "SKVOL3"
enum Status : std::uint32_t { kGrids = 0, kRefused = 1 };

// Volumes that a few values stretch over more than this are no use to anyone and only overflow.
constexpr double kMaxMatrixElement = 1e15;
// Below this share of the volume that its axes' lengths could span, a voxel is flat.
constexpr double kMinVolumeShare = 1e-3;

template <class T>
bool put(const ByteSink& sink, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  return sink(std::as_bytes(std::span(&value, 1)));
}

bool put_text(const ByteSink& sink, std::string_view text) {
  text = text.substr(0, kMostAnswerText);
  return put(sink, static_cast<std::uint32_t>(text.size())) &&
         sink(std::as_bytes(std::span(text.data(), text.size())));
}

template <class T>
bool put_array(const ByteSink& sink, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return put(sink, std::uint64_t{values.size()}) && sink(std::as_bytes(std::span(values)));
}

/// Takes values off the front; fails once and for good when there are too few bytes.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  bool take(T& value) {
    if (bytes_.size() < sizeof(T)) return false;
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return true;
  }

  bool take_text(std::string& text) {
    std::uint32_t size = 0;
    if (!take(size) || size > kMostAnswerText || size > bytes_.size()) return false;
    text = printable({reinterpret_cast<const char*>(bytes_.data()), size});
    bytes_ = bytes_.subspan(size);
    return true;
  }

  template <class T>
  bool take_array(std::vector<T>& values) {
    std::uint64_t count = 0;
    if (!take(count) || count > bytes_.size() / sizeof(T)) return false;
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), bytes_.data(), count * sizeof(T));
    bytes_ = bytes_.subspan(count * sizeof(T));
    return true;
  }

  bool empty() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

struct Problem {
  std::string text;
};

bool take_grid(Reader& in, VolumeGrid& grid) {
  return in.take_text(grid.name) && in.take_text(grid.value_type) &&
         in.take_text(grid.grid_class) && in.take(grid.kind) && in.take_text(grid.remark) &&
         in.take(grid.world_from_index) && in.take(grid.background) &&
         in.take(grid.active_voxels) && in.take(grid.active_tiles) && in.take(grid.leaves) &&
         in.take(grid.memory_bytes) && in.take(grid.stated_memory_bytes) &&
         in.take(grid.replaced_values) && in.take(grid.active_box) && in.take_array(grid.tiles) &&
         in.take_array(grid.bricks);
}

bool fits(IVec3 at, std::int32_t edge) {
  const auto axis = [edge](std::int32_t v) {
    return v >= -kMaxVolumeIndex && v <= kMaxVolumeIndex - edge && floor_mod(v, edge) == 0;
  };
  return axis(at.x) && axis(at.y) && axis(at.z);
}

IVec3 snapped(IVec3 at, std::int32_t edge) {
  const auto axis = [edge](std::int32_t v) {
    return v - static_cast<std::int32_t>(floor_mod(v, edge));
  };
  return {axis(at.x), axis(at.y), axis(at.z)};
}

std::optional<Problem> check_matrix(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!(std::abs(m[column][row]) <= kMaxMatrixElement))
        return Problem{"its transform holds values that are no numbers or beyond 1e15"};
    }
    if (m[column][3] != (column == 3 ? 1.0 : 0.0)) return Problem{"its transform is not affine"};
  }
  double spanned = 1.0;
  for (int column = 0; column < 3; ++column) spanned *= glm::length(glm::dvec3(m[column]));
  const double volume = std::abs(glm::determinant(glm::dmat3(m)));
  if (!(spanned > 0.0) || !(volume >= kMinVolumeShare * spanned))
    return Problem{"its transform is singular: the voxels are flat"};
  return std::nullopt;
}

std::optional<Problem> check_tiles(const std::vector<VolumeTile>& tiles) {
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const VolumeTile& tile = tiles[i];
    const bool edge_fits =
        tile.edge >= kBrickEdge && tile.edge <= kMaxTileEdge && (tile.edge & (tile.edge - 1)) == 0;
    if (!edge_fits || !fits(tile.origin, tile.edge)) return Problem{"a tile is out of place"};
    if (!std::isfinite(tile.value)) return Problem{"a tile is not finite"};
    if (i > 0 && !(tiles[i - 1].origin < tile.origin)) return Problem{"tiles are out of order"};
  }
  return std::nullopt;
}

std::optional<Problem> check_bricks(const std::vector<VolumeBrick>& bricks) {
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    const VolumeBrick& brick = bricks[i];
    if (!fits(brick.origin, kBrickEdge)) return Problem{"a brick is out of place"};
    if (i > 0 && !(bricks[i - 1].origin < brick.origin)) return Problem{"bricks are out of order"};
    if (!std::all_of(brick.values.begin(), brick.values.end(),
                     [](float v) { return std::isfinite(v); }))
      return Problem{"a brick is not finite"};
  }
  return std::nullopt;
}

/// Whether every value is a packed colour; what reads them takes them for integers.
std::optional<Problem> check_colors(const VolumeGrid& grid) {
  const auto fits = [](float v) { return v >= 0.0f && v <= static_cast<float>(0xffffff); };
  const auto tile_fits = [&](const VolumeTile& tile) { return fits(tile.value); };
  const auto brick_fits = [&](const VolumeBrick& brick) {
    return std::all_of(brick.values.begin(), brick.values.end(), fits);
  };
  if (fits(grid.background) && std::all_of(grid.tiles.begin(), grid.tiles.end(), tile_fits) &&
      std::all_of(grid.bricks.begin(), grid.bricks.end(), brick_fits))
    return std::nullopt;
  return Problem{"a colour is none"};
}

/// Whether something lies in a larger tile. Tiles of one edge share no origin, so that they cannot
/// overlap each other.
std::optional<Problem> check_overlap(const VolumeGrid& grid) {
  std::map<std::int32_t, std::vector<IVec3>> by_edge;  // each sorted, as the tiles are
  for (const VolumeTile& tile : grid.tiles) by_edge[tile.edge].push_back(tile.origin);
  for (const auto& [edge, origins] : by_edge) {
    const auto covered = [edge = edge, &origins = origins](IVec3 at, std::int32_t own) {
      return own < edge && std::binary_search(origins.begin(), origins.end(), snapped(at, edge));
    };
    const auto tile_covered = [&](const VolumeTile& t) { return covered(t.origin, t.edge); };
    // Even a tile of a brick's own size covers it.
    const auto brick_covered = [&](const VolumeBrick& b) { return covered(b.origin, 0); };
    if (std::any_of(grid.tiles.begin(), grid.tiles.end(), tile_covered) ||
        std::any_of(grid.bricks.begin(), grid.bricks.end(), brick_covered))
      return Problem{"bricks and tiles overlap"};
  }
  return std::nullopt;
}

std::optional<Problem> check_description(const VolumeGrid& grid) {
  if (grid.kind > VolumeKind::kOther) return Problem{"it is of no known kind"};
  if (!std::isfinite(grid.background)) return Problem{"its background is not finite"};
  const bool other = grid.kind == VolumeKind::kOther;
  if (other != !grid.remark.empty()) return Problem{"its remark does not fit its kind"};
  if (other && !(grid.bricks.empty() && grid.tiles.empty()))
    return Problem{"it holds values that it should not hold"};
  if (grid.active_voxels == 0) return std::nullopt;
  const VolumeBox& box = grid.active_box;
  if (box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z)
    return Problem{"its box of active voxels is empty"};
  if (!other && !within_reach(box)) return Problem{"its box of active voxels is beyond 2^30"};
  return std::nullopt;
}

std::optional<Problem> check_grid(const VolumeGrid& grid) {
  if (auto problem = check_description(grid)) return problem;
  if (grid.kind == VolumeKind::kOther) return std::nullopt;
  if (auto problem = check_matrix(grid.world_from_index)) return problem;
  if (auto problem = check_tiles(grid.tiles)) return problem;
  if (auto problem = check_bricks(grid.bricks)) return problem;
  if (grid.kind == VolumeKind::kColor)
    if (auto problem = check_colors(grid)) return problem;
  return check_overlap(grid);
}

/// Least, largest and mean value; the mean in double and in the order of the file.
void find_statistics(VolumeGrid& grid) {
  grid.min_value = grid.max_value = grid.background;
  double sum = 0.0, count = 0.0;
  const auto add = [&](float value, double times) {
    if (value == grid.background) return;
    grid.min_value = std::min(grid.min_value, value);
    grid.max_value = std::max(grid.max_value, value);
    sum += static_cast<double>(value) * times;
    count += times;
  };
  for (const VolumeTile& tile : grid.tiles) {
    const double edge = tile.edge;
    add(tile.value, edge * edge * edge);
  }
  for (const VolumeBrick& brick : grid.bricks)
    for (const float value : brick.values) add(value, 1.0);
  grid.mean_value = count > 0.0 ? static_cast<float>(sum / count) : grid.background;
}

void make_names_unique(std::vector<VolumeGrid>& grids) {
  std::map<std::string, int> count, next;
  for (const VolumeGrid& grid : grids) ++count[grid.name];
  for (VolumeGrid& grid : grids) {
    const std::string name = grid.name;
    if (count[name] > 1) grid.name += fmt::format("[{}]", next[name]++);
  }
}

}  // namespace

bool within_reach(const VolumeBox& box) {
  const auto axis = [](std::int32_t low, std::int32_t high) {
    return low >= -kMaxVolumeIndex && high < kMaxVolumeIndex;
  };
  return axis(box.min.x, box.max.x) && axis(box.min.y, box.max.y) && axis(box.min.z, box.max.z);
}

bool begin_answer(std::uint32_t grids, const ByteSink& sink) {
  return put(sink, kMagic) && put(sink, kGrids) && put(sink, grids);
}

bool encode_grid(const VolumeGrid& grid, const ByteSink& sink) {
  return put_text(sink, grid.name) && put_text(sink, grid.value_type) &&
         put_text(sink, grid.grid_class) && put(sink, grid.kind) && put_text(sink, grid.remark) &&
         put(sink, grid.world_from_index) && put(sink, grid.background) &&
         put(sink, grid.active_voxels) && put(sink, grid.active_tiles) && put(sink, grid.leaves) &&
         put(sink, grid.memory_bytes) && put(sink, grid.stated_memory_bytes) &&
         put(sink, grid.replaced_values) && put(sink, grid.active_box) &&
         put_array(sink, grid.tiles) && put_array(sink, grid.bricks);
}

bool encode_error(std::string_view message, const ByteSink& sink) {
  return put(sink, kMagic) && put(sink, kRefused) && put_text(sink, message);
}

Result<std::vector<VolumeGrid>> decode_answer(std::span<const std::byte> bytes) {
  const Error cut{"the reader's answer is cut short; the file is likely damaged"};
  Reader in(bytes);
  std::uint64_t magic = 0;
  std::uint32_t status = 0, count = 0;
  if (!in.take(magic) || magic != kMagic || !in.take(status)) return cut;
  if (status != kGrids) {
    std::string message;
    if (status != kRefused || !in.take_text(message) || message.empty()) return cut;
    return Error{message};
  }
  if (!in.take(count) || count > kMaxVolumeGrids) return cut;
  std::vector<VolumeGrid> grids;
  std::size_t tiles = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    VolumeGrid& grid = grids.emplace_back();
    if (!take_grid(in, grid)) return cut;
    tiles += grid.tiles.size();
    if (tiles > kMaxVolumeTiles)
      return Error{fmt::format("it holds more than {} tiles and even bricks; make it smaller",
                               kMaxVolumeTiles)};
    if (const auto problem = check_grid(grid))
      return Error{fmt::format("grid '{}' is damaged: {}", grid.name, problem->text)};
    find_statistics(grid);
  }
  if (!in.empty()) return Error{"the reader's answer is too long; the file is likely damaged"};
  make_names_unique(grids);
  return grids;
}

}  // namespace skerry::world
