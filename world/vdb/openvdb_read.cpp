#include <fmt/format.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <istream>
#include <limits>
#include <streambuf>
#include <string>
#include <type_traits>

#include "world/confined/jail.h"
#include "world/vdb/openvdb_jobs.h"

namespace skerry::world {
namespace {

using UInt8Grid = openvdb::Grid<openvdb::tree::Tree4<std::uint8_t, 5, 4, 3>::Type>;

/// Reads a descriptor whose offset others watch, in order. It can report its place and skip, not go
/// back.
class ForwardBuffer : public std::streambuf {
 public:
  explicit ForwardBuffer(int fd) : fd_(fd) {}

 protected:
  int_type underflow() override {
    const ssize_t count = ::read(fd_, buffer_.data(), buffer_.size());
    if (count <= 0) return traits_type::eof();
    position_ += count;
    setg(buffer_.data(), buffer_.data(), buffer_.data() + count);
    return traits_type::to_int_type(*gptr());
  }

  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type here = position_ - (egptr() - gptr());
    if (from == std::ios_base::end) return pos_type(off_type(-1));
    return seekpos(from == std::ios_base::cur ? here + offset : offset, std::ios_base::in);
  }

  pos_type seekpos(pos_type to, std::ios_base::openmode) override {
    off_type left = off_type(to) - (position_ - (egptr() - gptr()));
    if (left < 0) return pos_type(off_type(-1));
    while (left > 0) {
      if (gptr() == egptr() && underflow() == traits_type::eof()) return pos_type(off_type(-1));
      const off_type step = std::min<off_type>(left, egptr() - gptr());
      gbump(static_cast<int>(step));
      left -= step;
    }
    return to;
  }

 private:
  int fd_;
  off_type position_ = 0;  // of the buffer's end
  std::array<char, 1 << 16> buffer_;
};

IVec3 vector_of(const openvdb::Coord& at) {
  return {at.x(), at.y(), at.z()};
}

/// sRGB, 8 bits a channel, of a linear colour.
float packed_color(double r, double g, double b) {
  const auto channel = [](double linear) {
    if (!(linear > 0.0)) return 0.0;
    const double c = std::min(linear, 1.0);
    const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
    return std::floor(s * 255.0 + 0.5);
  };
  return static_cast<float>(channel(r) * 65536.0 + channel(g) * 256.0 + channel(b));
}

/// Values of one grid as floats, NaN where they are no numbers.
template <class T>
float float_of(const T& value) {
  if constexpr (std::is_same_v<T, openvdb::Vec3s> || std::is_same_v<T, openvdb::Vec3d>) {
    if (!std::isfinite(value.x()) || !std::isfinite(value.y()) || !std::isfinite(value.z()))
      return std::numeric_limits<float>::quiet_NaN();
    return packed_color(value.x(), value.y(), value.z());
  } else if constexpr (std::is_same_v<T, openvdb::ValueMask>) {
    return value ? 1.0f : 0.0f;
  } else {
    return static_cast<float>(value);
  }
}

/// Turns one typed tree into bricks and tiles.
template <class GridType>
class Extractor {
 public:
  Extractor(const GridType& grid, VolumeGrid& out)
      : grid_(grid), out_(out), keep_inactive_(out.kind == VolumeKind::kLevelSet) {
    out_.background = cleaned(float_of(grid.background()), 0.0f);
  }

  void run() {
    for (auto leaf = grid_.tree().cbeginLeaf(); leaf; ++leaf) add_leaf(*leaf);
    auto tile = grid_.tree().cbeginValueAll();
    tile.setMaxDepth(GridType::TreeType::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
      if (!tile.isValueOn() && !keep_inactive_) continue;
      const float value = tile_value(tile);
      if (value == out_.background) continue;
      openvdb::CoordBBox box;
      tile.getBoundingBox(box);
      add_tile({vector_of(box.min()), box.dim().x(), value});
    }
    const auto by_origin = [](const auto& a, const auto& b) { return a.origin < b.origin; };
    std::sort(out_.tiles.begin(), out_.tiles.end(), by_origin);
    std::sort(out_.bricks.begin(), out_.bricks.end(), by_origin);
  }

 private:
  float cleaned(float value, float instead) {
    if (std::isfinite(value)) return value;
    ++out_.replaced_values;
    return instead;
  }

  template <class Iterator>
  float tile_value(const Iterator& tile) {
    if constexpr (std::is_same_v<typename GridType::ValueType, openvdb::ValueMask>) {
      return tile.isValueOn() ? 1.0f : 0.0f;
    } else {
      return cleaned(float_of(tile.getValue()), out_.background);
    }
  }

  void add_leaf(const typename GridType::TreeType::LeafNodeType& leaf) {
    VolumeBrick brick{vector_of(leaf.origin()), {}};
    for (openvdb::Index i = 0; i < brick.values.size(); ++i) {
      const bool counts = keep_inactive_ || leaf.isValueOn(i);
      brick.values[i] =
          counts ? cleaned(float_of(leaf.getValue(i)), out_.background) : out_.background;
    }
    const float first = brick.values[0];
    if (std::any_of(brick.values.begin(), brick.values.end(),
                    [first](float v) { return v != first; })) {
      out_.bricks.push_back(brick);
    } else if (first != out_.background) {
      add_tile({brick.origin, kBrickEdge, first});
    }
  }

  void add_tile(const VolumeTile& tile) { out_.tiles.push_back(tile); }

  const GridType& grid_;
  VolumeGrid& out_;
  bool keep_inactive_;
};

bool names_color(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name == "cd" || name == "color" || name == "colour" || name == "rgb" || name == "albedo";
}

/// A grid that is not what its file says of it.
struct Damaged {
  std::string message;
};

void refuse(VolumeGrid& out, std::string why) {
  out.kind = VolumeKind::kOther;
  out.remark = std::move(why);
}

/// What a file says of a grid's active voxels must be what it holds: a flipped bit in the tree's
/// topology mostly shows here.
void check_metadata(const openvdb::GridBase& grid, const VolumeGrid& out) {
  using openvdb::GridBase;
  const auto voxels = grid.getMetadata<openvdb::Int64Metadata>(GridBase::META_FILE_VOXEL_COUNT);
  if (voxels && static_cast<std::uint64_t>(voxels->value()) != out.active_voxels) {
    throw Damaged{
        fmt::format("grid '{}' is damaged: it states {} active voxels and holds {}; "
                    "copy it again",
                    out.name, voxels->value(), out.active_voxels)};
  }
  const auto low = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MIN);
  const auto high = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MAX);
  if (!low || !high || out.active_voxels == 0) return;
  const openvdb::Vec3i a = low->value(), b = high->value();
  const VolumeBox& box = out.active_box;
  if (IVec3{a.x(), a.y(), a.z()} != box.min || IVec3{b.x(), b.y(), b.z()} != box.max) {
    throw Damaged{fmt::format(
        "grid '{}' is damaged: its active voxels are not where it states; copy it again",
        out.name)};
  }
}

void describe(const openvdb::GridBase& grid, VolumeGrid& out) {
  out.name = printable(grid.getName());
  out.value_type = grid.valueType();
  out.grid_class = openvdb::GridBase::gridClassToString(grid.getGridClass());
  out.active_voxels = grid.activeVoxelCount();
  out.active_tiles = grid.baseTree().activeTileCount();
  out.leaves = grid.baseTree().leafCount();
  out.memory_bytes = grid.memUsage();
  const auto stated =
      grid.getMetadata<openvdb::Int64Metadata>(openvdb::GridBase::META_FILE_MEM_BYTES);
  if (stated && stated->value() > 0)
    out.stated_memory_bytes = static_cast<std::uint64_t>(stated->value());
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (out.active_voxels > 0) out.active_box = {vector_of(box.min()), vector_of(box.max())};
  check_metadata(grid, out);
}

/// The matrix of an affine map. OpenVDB multiplies row vectors from the left, so that its rows are
/// our columns.
bool take_transform(const openvdb::GridBase& grid, VolumeGrid& out) {
  if (!grid.transform().isLinear()) return false;
  const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      out.world_from_index[row][column] = matrix(row, column);
  return true;
}

template <class GridType>
bool extract_as(const openvdb::GridBase& grid, VolumeKind kind, VolumeGrid& out) {
  if (!grid.isType<GridType>()) return false;
  out.kind = kind;
  Extractor<GridType>(static_cast<const GridType&>(grid), out).run();
  return true;
}

VolumeGrid volume_of(const openvdb::GridBase& grid) {
  VolumeGrid out;
  describe(grid, out);
  if (out.active_voxels > 0 && !within_reach(out.active_box)) {
    refuse(out, "its voxels lie beyond index 2^30; move it nearer to its origin");
    return out;
  }
  if (!take_transform(grid, out)) {
    refuse(out, "its transform is no affine one");
    return out;
  }
  const VolumeKind real =
      grid.getGridClass() == openvdb::GRID_LEVEL_SET ? VolumeKind::kLevelSet : VolumeKind::kFog;
  if (extract_as<openvdb::FloatGrid>(grid, real, out) ||
      extract_as<openvdb::DoubleGrid>(grid, real, out) ||
      extract_as<openvdb::BoolGrid>(grid, VolumeKind::kMask, out) ||
      extract_as<openvdb::MaskGrid>(grid, VolumeKind::kMask, out) ||
      extract_as<openvdb::Int32Grid>(grid, VolumeKind::kIds, out) ||
      extract_as<openvdb::Int64Grid>(grid, VolumeKind::kIds, out) ||
      extract_as<UInt8Grid>(grid, VolumeKind::kIds, out))
    return out;
  if (names_color(out.name)) {
    if (extract_as<openvdb::Vec3SGrid>(grid, VolumeKind::kColor, out) ||
        extract_as<openvdb::Vec3DGrid>(grid, VolumeKind::kColor, out))
      return out;
  }
  // By name: the header of point grids would triple this file's time to compile.
  if (out.value_type == "ptdataidx32") {
    refuse(out, "points have no surface");
  } else {
    refuse(out, "values of this type are neither a density, a distance, a block id nor a colour");
  }
  return out;
}

}  // namespace

Result<void> read_openvdb(int input, const ByteSink& sink) {
  openvdb::initialize();
  if (!UInt8Grid::isRegistered()) UInt8Grid::registerGrid();
  // TBB looks about in /sys when it is first used.
  tbb::parallel_for(0, 2, [](int) {});
  enter_jail();
  ForwardBuffer buffer(input);
  std::istream stream(&buffer);
  openvdb::GridPtrVecPtr grids;
  // OpenVDB does not ask whether a read came to its end, so the stream has to say so itself.
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  try {
    grids = openvdb::io::Stream(stream, false).getGrids();
  } catch (const std::ios_base::failure&) {
    return Error{"it is cut short; copy it again"};
  }
  if (grids->size() > kMaxVolumeGrids)
    return Error{fmt::format("it holds more than {} grids", kMaxVolumeGrids)};
  const Error full{"its values take more than is allowed; make it smaller"};
  if (!begin_answer(static_cast<std::uint32_t>(grids->size()), sink)) return full;
  try {
    for (openvdb::GridBase::Ptr& grid : *grids) {
      if (!encode_grid(volume_of(*grid), sink)) return full;
      grid.reset();
    }
  } catch (const Damaged& damaged) {
    return Error{damaged.message};
  }
  return {};
}

}  // namespace skerry::world
