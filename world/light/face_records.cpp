#include "world/light/face_records.h"

#include <array>
#include <bit>

#include "shaders/shared/occupancy.h"

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

}  // namespace

ChunkSky pack_faces(std::span<const shared::Quad> quads, const AppendRecord& append) {
  std::vector<std::uint32_t> slots(shared::kBricksPerChunk, 0);
  std::vector<BrickFaces> bricks;
  for (const shared::Quad& quad : quads)
    for_each_face(quad, [&](const DrawnFace& face) {
      std::uint32_t& slot = slots[brick_index(face.voxel)];
      if (slot == 0) {
        bricks.emplace_back();
        slot = static_cast<std::uint32_t>(bricks.size());
      }
      BrickFaces& brick = bricks[slot - 1];
      const std::size_t word = word_of(face.voxel);
      brick.masks[static_cast<std::size_t>(face.direction)][word] |= 1u << bit_of(face.voxel);
      if (face.plant) brick.plants[word] |= 1u << bit_of(face.voxel);
    });
  ChunkSky out;
  out.table.assign(shared::kBricksPerChunk, 0);
  out.texels.assign(bricks.size() * shared::kIndirectBrickTexels, glm::uvec4(0));
  std::size_t stored = 0;
  for (std::size_t at = 0; at < shared::kBricksPerChunk; ++at) {
    if (slots[at] == 0) continue;
    const BrickFaces& brick = bricks[slots[at] - 1];
    const std::size_t first = stored++ * shared::kIndirectBrickTexels;
    out.table[at] = static_cast<std::uint32_t>(stored);
    for (std::size_t direction = 0; direction < 6; ++direction)
      for (std::size_t word = 0; word < 16; ++word) {
        const std::uint32_t mask = brick.masks[direction][word];
        const std::size_t texel = first + direction * 8 + word / 2;
        const auto half = static_cast<int>(word % 2);
        out.texels[texel][half] = mask;
        out.texels[texel][2 + half] = static_cast<std::uint32_t>(out.texels.size());
        for (std::uint32_t left = mask; left != 0; left &= left - 1) {
          const int bit = std::countr_zero(left);
          const bool plant = direction == 2 && (brick.plants[word] >> bit & 1u) != 0;
          append({voxel_at(at, word, bit), static_cast<int>(direction), plant}, out.texels);
        }
      }
  }
  return out;
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
  return masks[2 + half] + shared::kIndirectRecordTexels *
                               static_cast<std::size_t>(std::popcount(masks[half] & (bit - 1)));
}

namespace {

std::optional<std::size_t> nearest_record(const ChunkSky& chunk, const DrawnFace& face) {
  if (const auto own = find_record(chunk, face.voxel, face.direction)) return own;
  std::optional<std::size_t> best;
  int least = 1 << 20;
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x)
      for (int z = -2; z <= 2; ++z)
        for (int direction = 0; direction < 6; ++direction) {
          const int away = x * x + y * y + z * z + (direction == face.direction ? 0 : 100);
          if (away >= least) continue;
          const auto found = find_record(chunk, face.voxel + IVec3{x, y, z}, direction);
          if (found) best = found, least = away;
        }
  return best;
}

}  // namespace

std::vector<shared::Quad> lit_faces(const ChunkSky& before, std::span<const shared::Quad> quads) {
  const auto is_lit = [&](IVec3 voxel) {
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        for (int z = -1; z <= 1; ++z) {
          if (x * x + y * y + z * z > 2) continue;
          for (int direction = 0; direction < 6; ++direction)
            if (find_record(before, voxel + IVec3{x, y, z}, direction)) return true;
        }
    return false;
  };
  std::vector<shared::Quad> out;
  for (const shared::Quad& quad : quads)
    for_each_face(quad, [&](const DrawnFace& face) {
      if (!is_lit(face.voxel)) return;
      const IVec3 at = face.voxel;
      out.push_back({static_cast<std::uint32_t>(at.x | at.y << 6 | at.z << 12), quad.material});
    });
  return out;
}

ChunkSky inherit_faces(const ChunkSky& before, std::span<const shared::Quad> quads) {
  return pack_faces(quads, [&](const DrawnFace& face, std::vector<glm::uvec4>& texels) {
    const std::optional<std::size_t> from = nearest_record(before, face);
    for (std::size_t i = 0; i < shared::kIndirectRecordTexels; ++i)
      texels.push_back(from ? before.texels[*from + i] : glm::uvec4(0));
  });
}

}  // namespace skerry::world
