#include "world/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <utility>
#include <vector>

#include "engine/core/check.h"
#include "world/mesh/face_axes.h"
#include "world/mesh/kernel.h"

namespace skerry::world {

using namespace mesh_detail;

struct MeshScratch::Buffers {
  Planes planes;
  ByteTable table;
  std::vector<shared::Quad> quads;  // grows to the largest mesh so far
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(kPaddedVoxels);
};

MeshScratch::MeshScratch() : buffers_(std::make_unique<Buffers>()) {}
MeshScratch::~MeshScratch() = default;

namespace {

void grow_axis(std::uint64_t coordinates, int lower, int upper, std::uint8_t& low,
               std::uint8_t& high) {
  low = std::min(low, static_cast<std::uint8_t>(std::countr_zero(coordinates) + lower));
  high = std::max(high, static_cast<std::uint8_t>(63 - std::countl_zero(coordinates) + upper));
}

// Grows the box by the faces of voxels in `extent`. A face lies on one side of its voxel: on its
// own axis it takes no width.
void grow_bounds(const Extent& extent, unsigned face, ChunkMesh& out) {
  if (extent.x == 0) return;
  const std::uint64_t axes[3] = {extent.x, extent.y, extent.z};
  for (unsigned axis = 0; axis < 3; ++axis) {
    const bool own = face < shared::kFaceCount && axis == face / 2;
    const int lower = own && face % 2 == 0 ? 1 : 0;
    const int upper = own && face % 2 == 1 ? 0 : 1;
    grow_axis(axes[axis], lower, upper, out.bounds_min[axis], out.bounds_max[axis]);
  }
}

void add_plants(const Planes& planes, const Voxels& voxels, QuadSink& sink, ChunkMesh& out) {
  constexpr unsigned kDiagonals = shared::kFaceCount;  // faces 6 and 7
  Extent extent;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const std::uint64_t plants = planes.plant.row(y)[x];
      if (plants == 0) continue;
      extent.x |= std::uint64_t{1} << x;
      extent.y |= std::uint64_t{1} << y;
      extent.z |= plants;
      shared::Quad* quads = sink.reserve(2 * kEdge);
      for (std::uint64_t left = plants; left != 0; left &= left - 1) {
        const int z = std::countr_zero(left);
        const auto geometry = static_cast<std::uint32_t>(x | y << 6 | z << 12);
        const std::uint32_t id = voxels.table->ids[voxels.row(x, y)[z]];
        *quads++ = {geometry, id | kDiagonals << shared::kFaceShift};
        *quads++ = {geometry, id | (kDiagonals + 1) << shared::kFaceShift};
        sink.count += 2;
      }
    }
  }
  grow_bounds(extent, kDiagonals, out);
}

// Steps 2 and 3 for every range.
void mesh_planes(const Kernel& kernel, const Voxels& voxels, MeshScratch::Buffers& buffers,
                 ChunkMesh& out) {
  const Planes& planes = buffers.planes;
  QuadSink sink{buffers.quads};
  out.bounds_min = {kEdge, kEdge, kEdge};
  out.bounds_max = {};
  const auto add_faces = [&](const Plane& kind, bool any, bool own_id_hides, unsigned range) {
    for (unsigned face = 0; face < shared::kFaceCount; ++face) {
      if (any) {
        const Extent extent = kernel.mesh_face(planes, kind, own_id_hides, face, voxels, sink);
        grow_bounds(extent, face, out);
      }
      out.range_end[range + face] = static_cast<std::uint32_t>(sink.count);
    }
  };
  add_faces(planes.opaque, planes.any_opaque != 0, false, shared::kRangeOpaque);
  add_faces(planes.cutout, planes.any_cutout != 0, true, shared::kRangeCutout);
  if (planes.any_plant != 0) add_plants(planes, voxels, sink, out);
  out.range_end[shared::kRangePlant] = static_cast<std::uint32_t>(sink.count);
  add_faces(planes.translucent, planes.any_translucent != 0, true, shared::kRangeTranslucent);
  out.quads.assign(buffers.quads.data(), buffers.quads.data() + sink.count);
  if (sink.count == 0) out.bounds_min = {};
}

/// Cuts a translucent quad into those whose faces touch the same translucent block, or none, and
/// names it there. @param number_at(place) translucent_number() of a padded voxel.
template <class NumberAt>
void add_by_touched(shared::Quad quad, const NumberAt& number_at, std::vector<shared::Quad>& out) {
  static constexpr int kSteps[3] = {kVoxelStepX, kVoxelStepY, 1};
  static constexpr unsigned kShifts[3] = {0, 6, 12};
  const unsigned face = shared::surface_face(quad.material);
  const auto [axis, u, v] = axes_of_face(face);
  const std::uint32_t low = quad.geometry & 0x3ffffu;
  int beyond = face % 2 == 0 ? kSteps[axis] : -kSteps[axis];
  for (unsigned a = 0; a < 3; ++a)
    beyond += (static_cast<int>(low >> kShifts[a] & 63u) + 1) * kSteps[a];
  const int along_u = static_cast<int>(quad.geometry >> 18 & 63u) + 1;
  const int along_v = static_cast<int>(quad.geometry >> 24 & 63u) + 1;
  const auto number = [&](int i, int j) {
    return number_at(static_cast<std::size_t>(beyond + i * kSteps[u] + j * kSteps[v]));
  };
  const auto push = [&](std::uint32_t geometry, unsigned touched) {
    out.push_back(
        {geometry | touched << 30, quad.material | touched >> 2 << shared::kTouchedShift});
  };
  const auto all_alike = [&] {
    for (int j = 0; j < along_v; ++j)
      for (int i = 0; i < along_u; ++i)
        if (number(i, j) != number(0, 0)) return false;
    return true;
  };
  if (all_alike()) {
    push(quad.geometry, number(0, 0));
    return;
  }
  for (int j = 0; j < along_v; ++j) {
    for (int i = 0, end = 0; i < along_u; i = end) {
      for (end = i + 1; end < along_u && number(end, j) == number(i, j);) ++end;
      const auto at = low + (static_cast<std::uint32_t>(i) << kShifts[u]) +
                      (static_cast<std::uint32_t>(j) << kShifts[v]);
      const auto extent = static_cast<std::uint32_t>(end - i - 1) << 18;
      push(at | extent, number(i, j));
    }
  }
}

/// Says of translucent faces which other translucent block they touch: there two faces lie in one
/// plane, and whoever looks through them has to know them for one surface.
template <class NumberAt>
void name_touched(ChunkMesh& out, const NumberAt& number_at) {
  const auto first = out.quads.begin() + out.range_end[shared::kRangeTranslucent - 1];
  if (first == out.quads.end()) return;
  const std::vector<shared::Quad> merged(first, out.quads.end());
  out.quads.erase(first, out.quads.end());
  auto quad = merged.begin();
  std::uint32_t begin = out.range_end[shared::kRangeTranslucent - 1];
  for (unsigned face = 0; face < shared::kFaceCount; ++face) {
    std::uint32_t& end = out.range_end[shared::kRangeTranslucent + face];
    for (std::uint32_t left = end - begin; left != 0; --left, ++quad)
      add_by_touched(*quad, number_at, out.quads);
    begin = end;
    end = static_cast<std::uint32_t>(out.quads.size());
  }
}

void clear(ChunkMesh& out) {
  out.quads.clear();
  out.range_end.fill(0);
  out.bounds_min = out.bounds_max = {};
}

// Whether blocks of these ids alone can never show a face: opaque blocks hide each other, and one
// id hides itself unless it is a plant.
bool shows_nothing(std::span<const BlockId> palette) {
  if (palette.empty()) return true;
  if (palette.size() == 1) return block_kind(palette[0]) != BlockKind::kPlant;
  for (const BlockId id : palette) {
    if (block_kind(id) != BlockKind::kOpaque) return false;
  }
  return true;
}

// Step 1 for ids that do not fit a byte, voxel by voxel.
void build_wide_planes(std::span<const BlockId> voxels, Planes& planes) {
  const auto index = [](int x, int y, int z) {
    return static_cast<std::size_t>((z + 1) + (x + 1) * kVoxelStepX + (y + 1) * kVoxelStepY);
  };
  const auto flag_row = [&](int x, int y, int from_z, std::uint8_t flags) {
    std::uint64_t bits = 0;
    for (int z = 0; z < kEdge; ++z) {
      const bool set = (kind_flag(voxels[index(x, y, z + from_z)]) & flags) != 0;
      bits |= std::uint64_t{set} << z;
    }
    return bits;
  };
  const auto same_row = [&](int x, int y, int step) {
    std::uint64_t bits = 0;
    for (int z = 0; z < kEdge; ++z) {
      const std::size_t at = index(x, y, z);
      bits |= std::uint64_t{voxels[at] == voxels[at + static_cast<std::size_t>(step)]} << z;
    }
    return bits;
  };
  planes.any_opaque = planes.any_cutout = planes.any_translucent = planes.any_plant = 0;
  for (int y = -1; y <= kEdge; ++y) {
    for (int x = -1; x <= kEdge; ++x) {
      planes.opaque.row(y)[x] = flag_row(x, y, 0, kFlagOpaque);
      if (x < kEdge) planes.same_x.row(y)[x] = same_row(x, y, kVoxelStepX);
      if (y < kEdge) planes.same_y.row(y)[x] = same_row(x, y, kVoxelStepY);
      if (x < 0 || y < 0 || x == kEdge || y == kEdge) continue;
      planes.same_z.row(y)[x] = same_row(x, y, 1);
      planes.same_below_z.row(y)[x] = same_row(x, y, -1);
      planes.above_z.row(y)[x] = flag_row(x, y, 1, kFlagOpaque);
      planes.below_z.row(y)[x] = flag_row(x, y, -1, kFlagOpaque);
      planes.cutout.row(y)[x] = flag_row(x, y, 0, kFlagCutout);
      planes.translucent.row(y)[x] = flag_row(x, y, 0, kFlagTranslucent);
      planes.plant.row(y)[x] = flag_row(x, y, 0, kFlagPlant);
      planes.any_opaque |= planes.opaque.row(y)[x];
      planes.any_cutout |= planes.cutout.row(y)[x];
      planes.any_translucent |= planes.translucent.row(y)[x];
      planes.any_plant |= planes.plant.row(y)[x];
    }
  }
}

// Emission writes bytes: gives each quad the id of its lowest voxel.
void set_wide_ids(std::span<const BlockId> voxels, ChunkMesh& out) {
  for (shared::Quad& quad : out.quads) {
    const std::size_t x = quad.geometry & 63, y = quad.geometry >> 6 & 63,
                      z = quad.geometry >> 12 & 63;
    const BlockId id = voxels[(z + 1) + (x + 1) * kVoxelStepX + (y + 1) * kVoxelStepY];
    quad.material =
        shared::surface_face(quad.material) << shared::kFaceShift | shared::surface_block(id);
  }
}

void mesh_bytes(const Kernel& kernel, const std::uint8_t* bytes, MeshScratch::Buffers& buffers,
                ChunkMesh& out) {
  const Voxels voxels{bytes, &buffers.table};
  kernel.build_planes(voxels, buffers.planes);
  mesh_planes(kernel, voxels, buffers, out);
  name_touched(out, [&](std::size_t at) {
    const unsigned byte = bytes[at];
    return (buffers.table.flags[byte] & kFlagTranslucent) == 0
               ? 0u
               : translucent_number(buffers.table.ids[byte]);
  });
}

}  // namespace

namespace mesh_detail {

std::uint8_t kind_flag(BlockId id) {
  switch (block_kind(id)) {
    case BlockKind::kOpaque:
      return kFlagOpaque;
    case BlockKind::kCutout:
      return kFlagCutout;
    case BlockKind::kTranslucent:
      return kFlagTranslucent;
    case BlockKind::kPlant:
      return kFlagPlant;
    case BlockKind::kAir:
      break;
  }
  return 0;
}

void ByteTable::set(unsigned byte, BlockId id) {
  ids[byte] = static_cast<BlockId>(shared::surface_block(id));
  flags[byte] = kind_flag(id);
  if (flags[byte] & kFlagOpaque) opaque.add(byte);
  if (flags[byte] & kFlagsSeeThrough) see_through.add(byte);
}

void mesh_chunk_with(const Kernel& kernel, std::span<const BlockId> voxels, MeshScratch& scratch,
                     ChunkMesh& out) {
  SKERRY_ASSERT(voxels.size() == kPaddedVoxels);
  MeshScratch::Buffers& buffers = scratch.buffers();
  BlockId largest = 0;
  if (kernel.narrow(voxels, buffers.bytes.data(), largest)) {
    buffers.table = {};
    for (unsigned id = 0; id < 256; ++id) buffers.table.set(id, static_cast<BlockId>(id));
    buffers.table.narrow = largest < 64;
    mesh_bytes(kernel, buffers.bytes.data(), buffers, out);
    return;
  }
  build_wide_planes(voxels, buffers.planes);
  mesh_planes(kernel, {buffers.bytes.data(), &buffers.table}, buffers, out);
  set_wide_ids(voxels, out);
  name_touched(out, [&](std::size_t at) { return translucent_number(voxels[at]); });
}

void mesh_chunk_with(const Kernel& kernel, std::span<const std::uint8_t> voxels,
                     std::span<const BlockId> palette, MeshScratch& scratch, ChunkMesh& out) {
  SKERRY_ASSERT(voxels.size() == kPaddedVoxels && palette.size() <= 256);
  if (shows_nothing(palette)) {
    clear(out);
    return;
  }
  MeshScratch::Buffers& buffers = scratch.buffers();
  buffers.table = {};
  for (unsigned i = 0; i < palette.size(); ++i) buffers.table.set(i, palette[i]);
  buffers.table.narrow = palette.size() <= 64;
  mesh_bytes(kernel, voxels.data(), buffers, out);
}

std::span<const Kernel* const> kernels() {
  static const std::vector<const Kernel*> usable = [] {
    std::vector<const Kernel*> found;
#if defined(__x86_64__)
    __builtin_cpu_init();
    const bool bits = __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    if (bits && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vbmi") &&
        __builtin_cpu_supports("avx512vbmi2")) {
      found.push_back(&kAvx512Kernel);
    }
    if (bits && __builtin_cpu_supports("avx2")) found.push_back(&kAvx2Kernel);
#endif
    found.push_back(&kPortableKernel);
    return found;
  }();
  return usable;
}

}  // namespace mesh_detail

void mesh_chunk(std::span<const BlockId> voxels, MeshScratch& scratch, ChunkMesh& out) {
  mesh_chunk_with(*kernels().front(), voxels, scratch, out);
}

void mesh_chunk(std::span<const std::uint8_t> voxels, std::span<const BlockId> palette,
                MeshScratch& scratch, ChunkMesh& out) {
  mesh_chunk_with(*kernels().front(), voxels, palette, scratch, out);
}

void close_cutouts(ChunkMesh& mesh) {
  const auto begin_of = [&mesh](std::uint32_t range) {
    return mesh.quads.begin() + (range == 0 ? 0 : mesh.range_end[range - 1]);
  };
  if (begin_of(shared::kRangeCutout) == begin_of(shared::kRangePlant)) return;
  const auto end_order = [](const shared::Quad& quad) {
    const auto bits = [&quad](unsigned first) { return quad.geometry >> first & 63u; };
    std::array<unsigned, 3> end{bits(0) + 1, bits(6) + 1, bits(12) + 1};
    const auto [axis, u, v] = axes_of_face(shared::surface_face(quad.material));
    end[u] += bits(18);
    end[v] += bits(24);
    return std::array{end[1], end[0], end[2]};
  };
  std::vector<shared::Quad> quads;
  quads.reserve(mesh.quads.size());
  std::array<std::uint32_t, shared::kRangeCount> ends{};
  for (std::uint32_t range = 0; range < shared::kRangeCount; ++range) {
    if (range < shared::kFaceCount) {
      const std::uint32_t cutout = shared::kRangeCutout + range;
      std::merge(begin_of(range), begin_of(range + 1), begin_of(cutout), begin_of(cutout + 1),
                 std::back_inserter(quads), [&](const shared::Quad& a, const shared::Quad& b) {
                   return end_order(a) < end_order(b);
                 });
    } else if (range >= shared::kRangePlant) {
      quads.insert(quads.end(), begin_of(range), begin_of(range + 1));
    }
    ends[range] = static_cast<std::uint32_t>(quads.size());
  }
  mesh.quads = std::move(quads);
  std::copy(ends.begin(), ends.end(), mesh.range_end.begin());
}

}  // namespace skerry::world
