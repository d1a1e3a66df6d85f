#include "world/light/base/face_records.h"

#include <algorithm>
#include <array>
#include <bit>

#include "shaders/shared/occupancy.h"
#include "world/light/base/shared_exponent.h"

namespace skerry::world {
namespace {

/// The faces of a brick, a bit each.
struct BrickFaces {
  std::array<std::array<std::uint32_t, 16>, 6> masks{};  // by direction; word 2 y + (x >= 4)
  std::array<std::uint32_t, 16> plants{};                // alike
};

std::size_t brick_index(IVec3 voxel) {
  return static_cast<std::size_t>(voxel.z / 8 + voxel.x / 8 * 8 + voxel.y / 8 * 64);
}
std::size_t word_of(IVec3 voxel) {
  return static_cast<std::size_t>(2 * (voxel.y & 7) + (voxel.x >> 2 & 1));
}
int bit_of(IVec3 voxel) {
  return (voxel.z & 7) + 8 * (voxel.x & 3);
}
IVec3 voxel_at(std::size_t brick, std::size_t word, int bit) {
  const auto b = static_cast<int>(brick), w = static_cast<int>(word);
  return {(b >> 3 & 7) * 8 + w % 2 * 4 + bit / 8, (b >> 6) * 8 + w / 2, (b & 7) * 8 + bit % 8};
}

/// Faces of a chunk by brick.
class FacesByBrick {
 public:
  void add(const DrawnFace& face) {
    std::uint32_t& slot = slots_[brick_index(face.voxel)];
    if (slot == 0) {
      bricks_.emplace_back();
      slot = static_cast<std::uint32_t>(bricks_.size());
    }
    BrickFaces& brick = bricks_[slot - 1];
    const std::size_t word = word_of(face.voxel);
    brick.masks[static_cast<std::size_t>(face.direction)][word] |= 1u << bit_of(face.voxel);
    if (face.plant) brick.plants[word] |= 1u << bit_of(face.voxel);
  }
  std::size_t count() const { return bricks_.size(); }
  /// Null: it has none.
  const BrickFaces* of(std::size_t brick) const {
    return slots_[brick] == 0 ? nullptr : &bricks_[slots_[brick] - 1];
  }

 private:
  std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(shared::kBricksPerChunk, 0);
  std::vector<BrickFaces> bricks_;
};

}  // namespace

namespace {

/// @param before null, or where faces that have a record there find it: in place of append().
ChunkSky pack(std::span<const shared::Quad> quads, const ChunkSky* before,
              const AppendRecord& append, const RecordParts& parts) {
  const std::size_t record = parts.texels();
  FacesByBrick faces;
  for (const shared::Quad& quad : quads)
    for_each_face(quad, [&](const DrawnFace& face) { faces.add(face); });
  ChunkSky out;
  out.parts = parts;
  out.table.assign(shared::kBricksPerChunk, 0);
  if (before) out.texels.reserve(before->texels.size() + before->texels.size() / 16);
  out.texels.assign(faces.count() * shared::kIndirectBrickTexels, glm::uvec4(0));
  const auto copy = [&](std::size_t from, std::size_t texels) {
    const auto start = before->texels.begin() + static_cast<std::ptrdiff_t>(from);
    out.texels.insert(out.texels.end(), start, start + static_cast<std::ptrdiff_t>(texels));
  };
  std::size_t stored = 0;
  for (std::size_t at = 0; at < shared::kBricksPerChunk; ++at) {
    if (faces.of(at) == nullptr) continue;
    const BrickFaces& brick = *faces.of(at);
    const std::size_t first = stored++ * shared::kIndirectBrickTexels;
    const std::uint32_t old_brick = before ? before->table[at] : 0;
    out.table[at] = static_cast<std::uint32_t>(stored);
    for (std::size_t direction = 0; direction < 6; ++direction)
      for (std::size_t word = 0; word < 16; ++word) {
        const std::uint32_t mask = brick.masks[direction][word];
        const std::size_t in_brick = direction * 8 + word / 2;
        const auto half = static_cast<int>(word % 2);
        out.texels[first + in_brick][half] = mask;
        out.texels[first + in_brick][2 + half] = static_cast<std::uint32_t>(out.texels.size());
        if (mask == 0) continue;
        glm::uvec4 old(0);
        if (old_brick != 0)
          old = before->texels[(old_brick - 1) * shared::kIndirectBrickTexels + in_brick];
        if (old[half] == mask) {
          copy(old[2 + half], record * static_cast<std::size_t>(std::popcount(mask)));
          continue;
        }
        for (std::uint32_t left = mask; left != 0; left &= left - 1) {
          const int bit = std::countr_zero(left);
          const std::uint32_t one = 1u << bit;
          if ((old[half] & one) != 0) {
            const int earlier = std::popcount(old[half] & (one - 1));
            copy(old[2 + half] + record * static_cast<std::size_t>(earlier), record);
            continue;
          }
          const bool plant = direction == 2 && (brick.plants[word] & one) != 0;
          append({voxel_at(at, word, bit), static_cast<int>(direction), plant}, out.texels);
        }
      }
  }
  return out;
}

}  // namespace

glm::uvec4 white_tint() {
  return glm::uvec4(pack_shared_exponent(glm::vec3(1.0f)));
}

ChunkSky with_tints(const ChunkSky& before, bool all) {
  const auto masks_end = static_cast<std::size_t>(std::ranges::max(before.table)) *
                         std::size_t{shared::kIndirectBrickTexels};
  const std::size_t plain = before.parts.before_tint(), old = before.record_texels();
  bool any = all;
  for (std::size_t at = masks_end; at < before.texels.size() && old > plain && !any; at += old)
    any = before.texels[at + plain] != white_tint();
  const std::size_t now = any ? plain + 1 : plain;
  if (now == old) return before;
  ChunkSky out{before.table, {}, {before.parts.keyed, any}};
  out.texels.reserve(masks_end + (before.texels.size() - masks_end) / old * now);
  out.texels.assign(before.texels.begin(),
                    before.texels.begin() + static_cast<std::ptrdiff_t>(masks_end));
  for (glm::uvec4& masks : out.texels)
    for (const int half : {2, 3})
      masks[half] = static_cast<std::uint32_t>(masks_end + (masks[half] - masks_end) / old * now);
  for (std::size_t at = masks_end; at < before.texels.size(); at += old) {
    const auto record = before.texels.begin() + static_cast<std::ptrdiff_t>(at);
    out.texels.insert(out.texels.end(), record, record + static_cast<std::ptrdiff_t>(plain));
    if (any) out.texels.push_back(white_tint());
  }
  return out;
}

ChunkSky pack_faces(std::span<const shared::Quad> quads, const AppendRecord& append,
                    const RecordParts& parts) {
  return pack(quads, nullptr, append, parts);
}

ChunkSky repack_faces(const ChunkSky& before, std::span<const shared::Quad> quads,
                      const AppendRecord& append) {
  return pack(quads, &before, append, before.parts);
}

void for_each_record(const ChunkSky& chunk,
                     const std::function<void(IVec3, int, std::size_t)>& fn) {
  for (std::size_t at = 0; at < shared::kBricksPerChunk; ++at) {
    if (chunk.table[at] == 0) continue;
    const std::size_t first = (chunk.table[at] - 1) * std::size_t{shared::kIndirectBrickTexels};
    for (std::size_t direction = 0; direction < 6; ++direction)
      for (std::size_t word = 0; word < 16; ++word) {
        const glm::uvec4& masks = chunk.texels[first + direction * 8 + word / 2];
        const auto half = static_cast<int>(word % 2);
        std::size_t record = masks[2 + half];
        for (std::uint32_t left = masks[half]; left != 0; left &= left - 1) {
          fn(voxel_at(at, word, std::countr_zero(left)), static_cast<int>(direction), record);
          record += chunk.record_texels();
        }
      }
  }
}

std::optional<std::size_t> find_record(const ChunkSky& chunk, IVec3 voxel, int direction) {
  for (const int v : {voxel.x, voxel.y, voxel.z})
    if (v < 0 || v >= static_cast<int>(shared::kChunkEdge)) return std::nullopt;
  const std::uint32_t brick = chunk.table[brick_index(voxel)];
  if (brick == 0) return std::nullopt;
  const std::size_t word = word_of(voxel);
  const glm::uvec4 masks = chunk.texels[(brick - 1) * shared::kIndirectBrickTexels +
                                        static_cast<std::size_t>(direction) * 8 + word / 2];
  const auto half = static_cast<int>(word % 2);
  const std::uint32_t bit = 1u << bit_of(voxel);
  if ((masks[half] & bit) == 0) return std::nullopt;
  return masks[2 + half] + std::size_t{chunk.record_texels()} *
                               static_cast<std::size_t>(std::popcount(masks[half] & (bit - 1)));
}

namespace {

constexpr int kGuessReach = 2;  // voxels

/// Steps to the voxels about one, the nearest first.
const std::vector<IVec3>& steps_around() {
  static const std::vector<IVec3> all = [] {
    std::vector<IVec3> steps;
    for (int y = -kGuessReach; y <= kGuessReach; ++y)
      for (int x = -kGuessReach; x <= kGuessReach; ++x)
        for (int z = -kGuessReach; z <= kGuessReach; ++z) steps.push_back({x, y, z});
    std::ranges::stable_sort(steps, {}, [](const IVec3& step) {
      return step.x * step.x + step.y * step.y + step.z * step.z;
    });
    return steps;
  }();
  return all;
}

std::optional<std::size_t> nearest_record(const ChunkSky& chunk, const DrawnFace& face) {
  for (const IVec3& step : steps_around())
    if (const auto found = find_record(chunk, face.voxel + step, face.direction)) return found;
  for (const IVec3& step : steps_around())
    for (int direction = 0; direction < 6; ++direction)
      if (const auto found = find_record(chunk, face.voxel + step, direction)) return found;
  return std::nullopt;
}

/// The voxels of a chunk that have a face with a record: a word for each row along z.
class VoxelsWithRecords {
 public:
  explicit VoxelsWithRecords(const ChunkSky& chunk) : rows_(std::size_t{kEdge} * kEdge, 0) {
    for (std::size_t at = 0; at < shared::kBricksPerChunk; ++at) {
      if (chunk.table[at] == 0) continue;
      const std::size_t first = (chunk.table[at] - 1) * shared::kIndirectBrickTexels;
      for (std::size_t word = 0; word < 16; ++word) {
        std::uint32_t mask = 0;
        for (std::size_t direction = 0; direction < 6; ++direction)
          mask |= chunk.texels[first + direction * 8 + word / 2][static_cast<int>(word % 2)];
        const IVec3 voxel = voxel_at(at, word, 0);
        for (int x = 0; x < 4; ++x)
          rows_[index(voxel.x + x, voxel.y)] |= std::uint64_t{mask >> 8 * x & 255u} << voxel.z;
      }
    }
  }

  /// Whether a voxel is one of them, or shares an edge with one.
  bool near(IVec3 voxel) const {
    std::uint64_t found = 0;
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const int row_x = voxel.x + x, row_y = voxel.y + y;
        if (std::min(row_x, row_y) < 0 || std::max(row_x, row_y) >= kEdge) continue;
        const std::uint64_t row = rows_[index(row_x, row_y)];
        found |= x != 0 && y != 0 ? row : row | row << 1 | row >> 1;
      }
    return (found >> voxel.z & 1u) != 0;
  }

 private:
  static constexpr int kEdge = shared::kChunkEdge;
  static std::size_t index(int x, int y) { return static_cast<std::size_t>(x + kEdge * y); }
  std::vector<std::uint64_t> rows_;
};

}  // namespace

std::vector<shared::Quad> lit_faces(const ChunkSky& before, std::span<const shared::Quad> quads) {
  const VoxelsWithRecords lit(before);
  std::vector<shared::Quad> out;
  for (const shared::Quad& quad : quads)
    for_each_face(quad, [&](const DrawnFace& face) {
      if (!lit.near(face.voxel)) return;
      const IVec3 at = face.voxel;
      out.push_back({static_cast<std::uint32_t>(at.x | at.y << 6 | at.z << 12), quad.material});
    });
  return out;
}

ChunkSky inherit_faces(const ChunkSky& before, std::span<const shared::Quad> quads) {
  return repack_faces(before, quads, [&](const DrawnFace& face, std::vector<glm::uvec4>& texels) {
    const std::optional<std::size_t> from = nearest_record(before, face);
    for (std::size_t i = 0; i < before.record_texels(); ++i)
      texels.push_back(from ? before.texels[*from + i] : glm::uvec4(0));
  });
}

namespace {

/// Copies a stored brick with its records, which follow each other, to the end of a list.
/// @param from, to which of the stored bricks it is there and here, counted from 1.
void copy_brick(const ChunkSky& before, std::uint32_t from, std::uint32_t to,
                std::vector<glm::uvec4>& texels) {
  constexpr std::size_t kMasks = shared::kIndirectBrickTexels;
  const auto masks = before.texels.begin() + static_cast<std::ptrdiff_t>((from - 1) * kMasks);
  const glm::uvec4 last = masks[kMasks - 1];
  const std::uint32_t begin = masks[0].z;
  const std::uint32_t end =
      last.w + before.record_texels() * static_cast<std::uint32_t>(std::popcount(last.y));
  const std::uint32_t moved = static_cast<std::uint32_t>(texels.size()) - begin;  // may wrap
  for (std::size_t i = 0; i < kMasks; ++i)
    texels[(to - 1) * kMasks + i] =
        masks[static_cast<std::ptrdiff_t>(i)] + glm::uvec4(0, 0, moved, moved);
  const auto records = before.texels.begin();
  texels.insert(texels.end(), records + begin, records + end);
}

}  // namespace

ChunkSky with_faces(const ChunkSky& before, std::span<const shared::Quad> quads) {
  FacesByBrick fresh;
  for (const shared::Quad& quad : quads)
    for_each_face(quad, [&](const DrawnFace& face) {
      if (!find_record(before, face.voxel, face.direction)) fresh.add(face);
    });
  if (fresh.count() == 0) return before;
  ChunkSky out;
  out.parts = before.parts;
  out.table.assign(shared::kBricksPerChunk, 0);
  std::uint32_t stored = 0;
  for (std::size_t at = 0; at < shared::kBricksPerChunk; ++at)
    if (before.table[at] != 0 || fresh.of(at) != nullptr) out.table[at] = ++stored;
  out.texels.reserve(before.texels.size() + fresh.count() * shared::kIndirectBrickTexels);
  out.texels.assign(stored * shared::kIndirectBrickTexels, glm::uvec4(0));
  const auto append = [&](std::optional<std::size_t> record) {
    for (std::size_t i = 0; i < before.record_texels(); ++i)
      out.texels.push_back(record ? before.texels[*record + i] : glm::uvec4(0));
  };
  for (std::size_t at = 0; at < shared::kBricksPerChunk; ++at) {
    if (out.table[at] == 0) continue;
    if (fresh.of(at) == nullptr) {
      copy_brick(before, before.table[at], out.table[at], out.texels);
      continue;
    }
    for (std::size_t direction = 0; direction < 6; ++direction)
      for (std::size_t word = 0; word < 16; ++word) {
        const std::size_t in_brick = direction * 8 + word / 2;
        const auto half = static_cast<int>(word % 2);
        glm::uvec4 old(0);  // masks and first records, as pack_faces() has them
        if (before.table[at] != 0)
          old = before.texels[(before.table[at] - 1) * shared::kIndirectBrickTexels + in_brick];
        const std::uint32_t mask = old[half] | fresh.of(at)->masks[direction][word];
        glm::uvec4& now = out.texels[(out.table[at] - 1) * shared::kIndirectBrickTexels + in_brick];
        now[half] = mask;
        now[2 + half] = static_cast<std::uint32_t>(out.texels.size());
        std::size_t next = old[2 + half];
        for (std::uint32_t left = mask; left != 0; left &= left - 1) {
          const int bit = std::countr_zero(left);
          if ((old[half] >> bit & 1u) != 0) {
            append(next);
            next += before.record_texels();
          } else {
            append(nearest_record(before,
                                  {voxel_at(at, word, bit), static_cast<int>(direction), false}));
          }
        }
      }
  }
  return out;
}

}  // namespace skerry::world
