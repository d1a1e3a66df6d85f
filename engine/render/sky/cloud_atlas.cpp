#include "engine/render/sky/cloud_atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>
#include <optional>

#include "engine/core/check.h"

namespace skerry::render {
namespace {

constexpr int kEdge = static_cast<int>(shared::kCloudBrickEdge);
constexpr int kTexels = static_cast<int>(shared::kCloudBrickTexels);
constexpr std::size_t kBrickSize = std::size_t{kTexels} * kTexels * kTexels;
/// Cells of all volumes together, and bytes of the bricks.
constexpr std::int64_t kMostCells = std::int64_t{1} << 24;
constexpr std::uint64_t kMostBrickBytes = std::uint64_t{1} << 30;
/// A brick's place has eight bits an axis.
constexpr std::uint32_t kMostBricksAnEdge = 255;
constexpr int kCellStep = 1 << (shared::kCloudCellLevels - 1);
/// Densities beyond count as this. So one value that is absurd takes no digits from all others.
constexpr float kMostDensity = 1e4f;

float most_value(CloudRole role) {
  return role == CloudRole::kDensity ? kMostDensity : std::numeric_limits<float>::max();
}

int floor_cell(int index) {
  return index >> 3;
}

/// A grid's samples by cells of 8^3.
class Cells {
 public:
  /// Errors: too many cells.
  static Result<Cells> of(const CloudVolumeDesc& desc);
  bool empty() const { return count_.x == 0; }
  glm::ivec3 low() const { return low_; }  ///< first cell; its own samples are all 0
  glm::ivec3 count() const { return count_; }
  /// Samples of a cell and the first ones of those behind it, x fastest; empty if all are 0.
  /// @param value set to the one value of all samples, if they come from one tile.
  bool fill(glm::ivec3 cell, std::array<float, kBrickSize>& out, std::optional<float>& value) const;

 private:
  struct Source {
    const float* values = nullptr;  // null: all are `value`
    float value = 0.0f;
  };
  const Source& source(glm::ivec3 cell) const;  // cell in [0, count]
  std::size_t slot(glm::ivec3 cell) const {
    return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(size_.y) +
            static_cast<std::size_t>(cell.y)) *
               static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(cell.x);
  }
  glm::ivec3 low_{0}, count_{0}, size_{0};
  float most_value_ = 0.0f;
  std::vector<Source> sources_;  // one layer more than count_ each way
};

bool any_above_zero(const CloudBrick& brick) {
  return std::any_of(brick.values, brick.values + 512, [](float v) { return v > 0.0f; });
}

Result<Cells> Cells::of(const CloudVolumeDesc& desc) {
  Cells out;
  out.most_value_ = most_value(desc.role);
  glm::ivec3 low(1 << 28), end(-(1 << 28));
  const auto take = [&](glm::ivec3 first, int edge) {
    low = glm::min(low, glm::ivec3(floor_cell(first.x), floor_cell(first.y), floor_cell(first.z)));
    const glm::ivec3 last = first + (edge - 1);
    end = glm::max(end, glm::ivec3(floor_cell(last.x), floor_cell(last.y), floor_cell(last.z)) + 1);
  };
  for (const CloudBrick& brick : desc.bricks)
    if (any_above_zero(brick)) take(brick.origin, kEdge);
  for (const CloudTile& tile : desc.tiles)
    if (tile.value > 0.0f) take(tile.origin, tile.edge);
  if (low.x >= end.x) return out;
  out.low_ = low - 1;
  out.count_ = end - out.low_;
  out.size_ = out.count_ + 1;
  const std::int64_t cells =
      std::int64_t{out.size_.x} * std::int64_t{out.size_.y} * std::int64_t{out.size_.z};
  if (out.size_.x > (1 << 20) || out.size_.y > (1 << 20) || out.size_.z > (1 << 20) ||
      cells > kMostCells)
    return Error{
        fmt::format("the cloud's box of {} x {} x {} voxels is too large to be drawn: it "
                    "may have {} cells of 8 x 8 x 8; crop or resample the grid",
                    out.count_.x * std::int64_t{kEdge}, out.count_.y * std::int64_t{kEdge},
                    out.count_.z * std::int64_t{kEdge}, kMostCells)};
  out.sources_.resize(static_cast<std::size_t>(cells));
  for (const CloudBrick& brick : desc.bricks)
    if (any_above_zero(brick))
      out.sources_[out.slot(brick.origin / kEdge - out.low_)] = {brick.values, 0.0f};
  for (const CloudTile& tile : desc.tiles) {
    if (!(tile.value > 0.0f)) continue;
    const glm::ivec3 first = tile.origin / kEdge - out.low_, last = first + tile.edge / kEdge;
    for (int z = first.z; z < last.z; ++z)
      for (int y = first.y; y < last.y; ++y)
        for (int x = first.x; x < last.x; ++x)
          out.sources_[out.slot({x, y, z})].value = std::min(tile.value, out.most_value_);
  }
  return out;
}

bool Cells::fill(glm::ivec3 cell, std::array<float, kBrickSize>& out,
                 std::optional<float>& value) const {
  bool any = false, even = true;
  for (int i = 0; i < 8; ++i) {
    const Source& s = sources_[slot(cell + glm::ivec3(i & 1, (i >> 1) & 1, i >> 2))];
    any = any || s.values || s.value > 0.0f;
    even = even && !s.values && s.value == sources_[slot(cell)].value;
  }
  value.reset();
  if (!any) return false;
  if (even) value = sources_[slot(cell)].value;
  float most = 0.0f;
  for (int z = 0; z < kTexels; ++z)
    for (int y = 0; y < kTexels; ++y)
      for (int x = 0; x < kTexels; ++x) {
        const glm::ivec3 beyond(x / kEdge, y / kEdge, z / kEdge);
        const Source& s = sources_[slot(cell + beyond)];
        const int index = z % kEdge + 8 * (y % kEdge) + 64 * (x % kEdge);
        const float v = s.values ? std::clamp(s.values[index], 0.0f, most_value_) : s.value;
        out[static_cast<std::size_t>(x + kTexels * (y + kTexels * z))] = v;
        most = std::max(most, v);
      }
  return most > 0.0f;
}

/// Bricks in the order in which they were made.
class Bricks {
 public:
  Bricks(CloudPrecision precision) : precision_(precision) {}
  std::uint32_t count() const { return count_; }
  std::size_t texel_bytes() const { return static_cast<std::size_t>(precision_) / 8; }
  std::uint32_t add(const std::array<float, kBrickSize>& values, float range);
  /// The image of all of them. @param columns bricks along x and y.
  std::vector<std::byte> image(glm::uvec3 columns) const;

 private:
  CloudPrecision precision_;
  std::uint32_t count_ = 0;
  std::vector<std::byte> texels_;
};

std::uint32_t Bricks::add(const std::array<float, kBrickSize>& values, float range) {
  const std::size_t begin = texels_.size();
  texels_.resize(begin + kBrickSize * texel_bytes());
  for (std::size_t i = 0; i < kBrickSize; ++i) {
    const float share = values[i] / range;
    std::byte* to = texels_.data() + begin + i * texel_bytes();
    if (precision_ == CloudPrecision::k8) {
      *to = static_cast<std::byte>(static_cast<std::uint8_t>(std::floor(share * 255.0f + 0.5f)));
    } else if (precision_ == CloudPrecision::k16) {
      const std::uint16_t half = glm::packHalf1x16(share);
      std::memcpy(to, &half, sizeof(half));
    } else {
      std::memcpy(to, &share, sizeof(share));
    }
  }
  return count_++;
}

std::vector<std::byte> Bricks::image(glm::uvec3 columns) const {
  const glm::uvec3 size = columns * shared::kCloudBrickTexels;
  std::vector<std::byte> out(std::size_t{size.x} * size.y * size.z * texel_bytes());
  const std::size_t row = kTexels * texel_bytes();
  for (std::uint32_t brick = 0; brick < count_; ++brick) {
    const glm::uvec3 at(brick % columns.x, brick / columns.x % columns.y,
                        brick / (columns.x * columns.y));
    for (std::uint32_t r = 0; r < kTexels * kTexels; ++r) {
      const glm::uvec3 texel =
          at * shared::kCloudBrickTexels + glm::uvec3(0, r % kTexels, r / kTexels);
      const std::size_t to =
          (std::size_t{texel.z} * size.y + texel.y) * size.x + std::size_t{texel.x};
      std::memcpy(out.data() + to * texel_bytes(),
                  texels_.data() + brick * kBrickSize * texel_bytes() + r * row, row);
    }
  }
  return out;
}

/// A cell's texel before the atlas has a size: its brick, and its largest value over the range,
/// rounded up to 8 bits.
struct CellTexel {
  std::uint32_t brick = 0;
  std::uint8_t most = 0;
};

/// The box of samples above 0, one wider each way: there trilinear values end.
void find_support(const CloudVolumeDesc& desc, PackedVolume& out) {
  glm::ivec3 low(1 << 30), high(-(1 << 30));
  float most = 0.0f;
  for (const CloudBrick& brick : desc.bricks)
    for (int i = 0; i < 512; ++i) {
      if (!(brick.values[i] > 0.0f)) continue;
      const glm::ivec3 at = brick.origin + glm::ivec3(i / 64, i / 8 % 8, i % 8);
      low = glm::min(low, at);
      high = glm::max(high, at);
      most = std::max(most, brick.values[i]);
    }
  for (const CloudTile& tile : desc.tiles) {
    if (!(tile.value > 0.0f)) continue;
    low = glm::min(low, tile.origin);
    high = glm::max(high, tile.origin + (tile.edge - 1));
    most = std::max(most, tile.value);
  }
  out.value_range = std::min(most, most_value(desc.role));
  out.low = low - 1;
  out.high = high + 1;
}

Result<void> pack_one(const CloudVolumeDesc& desc, Bricks& bricks, std::uint64_t most_bricks,
                      PackedVolume& out, std::vector<CellTexel>& texels) {
  const double scale = std::abs(glm::determinant(glm::dmat3(desc.blocks_from_index)));
  if (!(scale > 1e-12 && scale < 1e12))
    return Error{
        "a cloud's transform cannot be inverted: its voxels must be between 1e-4 and 1e4 blocks "
        "large"};
  const Result<Cells> cells = Cells::of(desc);
  if (!cells) return cells.error();
  if (cells->empty()) return {};
  find_support(desc, out);
  out.cell_low = cells->low() * kEdge;
  out.cell_count = cells->count();
  const glm::vec3 extent(out.high - out.low);
  const float longest = std::max({extent.x, extent.y, extent.z});
  out.light_texels = glm::clamp(
      glm::ivec3(glm::ceil(extent / longest * static_cast<float>(shared::kVolumeLightEdge))),
      glm::ivec3(2), glm::ivec3(static_cast<int>(shared::kVolumeLightEdge)));
  std::map<float, std::uint32_t> even_bricks;
  std::array<float, kBrickSize> values{};
  for (int z = 0; z < out.cell_count.z; ++z)
    for (int y = 0; y < out.cell_count.y; ++y)
      for (int x = 0; x < out.cell_count.x; ++x) {
        CellTexel& texel = texels.emplace_back();
        std::optional<float> even;
        if (!cells->fill({x, y, z}, values, even)) continue;
        const float most = *std::max_element(values.begin(), values.end());
        texel.most = static_cast<std::uint8_t>(
            std::clamp(std::ceil(most / out.value_range * 255.0f), 1.0f, 255.0f));
        const auto known = even ? even_bricks.find(*even) : even_bricks.end();
        if (known != even_bricks.end()) {
          texel.brick = known->second;
          continue;
        }
        if (bricks.count() >= most_bricks)
          return Error{
              fmt::format("the clouds are too large to be drawn: their bricks may take {} "
                          "MiB; use fewer files, or clouds.precision=8",
                          kMostBrickBytes >> 20)};
        texel.brick = bricks.add(values, out.value_range);
        if (even) even_bricks.emplace(*even, texel.brick);
      }
  return {};
}

/// Level 0 of the cells' image, then the maxima of 2^3 each.
std::vector<std::byte> cell_image(const CloudAtlas& atlas, glm::uvec3 columns,
                                  const std::vector<std::vector<CellTexel>>& texels) {
  std::vector<std::byte> out;
  glm::uvec3 size = atlas.cells;
  std::size_t finer = 0;
  for (std::uint32_t level = 0; level < shared::kCloudCellLevels; ++level) {
    const std::size_t begin = out.size();
    out.resize(begin + std::size_t{size.x} * size.y * size.z * 4);
    const auto at = [](glm::uvec3 p, glm::uvec3 of) {
      return ((std::size_t{p.z} * of.y + p.y) * of.x + p.x) * 4;
    };
    if (level == 0) {
      for (std::size_t v = 0; v < atlas.volumes.size(); ++v) {
        const PackedVolume& volume = atlas.volumes[v];
        for (std::size_t i = 0; i < texels[v].size(); ++i) {
          const glm::uvec3 n(volume.cell_count);
          const glm::uvec3 cell(i % n.x, i / n.x % n.y, i / (std::size_t{n.x} * n.y));
          std::byte* to = out.data() + at(glm::uvec3(volume.first_cell) + cell, size);
          const std::uint32_t brick = texels[v][i].brick;
          const std::array<std::uint32_t, 4> value{brick % columns.x, brick / columns.x % columns.y,
                                                   brick / (columns.x * columns.y),
                                                   texels[v][i].most};
          for (std::size_t c = 0; c < 4; ++c) to[c] = static_cast<std::byte>(value[c]);
        }
      }
    } else {
      for (std::uint32_t i = 0; i < size.x * size.y * size.z; ++i) {
        const glm::uvec3 p(i % size.x, i / size.x % size.y, i / (size.x * size.y));
        std::byte most{0};
        for (std::uint32_t c = 0; c < 8; ++c)
          most = std::max(
              most,
              out[finer + at(p * 2u + glm::uvec3(c & 1u, (c >> 1) & 1u, c >> 2), size * 2u) + 3]);
        out[begin + at(p, size) + 3] = most;
      }
    }
    finer = begin;
    size /= 2u;
  }
  return out;
}

}  // namespace

Result<CloudAtlas> pack_clouds(std::span<const CloudVolumeDesc> volumes, CloudPrecision precision,
                               std::uint32_t most_texels) {
  CloudAtlas out;
  Bricks bricks(precision);
  const std::uint64_t edge =
      std::min<std::uint64_t>(most_texels / shared::kCloudBrickTexels, kMostBricksAnEdge);
  const std::uint64_t most_bricks =
      std::min(edge * edge * edge, kMostBrickBytes / (kBrickSize * bricks.texel_bytes()));
  std::vector<std::vector<CellTexel>> texels;
  glm::ivec3 cells(0);
  std::uint32_t drawn = 0;
  for (const CloudVolumeDesc& desc : volumes) {
    PackedVolume& packed = out.volumes.emplace_back();
    if (Result<void> ok = pack_one(desc, bricks, most_bricks, packed, texels.emplace_back()); !ok)
      return ok.error();
    if (packed.value_range == 0.0f) continue;
    if (++drawn > shared::kMaxCloudVolumes)
      return Error{
          fmt::format("there are more than {} grids in the clouds' files: no more can be drawn; "
                      "leave some files out",
                      shared::kMaxCloudVolumes)};
    packed.first_cell = {0, 0, cells.z};
    cells = {std::max(cells.x, packed.cell_count.x), std::max(cells.y, packed.cell_count.y),
             cells.z + packed.cell_count.z};
    cells = (cells + (kCellStep - 1)) / kCellStep * kCellStep;
  }
  if (bricks.count() == 0) return out;
  const auto most = static_cast<std::uint32_t>(std::max({cells.x, cells.y, cells.z}));
  if (most > most_texels)
    return Error{
        fmt::format("the clouds are too large to be drawn: {} cells of 8 x 8 x 8 voxels "
                    "along an edge, this device takes {}; crop or resample the grids",
                    most, most_texels)};
  // Volumes lie one behind the other in one image, which is as wide and high as the largest is.
  const std::int64_t together = std::int64_t{cells.x} * cells.y * cells.z;
  if (together > kMostCells)
    return Error{
        fmt::format("the clouds are too large to be drawn: their boxes take {} cells of 8 x 8 x 8 "
                    "voxels together, and may take {}; crop the grids or use fewer files",
                    together, kMostCells)};
  const auto side = static_cast<std::uint32_t>(std::ceil(std::cbrt(bricks.count())));
  glm::uvec3 columns(side, side, (bricks.count() + side * side - 1) / (side * side));
  out.brick_count = bricks.count();
  out.brick_texels = columns * shared::kCloudBrickTexels;
  out.bricks = bricks.image(columns);
  out.cells = glm::uvec3(cells);
  out.cell_texels = cell_image(out, columns, texels);
  return out;
}

}  // namespace skerry::render
