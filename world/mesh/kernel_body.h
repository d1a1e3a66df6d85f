// The mesher's steps, compiled once for each instruction set: the including file defines
// SKERRY_MESH_TARGET (its target attribute) and the primitives named below, then includes this.
//
//   RowReader(table).kinds(bytes)       RowKinds of 64 voxels
//   RowReader(table).flag(bytes, flag)  one bit for each of 64 voxels: has the KindFlag
//   NarrowReader                        RowReader for tables whose bytes stay below 64
//   row_equal(a, b)                bit i: a[i] == b[i], 64 bytes
//   nonzero_words(words)           bit i: words[i] != 0, 64 words
//   set_bytes(bytes, mask, value)  bytes[i] = value where bit i is set
//   emit_runs, emit_columns        see Emission
#include <cstring>

#include "world/mesh/kernel.h"

// Vectors are returned by value: the calling convention it warns of does not matter, because all
// of this is internal to one file.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace skerry::world::mesh_detail {
namespace {

// Eight words, one for each of eight neighbouring x. Every compiler we build with lowers these
// vectors to what the target has.
using Lanes = std::uint64_t __attribute__((vector_size(64), may_alias));
constexpr int kLanes = 8;
// How far ahead of use voxels are asked for: a page, where the CPU's own prefetching stops. On a
// Zen 5 it takes a third off the time of an island's chunk that comes from the last-level cache.
constexpr int kPrefetchBytes = 4096;

SKERRY_MESH_TARGET inline Lanes& lanes(std::uint64_t* aligned) {
  return *reinterpret_cast<Lanes*>(aligned);
}
SKERRY_MESH_TARGET inline const Lanes& lanes(const std::uint64_t* aligned) {
  return *reinterpret_cast<const Lanes*>(aligned);
}
SKERRY_MESH_TARGET inline Lanes lanes_anywhere(const std::uint64_t* words) {
  Lanes loaded;
  std::memcpy(&loaded, words, sizeof loaded);
  return loaded;
}

// All eight words, or-ed together.
SKERRY_MESH_TARGET inline std::uint64_t combined(Lanes& words) {
  words |= __builtin_shufflevector(words, words, 4, 5, 6, 7, 0, 1, 2, 3);
  words |= __builtin_shufflevector(words, words, 2, 3, 0, 1, 6, 7, 4, 5);
  return words[0] | words[1];
}

template <class Reader>
SKERRY_MESH_TARGET inline void build_shell_row(const Reader& reader, const Voxels& voxels,
                                               Planes& planes, int x, int y) {
  planes.opaque.row(y)[x] = reader.flag(voxels.row(x, y), kFlagOpaque);
}

// Kinds of every voxel, and opacity across the z borders. Reads the chunk once, in order.
template <class Reader>
SKERRY_MESH_TARGET inline void build_kinds(const Voxels& voxels, Planes& planes) {
  const Reader reader(*voxels.table);
  std::uint64_t any_opaque = 0, any_see_through = 0;
  for (int x = 0; x < kEdge; ++x) build_shell_row(reader, voxels, planes, x, -1);
  for (int y = 0; y < kEdge; ++y) {
    build_shell_row(reader, voxels, planes, -1, y);
    std::uint64_t* const opaque = planes.opaque.row(y);
    std::uint64_t* const above_z = planes.above_z.row(y);
    std::uint64_t* const below_z = planes.below_z.row(y);
    std::uint64_t* const see_through = planes.see_through.row(y);
    const std::uint8_t* bytes = voxels.row(0, y);
    for (int x = 0; x < kEdge; ++x, bytes += kVoxelStepX) {
      // Rows are 66 bytes apart: one line a row would leave gaps.
      __builtin_prefetch(bytes + kPrefetchBytes);
      __builtin_prefetch(bytes + kPrefetchBytes + 64);
      const RowKinds row = reader.kinds(bytes);
      opaque[x] = row.opaque;
      above_z[x] = row.above_z;
      below_z[x] = row.below_z;
      see_through[x] = row.see_through;
      any_opaque |= row.opaque;
      any_see_through |= row.see_through;
    }
    build_shell_row(reader, voxels, planes, kEdge, y);
  }
  for (int x = 0; x < kEdge; ++x) build_shell_row(reader, voxels, planes, x, kEdge);
  planes.any_opaque = any_opaque;
  planes.any_see_through = any_see_through;
}

// Same-id bits, for rows with an opaque face only: the others are not used. In an island five
// rows of six lie in the air or in the ground.
SKERRY_MESH_TARGET inline void build_same(const Voxels& voxels, Planes& planes) {
  for (int y = 0; y < kEdge; ++y) {
    alignas(64) std::uint64_t faces[kEdge];
    const std::uint64_t* opaque = planes.opaque.row(y);
    for (int x = 0; x < kEdge; x += kLanes) {
      const Lanes surrounded = lanes_anywhere(opaque + x + 1) & lanes_anywhere(opaque + x - 1) &
                               lanes(planes.opaque.row(y + 1) + x) &
                               lanes(planes.opaque.row(y - 1) + x) &
                               lanes(planes.above_z.row(y) + x) & lanes(planes.below_z.row(y) + x);
      lanes(faces + x) = lanes(opaque + x) & ~surrounded;
    }
    for (std::uint64_t rows = nonzero_words(faces); rows != 0; rows &= rows - 1) {
      const int x = __builtin_ctzll(rows);
      const std::uint8_t* bytes = voxels.row(x, y);
      planes.same_x.row(y)[x] = row_equal(bytes, bytes + kVoxelStepX);
      planes.same_y.row(y)[x] = row_equal(bytes, bytes + kVoxelStepY);
      planes.same_z.row(y)[x] = row_equal(bytes, bytes + 1);
    }
  }
}

// Splits `see_through` into its kinds. Their own ids hide them, so that they look at the voxels
// before them too.
SKERRY_MESH_TARGET inline void split_see_through(const Voxels& voxels, Planes& planes) {
  const RowReader reader(*voxels.table);
  planes.any_cutout = planes.any_translucent = planes.any_plant = 0;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      std::uint64_t cutout = 0, translucent = 0, plant = 0;
      if (planes.see_through.row(y)[x] != 0) {
        const std::uint8_t* bytes = voxels.row(x, y);
        cutout = reader.flag(bytes, kFlagCutout);
        translucent = reader.flag(bytes, kFlagTranslucent);
        plant = planes.see_through.row(y)[x] & ~(cutout | translucent);
        planes.same_x.row(y)[x] = row_equal(bytes, bytes + kVoxelStepX);
        planes.same_x.row(y)[x - 1] = row_equal(bytes, bytes - kVoxelStepX);
        planes.same_y.row(y)[x] = row_equal(bytes, bytes + kVoxelStepY);
        planes.same_y.row(y - 1)[x] = row_equal(bytes, bytes - kVoxelStepY);
        planes.same_z.row(y)[x] = row_equal(bytes, bytes + 1);
        planes.same_below_z.row(y)[x] = row_equal(bytes, bytes - 1);
      }
      planes.cutout.row(y)[x] = cutout;
      planes.translucent.row(y)[x] = translucent;
      planes.plant.row(y)[x] = plant;
      planes.any_cutout |= cutout;
      planes.any_translucent |= translucent;
      planes.any_plant |= plant;
    }
  }
}

SKERRY_MESH_TARGET void build_planes(const Voxels& voxels, Planes& planes) {
  if (voxels.table->narrow) {
    build_kinds<NarrowReader>(voxels, planes);
  } else {
    build_kinds<RowReader>(voxels, planes);
  }
  if (planes.any_opaque != 0) build_same(voxels, planes);
  if (planes.any_see_through != 0) {
    split_see_through(voxels, planes);
  } else {
    planes.any_cutout = planes.any_translucent = planes.any_plant = 0;
  }
}

// One face direction of one kind: where its faces are, and where its quads go.
struct Sweep {
  const Planes& planes;
  const Plane& kind;
  bool own_id_hides;
  unsigned face;
  const Voxels& voxels;
  QuadSink& sink;
  Extent extent;

  // Words that hide the faces of row (0, y).
  const std::uint64_t* opaque_neighbour(int y) const {
    switch (face) {
      case 0:
        return planes.opaque.row(y) + 1;
      case 1:
        return planes.opaque.row(y) - 1;
      case 2:
        return planes.opaque.row(y + 1);
      case 3:
        return planes.opaque.row(y - 1);
      case 4:
        return planes.above_z.row(y);
      default:
        return planes.below_z.row(y);
    }
  }
  const std::uint64_t* same_neighbour(int y) const {
    switch (face) {
      case 0:
        return planes.same_x.row(y);
      case 1:
        return planes.same_x.row(y) - 1;
      case 2:
        return planes.same_y.row(y);
      case 3:
        return planes.same_y.row(y - 1);
      case 4:
        return planes.same_z.row(y);
      default:
        return planes.same_below_z.row(y);
    }
  }
};

// One layer (fixed y) of faces and their runs. Words from 64 on stay 0: the row beyond the chunk.
struct alignas(64) Layer {
  static constexpr int kWords = kEdge + kLanes;
  alignas(64) std::uint64_t face[kWords] = {};
  alignas(64) std::uint64_t link[kWords] = {};   // this face and the next one of its run
  alignas(64) std::uint64_t start[kWords] = {};  // first face of a run
  alignas(64) std::uint64_t end[kWords] = {};    // last face of a run
  bool any = false;
};

// Words shifted by one row: at(x) - 1 is the row before, 0 for x = 0.
struct alignas(64) Carried {
  alignas(64) std::uint64_t words[kLanes + kEdge] = {};
  std::uint64_t* at(int x) { return words + kLanes + x; }
};

// The visible faces of layer y.
SKERRY_MESH_TARGET inline void load_faces(Sweep& sweep, int y, Layer& layer) {
  const std::uint64_t* kind = sweep.kind.row(y);
  const std::uint64_t* hidden = sweep.opaque_neighbour(y);
  const std::uint64_t* same = sweep.same_neighbour(y);
  Lanes any = {};
  for (int x = 0; x < kEdge; x += kLanes) {
    Lanes faces = lanes(kind + x) & ~lanes_anywhere(hidden + x);
    if (sweep.own_id_hides) faces &= ~lanes_anywhere(same + x);
    lanes(layer.face + x) = faces;
    any |= faces;
  }
  const std::uint64_t all = combined(any);
  layer.any = all != 0;
  if (!layer.any) return;
  sweep.extent.z |= all;
  sweep.extent.y |= std::uint64_t{1} << y;
  sweep.extent.x |= nonzero_words(layer.face);
}

// Runs along z, which is along the bits of a word.
SKERRY_MESH_TARGET inline void find_bit_runs(const Sweep& sweep, int y, Layer& layer) {
  const std::uint64_t* same_z = sweep.planes.same_z.row(y);
  for (int x = 0; x < kEdge; x += kLanes) {
    const Lanes face = lanes(layer.face + x);
    const Lanes link = face & (face >> 1) & lanes(same_z + x);
    lanes(layer.link + x) = link;
    lanes(layer.start + x) = face & ~(link << 1);
    lanes(layer.end + x) = face & ~link;
  }
}

SKERRY_MESH_TARGET inline void clear_runs(Layer& layer) {
  for (int x = 0; x < kEdge; x += kLanes) {
    lanes(layer.link + x) = lanes(layer.start + x) = lanes(layer.end + x) = Lanes{};
  }
}

// What a step along the merge direction decides, for one layer.
struct alignas(64) Step {
  alignas(64) std::uint64_t begun[kEdge];     // ends of runs that the row before did not have
  alignas(64) std::uint64_t finished[kEdge];  // ends of runs that the next row does not have
  alignas(64) std::uint64_t visit[kEdge];     // rows with anything to do are not 0
};

// x faces: runs along z (u), equal runs merge along y (v).
SKERRY_MESH_TARGET inline void sweep_x(Sweep& sweep) {
  alignas(64) std::uint8_t first_y[kEdge][kEdge];  // by x and the run's end
  alignas(64) std::uint64_t carried[kEdge] = {};   // ends of runs that go on from the layer below
  Layer layers[2];
  Step step;
  load_faces(sweep, 0, layers[0]);
  if (layers[0].any) find_bit_runs(sweep, 0, layers[0]);
  for (int y = 0; y < kEdge; ++y) {
    const Layer& here = layers[y & 1];
    Layer& next = layers[~y & 1];
    next.any = false;
    if (y + 1 < kEdge) load_faces(sweep, y + 1, next);
    if (next.any) {
      find_bit_runs(sweep, y + 1, next);
    } else {
      clear_runs(next);
    }
    if (!here.any) continue;
    const std::uint64_t* same_y = sweep.planes.same_y.row(y);
    for (int x = 0; x < kEdge; x += kLanes) {
      // A run repeats when it starts, links and ends alike in both rows and has one id. Adding its
      // start bit carries through the common links and reaches the end bit exactly then.
      const Lanes starts = lanes(here.start + x) & lanes(next.start + x) & lanes(same_y + x);
      const Lanes links = lanes(here.link + x) & lanes(next.link + x);
      const Lanes end = lanes(here.end + x);
      const Lanes repeats = (starts + links) & end & lanes(next.end + x);
      const Lanes begun = end & ~lanes(carried + x);
      lanes(step.begun + x) = begun;
      lanes(step.finished + x) = end & ~repeats;
      lanes(step.visit + x) = begun | (end & ~repeats);
      lanes(carried + x) = repeats;
    }
    shared::Quad* out = sweep.sink.reserve(kEdge * kEdge);
    const shared::Quad* const begin = out;
    Emission emission(*sweep.voxels.table, sweep.face, 64u - (1u << 24), 4096u - (1u << 18),
                      1u << 18);
    for (std::uint64_t rows = nonzero_words(step.visit); rows != 0; rows &= rows - 1) {
      const int x = __builtin_ctzll(rows);
      set_bytes(first_y[x], step.begun[x], static_cast<std::uint8_t>(y));
      emission.base = static_cast<std::uint32_t>(x | y << 24);
      emission.bytes = sweep.voxels.row(x, y);
      out += emit_runs(out, emission, step.finished[x], here.start[x], here.end[x], first_y[x]);
    }
    sweep.sink.count += static_cast<std::size_t>(out - begin);
  }
}

// y faces: runs along z (v), equal runs merge along x (u).
SKERRY_MESH_TARGET inline void sweep_y(Sweep& sweep) {
  alignas(64) std::uint8_t first_x[kEdge];  // by the run's end
  Layer here;
  Step step;
  Carried carried;
  for (int y = 0; y < kEdge; ++y) {
    load_faces(sweep, y, here);
    if (!here.any) continue;
    find_bit_runs(sweep, y, here);
    const std::uint64_t* same_x = sweep.planes.same_x.row(y);
    for (int x = 0; x < kEdge; x += kLanes) {
      const Lanes starts =
          lanes(here.start + x) & lanes_anywhere(here.start + x + 1) & lanes(same_x + x);
      const Lanes links = lanes(here.link + x) & lanes_anywhere(here.link + x + 1);
      lanes(carried.at(x)) =
          (starts + links) & lanes(here.end + x) & lanes_anywhere(here.end + x + 1);
    }
    for (int x = 0; x < kEdge; x += kLanes) {
      const Lanes end = lanes(here.end + x);
      const Lanes begun = end & ~lanes_anywhere(carried.at(x) - 1);
      const Lanes finished = end & ~lanes(carried.at(x));
      lanes(step.begun + x) = begun;
      lanes(step.finished + x) = finished;
      lanes(step.visit + x) = begun | finished;
    }
    shared::Quad* out = sweep.sink.reserve(kEdge * kEdge);
    const shared::Quad* const begin = out;
    Emission emission(*sweep.voxels.table, sweep.face, 1u - (1u << 18), 4096u - (1u << 24),
                      1u << 24);
    for (std::uint64_t rows = nonzero_words(step.visit); rows != 0; rows &= rows - 1) {
      const int x = __builtin_ctzll(rows);
      set_bytes(first_x, step.begun[x], static_cast<std::uint8_t>(x));
      emission.base = static_cast<std::uint32_t>(x << 18 | y << 6);
      emission.bytes = sweep.voxels.row(x, y);
      out += emit_runs(out, emission, step.finished[x], here.start[x], here.end[x], first_x);
    }
    sweep.sink.count += static_cast<std::size_t>(out - begin);
  }
}

// z faces: each bit is a slice of its own; runs along y (v), equal runs merge along x (u).
SKERRY_MESH_TARGET inline void sweep_z(Sweep& sweep) {
  alignas(64) std::uint8_t first_y[kEdge][kEdge];  // by x and z: where the run began
  alignas(64) std::uint8_t first_x[kEdge];         // by z: where the quad that ends here began
  alignas(64) std::uint64_t equal[kEdge] = {};     // so far the run equals the one at x + 1
  Layer layers[2];                                 // faces and links; starts and ends of `here`
  Step step;
  Carried carried;
  load_faces(sweep, 0, layers[0]);
  for (int y = 0; y < kEdge; ++y) {
    Layer& here = layers[y & 1];
    Layer& other = layers[~y & 1];  // holds the links from below, then the faces above
    const std::uint64_t* same_y = sweep.planes.same_y.row(y);
    const std::uint64_t* same_x = sweep.planes.same_x.row(y);
    if (y + 1 < kEdge) {
      load_faces(sweep, y + 1, other);
    } else {
      for (int x = 0; x < kEdge; x += kLanes) lanes(other.face + x) = Lanes{};
    }
    if (!here.any) {
      for (int x = 0; x < kEdge; x += kLanes) lanes(here.link + x) = Lanes{};
      continue;
    }
    for (int x = 0; x < kEdge; x += kLanes) {
      const Lanes face = lanes(here.face + x);
      const Lanes link = face & lanes(other.face + x) & lanes(same_y + x);
      lanes(here.link + x) = link;
      lanes(here.start + x) = face & ~lanes(other.link + x);
      lanes(here.end + x) = face & ~link;
    }
    for (int x = 0; x < kEdge; x += kLanes) {
      const Lanes begins =
          lanes(here.start + x) & lanes_anywhere(here.start + x + 1) & lanes(same_x + x);
      const Lanes goes_on =
          lanes(equal + x) & lanes(other.link + x) & lanes_anywhere(other.link + x + 1);
      lanes(equal + x) = begins | goes_on;
      lanes(carried.at(x)) =
          (begins | goes_on) & lanes(here.end + x) & lanes_anywhere(here.end + x + 1);
    }
    for (int x = 0; x < kEdge; x += kLanes) {
      const Lanes end = lanes(here.end + x);
      const Lanes begun = end & ~lanes_anywhere(carried.at(x) - 1);
      const Lanes finished = end & ~lanes(carried.at(x));
      lanes(step.begun + x) = begun;
      lanes(step.finished + x) = finished;
      lanes(step.visit + x) = begun | finished | lanes(here.start + x);
    }
    shared::Quad* out = sweep.sink.reserve(kEdge * kEdge);
    const shared::Quad* const begin = out;
    Emission emission(*sweep.voxels.table, sweep.face, 1u - (1u << 18), 64u - (1u << 24), 4096u);
    for (std::uint64_t rows = nonzero_words(step.visit); rows != 0; rows &= rows - 1) {
      const int x = __builtin_ctzll(rows);
      set_bytes(first_y[x], here.start[x], static_cast<std::uint8_t>(y));
      set_bytes(first_x, step.begun[x], static_cast<std::uint8_t>(x));
      emission.base = static_cast<std::uint32_t>(x << 18 | y << 24);
      emission.bytes = sweep.voxels.row(x, y);
      out += emit_columns(out, emission, step.finished[x], first_x, first_y[x]);
    }
    sweep.sink.count += static_cast<std::size_t>(out - begin);
  }
}

SKERRY_MESH_TARGET Extent mesh_face(const Planes& planes, const Plane& kind, bool own_id_hides,
                                    unsigned face, const Voxels& voxels, QuadSink& sink) {
  Sweep sweep{planes, kind, own_id_hides, face, voxels, sink, {}};
  switch (face / 2) {
    case 0:
      sweep_x(sweep);
      break;
    case 1:
      sweep_y(sweep);
      break;
    default:
      sweep_z(sweep);
      break;
  }
  return sweep.extent;
}

SKERRY_MESH_TARGET bool narrow(std::span<const BlockId> ids, std::uint8_t* bytes,
                               BlockId& largest) {
  unsigned seen = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(ids[i]);
    seen |= ids[i];
  }
  largest = static_cast<BlockId>(seen);
  return seen < 256;
}

}  // namespace
}  // namespace skerry::world::mesh_detail
