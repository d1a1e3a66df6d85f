#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <utility>

#include "world/generate/fill.h"
#include "world/generate/plants.h"
#include "world/generate/sideways.h"

namespace skerry::world {
namespace {

constexpr int kPadded = kChunkEdge + 2;
// What is thin is judged with the voxels next to it, those of the shell included.
constexpr int kWide = kPadded + 2;
constexpr int kLayer = kWide * kWide;
// Layers read above the chunk: no cover is deeper than two coarse voxels.
constexpr int kLookAbove = 2;
constexpr int kLookBelow = 1;
constexpr int kLayers = kLookBelow + kPadded + kLookAbove;
constexpr int kCoarsestShifted = 2;  // larger voxels do not show the sideways shift
// Of half a voxel: what flat and upright sheets that are drawn have at least across, and rods.
constexpr int kSheetOf100 = 70, kWallOf100 = 120, kRodOf100 = 60;
constexpr int kThinBeside = 8;      // of the fullest of three: what one beside it may hold
constexpr int kFinestWithRods = 2;  // at level 1 half of the blocks is the best outline

using Row = std::array<std::int16_t, kLayer>;
using Masks = std::array<std::uint8_t, std::size_t{kLayers} * kLayer>;

/// noise::smooth() of the heights within a cell.
constexpr auto kSmooth = [] {
  std::array<int, sideways::kCellHeight> out{};
  for (int y = 0; y < sideways::kCellHeight; ++y)
    out[static_cast<std::size_t>(y)] = noise::smooth(y * noise::kOne12 / sideways::kCellHeight);
  return out;
}();

/// [first, end) along an axis.
struct Range {
  int first = 0, end = 0;
};

/// How many blocks of the voxels of a row along z are within the intervals of height that were
/// added. Second differences: an interval costs four sums, however high it is.
class RowCover {
 public:
  /// @param low block height of the lowest layer. @param layers all that are looked at.
  RowCover(int low, int level, Range layers) : low_(low), level_(level), layers_(layers) {}

  void clear() {
    for (int j = layers_.first; j <= layers_.end; ++j) {
      full_[static_cast<std::size_t>(j)].fill(0);
      part_[static_cast<std::size_t>(j)].fill(0);
    }
  }
  void add(int k, int bottom, int top, int weight) {
    if (top <= bottom) return;
    add_below(k, top, weight);
    add_below(k, bottom, -weight);
  }
  /// @param y within the layers.
  void add_block(int k, int y, int weight) {
    part_[static_cast<std::size_t>((y - low_) >> level_)][static_cast<std::size_t>(k)] +=
        static_cast<std::int16_t>(weight);
  }
  /// @param out of the row's first voxel in the lowest layer; layers are kLayer apart.
  void sum(std::int16_t* out) const {
    std::array<std::int16_t, kWide> columns{};  // that fill the layer from end to end
    for (int j = layers_.end - 1; j >= layers_.first; --j) {
      const auto& full = full_[static_cast<std::size_t>(j) + 1];
      const auto& part = part_[static_cast<std::size_t>(j)];
      std::int16_t* to = out + static_cast<std::ptrdiff_t>(j) * kLayer;
      for (std::size_t k = 0; k < kWide; ++k) {
        columns[k] = static_cast<std::int16_t>(columns[k] + full[k]);
        to[k] = static_cast<std::int16_t>((columns[k] << level_) + part[k]);
      }
    }
  }

 private:
  void add_below(int k, int height, int weight) {
    const int above = std::clamp(height - low_, layers_.first << level_, layers_.end << level_);
    const auto j = static_cast<std::size_t>(above >> level_);
    const int rest = above & ((1 << level_) - 1);
    full_[j][static_cast<std::size_t>(k)] += static_cast<std::int16_t>(weight);
    part_[j][static_cast<std::size_t>(k)] += static_cast<std::int16_t>(weight * rest);
  }

  int low_, level_;
  Range layers_;
  std::array<std::array<std::int16_t, kWide>, kLayers + 1> full_, part_;
};

/// Larger than a stack should hold; one a thread.
struct Scratch {
  std::array<std::int16_t, std::size_t{kLayers} * kLayer> rock, water;  // blocks of each voxel
  std::array<std::int16_t, std::size_t{kLayers} * kLayer> filled;       // with either
  Masks arches, holes;  // which of 2 x 2 x 2 places in a voxel they take
  std::array<SkinId, std::size_t{kLayers} * kLayer> skins;  // of ground in a voxel; bare: none
};

/// Fills one padded chunk of a coarse level. A voxel is solid where half of its blocks are or more:
/// columns are summed up exactly, what shifts sideways from half of its blocks at level 1 and in
/// 2 x 2 x 2 places at level 2, arches and caves in so many places at any level.
class CoarseFiller {
 public:
  CoarseFiller(const IslandPlan& plan, IVec3 chunk, int level, std::span<BlockId> out,
               Scratch& scratch);
  void fill();

 private:
  /// Of the columns of a voxel.
  struct Wet {
    int columns = 0;
    std::int16_t level = Columns::kDry;
  };
  /// Which of `count` voxels from `first` on lie between two blocks.
  Range reached(int first, int low, int high, int count) const {
    const int end = std::clamp(((high - 1) >> level_) + 1 - first, 0, count);
    return {std::clamp((low >> level_) - first, 0, end), end};
  }
  int places_edge() const { return edge_ / 2; }  // blocks from a place within a voxel to the next
  // Of the rows, in a layer.
  int first_place() const { return rows_.first * kWide; }
  int end_place() const { return rows_.end * kWide; }
  void sum_rows();
  /// Of the voxels of a row along z.
  struct RowSums {
    RowCover rock, water;
    bool wet = true;          // that `water` is not all zero
    SkinId* skins = nullptr;  // of its first voxel in the lowest layer
    std::array<bool, kWide> ragged{};
  };
  void note_skin(int k, int y, SkinId skin, RowSums& row) const;
  void sum_column(int k, int x, int z, RowSums& row, Wet& wet);
  void sum_ragged(int k, int x, int z, RowSums& row);
  void find_shifts();
  template <class F>
  void for_places(const std::vector<Ball>& balls, F&& f) const;
  void cut_balls();
  void carve(int i, int j, std::size_t at);
  void fill_thin();
  void mark_thin(int i, int j, int k, std::size_t at);
  void sum_filled();
  void cover(std::size_t at, SkinId id);
  void gather();
  void paint_layer(int j, BlockId* out);
  void stamps();

  const IslandPlan& plan_;
  const Columns& columns_;
  Canvas canvas_;
  const int level_, edge_;   // of a voxel, blocks
  const int x0_, z0_;        // of the rows, voxels
  const int y_low_, y_end_;  // of the layers, blocks
  const Range rows_;         // along x and along z that the plan's columns reach
  const Range along_;
  const Range layers_;  // that hold anything, and one more on either side
  std::span<BlockId> out_;
  Scratch& scratch_;
  std::vector<Ball> solids_, holes_;
  // Shifts at the corners of cells, layer by layer of cells.
  int cell_x0_ = 0, cell_y0_ = 0, cell_z0_ = 0, cells_ = 0;
  std::vector<sideways::Shift> corners_;
  struct Thin {
    std::size_t voxel;  // of out_
    BlockId block;
  };
  std::vector<Thin> thin_;           // solid, and filled less than half
  std::vector<std::size_t> ragged_;  // columns of voxels with rock that is shifted
  Row water_, skin_top_, skin_below_, below_depth_, top_depth_, depth_, carved_, layer_;
};

CoarseFiller::CoarseFiller(const IslandPlan& plan, IVec3 chunk, int level, std::span<BlockId> out,
                           Scratch& scratch)
    : plan_(plan),
      columns_(plan.columns),
      canvas_{chunk.x * kChunkEdge - 1, chunk.y * kChunkEdge - 1, chunk.z * kChunkEdge - 1, level,
              out},
      level_(level),
      edge_(1 << level),
      x0_(canvas_.x0 - 1),
      z0_(canvas_.z0 - 1),
      y_low_((canvas_.y0 - kLookBelow) * edge_),
      y_end_(y_low_ + kLayers * edge_),
      rows_(reached(x0_, -columns_.half, columns_.half, kWide)),
      along_(reached(z0_, -columns_.half, columns_.half, kWide)),
      layers_(reached(canvas_.y0 - kLookBelow, plan.lowest - edge_, plan.highest + edge_, kLayers)),
      out_(out),
      scratch_(scratch) {
  const int x = x0_ * edge_, z = z0_ * edge_, size = kWide * edge_;
  const auto near = [&](const Ball& b) {
    return b.x + b.radius >= x && b.x - b.radius < x + size && b.z + b.radius >= z &&
           b.z - b.radius < z + size && b.y + b.radius >= y_low_ && b.y - b.radius < y_end_;
  };
  std::copy_if(plan.solids.begin(), plan.solids.end(), std::back_inserter(solids_), near);
  std::copy_if(plan.holes.begin(), plan.holes.end(), std::back_inserter(holes_), near);
}

void CoarseFiller::find_shifts() {
  using sideways::floor_to;
  cell_x0_ = floor_to(x0_ * edge_, sideways::kCell);
  cell_y0_ = floor_to(y_low_ + layers_.first * edge_, sideways::kCellHeight);
  cell_z0_ = floor_to(z0_ * edge_, sideways::kCell);
  cells_ = kWide * edge_ / sideways::kCell + 3;
  const int layers = (layers_.end - layers_.first) * edge_ / sideways::kCellHeight + 3;
  corners_.clear();
  corners_.reserve(static_cast<std::size_t>(layers) * cells_ * cells_);
  for (int j = 0; j < layers; ++j) {
    for (int i = 0; i < cells_; ++i) {
      for (int k = 0; k < cells_; ++k)
        corners_.push_back(sideways::corner(plan_.shift_seed(), cell_x0_ + i,
                                            (cell_y0_ + j) * sideways::kCellHeight, cell_z0_ + k));
    }
  }
}

/// Sums up a column whose rock is shifted sideways layer by layer.
void CoarseFiller::sum_ragged(int k, int x, int z, RowSums& row) {
  using sideways::kCell;
  using sideways::kCellHeight;
  const int step = places_edge();
  if ((x & (step - 1)) != step / 2 || (z & (step - 1)) != step / 2) return;
  const int weight = step * step;
  // At level 1 half of the blocks, as on a chessboard.
  const int y_step = std::max(step, 2), phase = step > 1 ? step / 2 : (x ^ z) & 1;
  const Columns::Reach reach = columns_.reach_at(x, z);
  const std::size_t column = columns_.index(x, z);
  const int core_low = std::max(reach.core_bottom, reach.bottom),
            core_top = std::max<int>(core_low, std::min(reach.core_top, reach.top));
  row.rock.add(k, core_low, core_top, weight);
  const int i = sideways::floor_to(x, kCell), j = sideways::floor_to(z, kCell);
  int cell = INT32_MIN;
  sideways::Shift low{}, high{};
  const auto shift_at_cell = [&](int y_cell) {
    const sideways::Shift* c =
        &corners_[(static_cast<std::size_t>(y_cell - cell_y0_) * cells_ + (i - cell_x0_)) * cells_ +
                  (j - cell_z0_)];
    return sideways::between(c[0], c[cells_], c[1], c[cells_ + 1], x - i * kCell, z - j * kCell);
  };
  const auto look = [&](int first, int end) {
    first = std::max(first, y_low_ + layers_.first * edge_);
    end = std::min(end, y_low_ + layers_.end * edge_);
    for (int y = first + ((phase - first) & (y_step - 1)); y < end; y += y_step) {
      if (const int at = sideways::floor_to(y, kCellHeight); at != cell) {
        cell = at;
        low = shift_at_cell(cell);
        high = shift_at_cell(cell + 1);
      }
      const int t = kSmooth[static_cast<std::size_t>(y - cell * kCellHeight)];
      const auto mix = [t](int a, int b) { return a + (((b - a) * t) >> 12); };
      const std::size_t from =
          columns_.shifted_index(x, z, column, mix(low.x, high.x), mix(low.z, high.z));
      if (y < columns_.bottom[from] || y >= columns_.top[from]) continue;
      row.rock.add_block(k, y, weight * y_step);
      // The turf comes along with the rock, and only with its upper end: ledges below an overhang
      // are bare.
      if (y >= columns_.top[from] - kLedgeTurf) note_skin(k, y, columns_.skins[from], row);
    }
  };
  look(reach.bottom, core_low);
  look(core_top, reach.top);
}

void CoarseFiller::note_skin(int k, int y, SkinId skin, RowSums& row) const {
  const int j = (y - y_low_) >> level_;
  if (j < layers_.first || j >= layers_.end || skin == SkinId::kBare) return;
  row.skins[j * kLayer + k] = skin;
}

void CoarseFiller::sum_column(int k, int x, int z, RowSums& row, Wet& wet) {
  const std::size_t c = columns_.index(x, z);
  if (level_ <= kCoarsestShifted && columns_.ragged[c] > 0) {
    row.ragged[static_cast<std::size_t>(k)] = true;
    return sum_ragged(k, x, z, row);
  }
  if (columns_.top[c] == Columns::kNoGround) return;
  row.rock.add(k, columns_.bottom[c], columns_.top[c], 1);
  if (columns_.water[c] > columns_.top[c]) {
    row.water.add(k, columns_.top[c], columns_.water[c], 1);
    row.wet = true;
    ++wet.columns;
    wet.level = std::max(wet.level, columns_.water[c]);
  }
  note_skin(k, columns_.top[c] - 1, columns_.skins[c], row);
}

void CoarseFiller::sum_rows() {
  RowSums row{{y_low_, level_, layers_}, {y_low_, level_, layers_}};
  const auto block = [this](int voxel) {
    return std::clamp(voxel * edge_, -columns_.half, columns_.half);
  };
  if (level_ <= kCoarsestShifted) find_shifts();
  std::fill(&scratch_.skins[static_cast<std::size_t>(layers_.first) * kLayer],
            scratch_.skins.data() + static_cast<std::size_t>(layers_.end) * kLayer, SkinId::kBare);
  for (int i = rows_.first; i < rows_.end; ++i) {
    const int first = i * kWide;
    row.rock.clear();
    if (row.wet) row.water.clear();
    row.wet = false;
    row.skins = &scratch_.skins[static_cast<std::size_t>(first)];
    row.ragged.fill(false);
    for (int k = along_.first; k < along_.end; ++k) {
      Wet wet;
      for (int x = block(x0_ + i); x < block(x0_ + i + 1); ++x)
        for (int z = block(z0_ + k); z < block(z0_ + k + 1); ++z) sum_column(k, x, z, row, wet);
      water_[static_cast<std::size_t>(first + k)] =
          2 * wet.columns >= edge_ * edge_ ? wet.level : Columns::kDry;
      if (row.ragged[static_cast<std::size_t>(k)])
        ragged_.push_back(static_cast<std::size_t>(first + k));
    }
    row.rock.sum(&scratch_.rock[static_cast<std::size_t>(first)]);
    if (row.wet) row.water.sum(&scratch_.water[static_cast<std::size_t>(first)]);
    for (int j = layers_.first; !row.wet && j < layers_.end; ++j)
      std::fill_n(&scratch_.water[static_cast<std::size_t>(j * kLayer + first)], kWide,
                  std::int16_t{0});
  }
}

/// Calls f(ball, x, y, z) with the places in some ball, counted from the first voxel's first one.
template <class F>
void CoarseFiller::for_places(const std::vector<Ball>& balls, F&& f) const {
  const int step = places_edge();
  const auto first = [&](int low, int from) {  // the first place at `low` or above, in blocks
    return std::max(0, -sideways::floor_to(-(low - from - step / 2), step));
  };
  const auto last = [&](int high, int from, int count) {
    return std::min(2 * count - 1, sideways::floor_to(high - from - step / 2, step));
  };
  const int x0 = x0_ * edge_, z0 = z0_ * edge_;
  for (const Ball& b : balls) {
    const int y_first = first(std::max(b.y - b.radius, b.floor), y_low_);
    for (int y = y_first; y <= last(b.y + b.radius, y_low_, kLayers); ++y) {
      const int dy = y_low_ + y * step + step / 2 - b.y;
      for (int x = first(b.x - b.radius, x0); x <= last(b.x + b.radius, x0, kWide); ++x) {
        const int dx = x0 + x * step + step / 2 - b.x;
        const int rest = b.radius * b.radius - dy * dy - dx * dx;
        if (rest <= 0) continue;
        const auto reach = static_cast<int>(noise::isqrt(static_cast<std::uint64_t>(rest - 1)));
        for (int z = first(b.z - reach, z0); z <= last(b.z + reach, z0, kWide); ++z) f(b, x, y, z);
      }
    }
  }
}

/// The bit of a place in its voxel's mask, and the voxel.
struct Place {
  std::size_t voxel;
  std::uint8_t bit;
};
Place place_of(int x, int y, int z) {
  return {static_cast<std::size_t>((z >> 1) + kWide * (x >> 1) + kLayer * (y >> 1)),
          static_cast<std::uint8_t>(1u << ((z & 1) | (x & 1) << 1 | (y & 1) << 2))};
}

/// Adds arches to the sums and takes caves from them.
void CoarseFiller::cut_balls() {
  if (solids_.empty() && holes_.empty()) return;
  scratch_.arches.fill(0);
  scratch_.holes.fill(0);
  const auto mark = [](Masks& masks, int x, int y, int z) {
    const Place place = place_of(x, y, z);
    masks[place.voxel] = static_cast<std::uint8_t>(masks[place.voxel] | place.bit);
  };
  for_places(solids_, [&](const Ball&, int x, int y, int z) { mark(scratch_.arches, x, y, z); });
  const int step = places_edge();
  for_places(holes_, [&](const Ball& hole, int x, int y, int z) {
    const int bx = x0_ * edge_ + x * step + step / 2;
    const int bz = z0_ * edge_ + z * step + step / 2;
    if (!columns_.has(bx, bz)) return;
    const Ball& kind = hole.open ? kOpenHole : kClosedHole;
    if (y_low_ + y * step + step / 2 < plan_.roof_of(kind, columns_.index(bx, bz)))
      mark(scratch_.holes, x, y, z);
  });
  for (int j = layers_.first; j < layers_.end; ++j) {
    for (int i = first_place(); i < end_place(); ++i) {
      const std::size_t at = static_cast<std::size_t>(j) * kLayer + static_cast<std::size_t>(i);
      if ((scratch_.arches[at] | scratch_.holes[at]) != 0) carve(i, j, at);
    }
  }
}

void CoarseFiller::carve(int i, int j, std::size_t at) {
  const int step = places_edge();
  unsigned rock = 0;
  for (unsigned bit = 0; bit < 8; ++bit) {
    const auto place = [step](int low, unsigned half) {
      return low + static_cast<int>(half) * step + step / 2;
    };
    const int x = place((x0_ + i / kWide) * edge_, bit >> 1 & 1);
    const int z = place((z0_ + i % kWide) * edge_, bit & 1);
    const int y = place(y_low_ + j * edge_, bit >> 2);
    if (!columns_.has(x, z)) continue;
    const std::size_t c = columns_.index(x, z);
    if (y >= columns_.bottom[c] && y < columns_.top[c]) rock |= 1u << bit;
  }
  const unsigned left = (rock | scratch_.arches[at]) & ~unsigned{scratch_.holes[at]};
  const int more = (std::popcount(left) - std::popcount(rock)) * step * step * step;
  scratch_.rock[at] = static_cast<std::int16_t>(std::max(scratch_.rock[at] + more, 0));
}

/// Whether the middle one of three voxels, `step` apart, shows something thin of which they hold
/// parts: it is the fullest, the next one to one side is all but empty, as what is thinner than a
/// voxel touches two of them, and none is solid without.
bool is_thin(const std::int16_t* here, std::ptrdiff_t step, int half, int least) {
  const int before = here[-step], after = here[step];
  const auto [low, high] = std::minmax(before, after);
  return high < half && before < *here && after <= *here && kThinBeside * low <= *here &&
         low + *here + high >= least;
}

/// The same of the nine voxels of a layer, for what stands or hangs.
bool is_rod(const std::int16_t* here, int half, int least) {
  int sum = 0;
  for (int i = -1; i <= 1; ++i) {
    for (int k = -1; k <= 1; ++k) {
      const int of = here[i * kWide + k];
      const bool earlier = i < 0 || (i == 0 && k < 0);  // takes it of two that are as full
      if (of >= half || of > *here || (earlier && of == *here)) return false;
      sum += of;
    }
  }
  return sum >= least;
}

/// What is thinner than a voxel may fill half of none and be as wide to the eye: sheets and walls,
/// as at an island's rim, spikes, legs of arches, islets.
void CoarseFiller::fill_thin() {
  sum_filled();
  const int half = edge_ * edge_ * edge_ / 2;
  const int flat = half * kSheetOf100 / 100, upright = half * kWallOf100 / 100,
            rod = half * kRodOf100 / 100;
  const bool all = level_ >= kFinestWithRods;
  for (int j = layers_.first + 1; j + 1 < layers_.end; ++j) {
    for (int i = std::max(rows_.first, 1); i < std::min(rows_.end, kWide - 1); ++i) {
      const std::size_t row =
          static_cast<std::size_t>(j) * kLayer + static_cast<std::size_t>(i) * kWide;
      for (int k = std::max(along_.first, 1); k < std::min(along_.end, kWide - 1); ++k) {
        const std::size_t at = row + static_cast<std::size_t>(k);
        const std::int16_t* const here = &scratch_.filled[at];
        if (*here == 0 || *here >= half) continue;
        if (is_thin(here, kLayer, half, flat) ||
            (all && (is_thin(here, kWide, half, upright) || is_thin(here, 1, half, upright) ||
                     is_rod(here, half, rod))))
          mark_thin(i, j, k, at);
      }
    }
  }
}

void CoarseFiller::mark_thin(int i, int j, int k, std::size_t at) {
  scratch_.rock[at] = static_cast<std::int16_t>(edge_ * edge_ * edge_ / 2);
  if (const int y = j - kLookBelow; y >= 0 && y < kPadded)
    thin_.push_back({static_cast<std::size_t>((y * kPadded + i - 1) * kPadded + k - 1), kAir});
}

/// Rock and liquid of all voxels, and none in the rows around those that hold anything.
void CoarseFiller::sum_filled() {
  for (int j = layers_.first; j < layers_.end; ++j) {
    const auto row = [&](int i) {
      return static_cast<std::size_t>(j) * kLayer + static_cast<std::size_t>(i) * kWide;
    };
    if (rows_.first > 0)
      std::fill_n(&scratch_.filled[row(rows_.first - 1)], kWide, std::int16_t{0});
    if (rows_.end < kWide) std::fill_n(&scratch_.filled[row(rows_.end)], kWide, std::int16_t{0});
    for (std::size_t at = row(rows_.first); at < row(rows_.end); ++at)
      scratch_.filled[at] = static_cast<std::int16_t>(scratch_.rock[at] + scratch_.water[at]);
  }
}

void CoarseFiller::cover(std::size_t at, SkinId id) {
  const Skin& skin = kSkins[static_cast<std::size_t>(id)];
  const bool bare = id == SkinId::kBare;
  skin_top_[at] = static_cast<std::int16_t>(skin.top);
  skin_below_[at] = static_cast<std::int16_t>(skin.below);
  top_depth_[at] = bare ? 0 : 1;
  below_depth_[at] = static_cast<std::int16_t>(bare ? 0 : 1 + (skin.below_depth >> level_));
}

/// What covers the columns of voxels: what is in their middle, or what there is next to it.
void CoarseFiller::gather() {
  const auto ground = [this](int x, int z) {
    return columns_.has(x, z) && columns_.top[columns_.index(x, z)] != Columns::kNoGround;
  };
  for (int i = first_place(); i < end_place(); ++i) {
    const int x0 = (x0_ + i / kWide) * edge_, z0 = (z0_ + i % kWide) * edge_;
    int x = x0 + edge_ / 2, z = z0 + edge_ / 2;
    for (int n = 0; n < 4 && !ground(x, z); ++n) {
      x = x0 + edge_ / 4 + (n & 1) * edge_ / 2;
      z = z0 + edge_ / 4 + (n >> 1) * edge_ / 2;
    }
    const auto at = static_cast<std::size_t>(i);
    cover(at, ground(x, z) ? columns_.skins[columns_.index(x, z)] : SkinId::kBare);
  }
  depth_.fill(0);
}

/// Advances the depth below open air and turns it into blocks. No branch on data: the loops must
/// vectorise.
/// @param out the layer's voxels, or null above the chunk.
void CoarseFiller::paint_layer(int j, BlockId* out) {
  const auto half = static_cast<std::int16_t>(edge_ * edge_ * edge_ / 2);
  const auto height = static_cast<std::int16_t>(y_low_ + j * edge_);
  const std::size_t first = static_cast<std::size_t>(j) * kLayer;
  const std::int16_t* const rock_of = &scratch_.rock[first];
  const std::int16_t* const water_of = &scratch_.water[first];
  const auto liquid = static_cast<std::int16_t>(plan_.biome().liquid);
  const auto rock = static_cast<std::int16_t>(
      plan_.bands[static_cast<std::size_t>((height + edge_ / 2) & (kBandPeriod - 1))]);
  const bool cut = !holes_.empty();
  for (const std::size_t i : ragged_) cover(i, scratch_.skins[first + i]);
  for (int i = first_place(); i < end_place(); ++i)
    carved_[i] = cut && scratch_.holes[first + i] != 0 ? kUnderground : std::int16_t{0};
  for (int i = first_place(); i < end_place(); ++i) {
    const std::int16_t filled = select(rock_of[i] + water_of[i] >= half, -1, 0);
    // The uppermost voxel of a lake is of its liquid, however shallow it is.
    const std::int16_t surface = select(depth_[i] == 0, select(height < water_[i], -1, 0), 0);
    const auto solid =
        static_cast<std::int16_t>(select(rock_of[i] >= half, -1, 0) & filled & ~surface);
    const auto deeper = static_cast<std::int16_t>(std::min<std::int16_t>(depth_[i], kDeepest) + 1);
    const auto depth = static_cast<std::int16_t>((deeper & filled) | (carved_[i] & ~filled));
    const std::int16_t below = select(depth <= below_depth_[i], skin_below_[i], rock);
    const std::int16_t block = select(depth <= top_depth_[i], skin_top_[i], below);
    depth_[i] = depth;
    layer_[i] = static_cast<std::int16_t>((block & solid) | (liquid & filled & ~solid));
  }
  if (out == nullptr) return;
  for (int i = std::max(rows_.first, 1); i < std::min(rows_.end, kWide - 1); ++i)
    std::memcpy(out + static_cast<std::ptrdiff_t>(i - 1) * kPadded,
                &layer_[static_cast<std::size_t>(i * kWide + 1)], kPadded * sizeof(BlockId));
}

void CoarseFiller::fill() {
  sum_rows();
  cut_balls();
  gather();
  fill_thin();
  std::fill(out_.begin(), out_.end(), kAir);
  for (int j = layers_.end - 1; j >= std::max(layers_.first, kLookBelow); --j) {
    const int y = j - kLookBelow;
    paint_layer(j, y < kPadded ? &out_[static_cast<std::size_t>(y) * kPadded * kPadded] : nullptr);
  }
  // A crown on a crest fills the voxel that it shares with the crest.
  for (Thin& thin : thin_) thin.block = std::exchange(out_[thin.voxel], kAir);
  for (const Tree& tree : plan_.trees) draw_tree(tree, canvas_);
  for (const Thin& thin : thin_)
    if (out_[thin.voxel] == kAir) out_[thin.voxel] = thin.block;
  stamps();
  draw_glowing_plants(plan_, canvas_);
}

/// Upright rows of stamps in air, such as crystals, are drawn a voxel thick and so much shorter
/// that their faces keep their area: what glows keeps its light.
void CoarseFiller::stamps() {
  constexpr int kFaces = 4, kVoxelFaces = 5;  // of a row's block that are seen, of a voxel
  const std::vector<Stamp>& all = plan_.stamps;
  int area = 0;  // of rows so far that no voxel stands for
  for (std::size_t i = 0; i < all.size();) {
    const Stamp& first = all[i++];
    if (!first.into_air || block_kind(first.id) == BlockKind::kPlant) continue;
    const auto goes_on = [&](int up, std::size_t n) {
      return i < all.size() && all[i].x == first.x && all[i].z == first.z && all[i].into_air &&
             all[i].id == first.id && all[i].y == first.y + up * static_cast<int>(n);
    };
    const int up = goes_on(-1, 1) ? -1 : 1;
    std::size_t length = 1;
    for (; goes_on(up, length); ++length) ++i;
    area += static_cast<int>(length) * kFaces;
    const int count = area / (kVoxelFaces * edge_ * edge_);
    area %= kVoxelFaces * edge_ * edge_;
    // From the first voxel that is not solid yet.
    const int y = (first.y + up * edge_ / 2) >> level_;
    for (int n = 0; n < count; ++n) {
      BlockId* voxel = canvas_.find(first.x >> level_, y + up * n, first.z >> level_);
      if (voxel != nullptr && *voxel == kAir) *voxel = first.id;
    }
  }
}

}  // namespace

void fill_coarse(const IslandPlan& plan, IVec3 chunk, int level, std::span<BlockId> out) {
  thread_local const auto scratch = std::make_unique<Scratch>();
  CoarseFiller(plan, chunk, level, out, *scratch).fill();
}

}  // namespace skerry::world
