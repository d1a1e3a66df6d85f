#include "world/mesh/emitters.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr std::uint32_t kChunkBits = 6;  // of a coordinate in a chunk
constexpr std::uint32_t kCellBits = std::countr_zero(static_cast<std::uint32_t>(kEmitterCell));
constexpr int kFirstPlantFace = 6;

/// A face of a glowing voxel. `order` sorts by cell, then id, then voxel.
struct GlowingFace {
  std::uint64_t order = 0;
  std::uint32_t face = 0;
};

/// Coordinates as one number in the order y, x, z.
constexpr std::uint32_t packed(glm::uvec3 v) {
  return (v.y << kChunkBits | v.x) << kChunkBits | v.z;
}

std::uint64_t order_of(glm::uvec3 voxel, BlockId block) {
  const std::uint64_t group = std::uint64_t{packed(voxel >> kCellBits)} << 16 | block;
  return group << (3 * kChunkBits) | packed(voxel);
}

BlockId block_of(std::uint64_t order) {
  return static_cast<BlockId>(order >> (3 * kChunkBits));
}

/// What shines as one light: plants each for itself.
std::uint64_t group_of(std::uint64_t order) {
  return block_kind(block_of(order)) == BlockKind::kPlant ? order : order >> (3 * kChunkBits);
}

glm::uvec3 voxel_of(std::uint64_t order) {
  const auto v = static_cast<std::uint32_t>(order);
  constexpr std::uint32_t kMask = (1u << kChunkBits) - 1;
  return {v >> kChunkBits & kMask, v >> (2 * kChunkBits) & kMask, v & kMask};
}

std::uint32_t bits(std::uint32_t word, int first, int count) {
  return word >> first & ((1u << count) - 1);
}

/// Takes a quad apart into the faces of its voxels.
void add_faces(const shared::Quad& quad, BlockId block, std::vector<GlowingFace>& out) {
  const glm::uvec3 low{bits(quad.geometry, 0, 6), bits(quad.geometry, 6, 6),
                       bits(quad.geometry, 12, 6)};
  const std::uint32_t face = shared::surface_face(quad.material), axis = face / 2;
  const int u = axis == 0 ? 2 : 0, v = axis == 1 ? 2 : 1;
  const std::uint32_t along_u = bits(quad.geometry, 18, 6), along_v = bits(quad.geometry, 24, 6);
  for (std::uint32_t j = 0; j <= along_v; ++j) {
    for (std::uint32_t i = 0; i <= along_u; ++i) {
      glm::uvec3 voxel = low;
      voxel[u] += i;
      voxel[v] += j;
      out.push_back({order_of(voxel, block), face});
    }
  }
}

/// The middle of a face; a plant shines from its own middle.
glm::vec3 middle_of(const GlowingFace& face) {
  glm::vec3 middle = glm::vec3(voxel_of(face.order)) + 0.5f;
  if (face.face < kFirstPlantFace)
    middle[static_cast<int>(face.face / 2)] += face.face % 2 == 0 ? 0.5f : -0.5f;
  return middle;
}

glm::vec3 mean_middle(std::span<const GlowingFace> faces) {
  glm::vec3 sum(0.0f);
  for (const GlowingFace& face : faces) sum += middle_of(face);
  return sum / static_cast<float>(faces.size());
}

/// Within a block, where its faces do not shine on each other and its own voxel is the one to be
/// looked through: nine tenths of the way from its middle to that of its faces.
glm::vec3 place_in_voxel(std::span<const GlowingFace> faces) {
  constexpr float kTowardsFaces = 0.9f;
  const glm::vec3 middle = glm::vec3(voxel_of(faces.front().order)) + 0.5f;
  return middle + kTowardsFaces * (mean_middle(faces) - middle);
}

/// Ends of the runs of equal keys.
template <class Key>
std::size_t run_end(std::span<const GlowingFace> faces, std::size_t from, Key&& key) {
  std::size_t to = from + 1;
  while (to < faces.size() && key(faces[to].order) == key(faces[from].order)) ++to;
  return to;
}

float distance2(glm::vec3 a, glm::vec3 b) {
  const glm::vec3 d = a - b;
  return d.x * d.x + d.y * d.y + d.z * d.z;
}

bool by_distance(const std::pair<float, glm::vec3>& a, const std::pair<float, glm::vec3>& b) {
  return a.first < b.first;
}

Emitter emitter_of(std::span<const GlowingFace> group) {
  Emitter emitter;
  emitter.block = block_of(group.front().order);
  emitter.one_way =
      group.front().face < kFirstPlantFace &&
      std::all_of(group.begin(), group.end(),
                  [first = group.front().face](const GlowingFace& f) { return f.face == first; });
  const glm::vec3 middle = mean_middle(group);
  std::vector<std::pair<float, glm::vec3>> places;
  for (std::size_t from = 0, to = 0; from < group.size(); from = to) {
    to = run_end(group, from, [](std::uint64_t order) { return order; });
    const std::span<const GlowingFace> voxel = group.subspan(from, to - from);
    const bool plant = voxel.front().face >= kFirstPlantFace;
    emitter.faces = static_cast<std::uint16_t>(emitter.faces + (plant ? 1 : voxel.size()));
    const glm::vec3 place = place_in_voxel(voxel);
    places.emplace_back(distance2(place, middle), place);
  }
  constexpr float kRounding = 1e-4f;
  const float nearest = std::min_element(places.begin(), places.end(), by_distance)->first;
  std::erase_if(places, [=](const auto& place) { return place.first > nearest + kRounding; });
  const auto cell = static_cast<std::uint32_t>(group.front().order >> (3 * kChunkBits + 16));
  emitter.place = places[mix32(cell) % places.size()].second;
  return emitter;
}

}  // namespace

void find_emitters(const ChunkMesh& mesh, std::vector<Emitter>& out) {
  out.clear();
  const std::span<const BlockType> types = block_types();
  std::vector<GlowingFace> faces;
  for (const shared::Quad& quad : mesh.quads) {
    const auto block = static_cast<BlockId>(shared::surface_block(quad.material));
    if (block < types.size() && types[block].emission > 0.0f) add_faces(quad, block, faces);
  }
  std::sort(faces.begin(), faces.end(), [](const GlowingFace& a, const GlowingFace& b) {
    return a.order != b.order ? a.order < b.order : a.face < b.face;
  });
  const std::span<const GlowingFace> all(faces);
  for (std::size_t from = 0, to = 0; from < all.size(); from = to) {
    to = run_end(all, from, group_of);
    out.push_back(emitter_of(all.subspan(from, to - from)));
  }
}

}  // namespace skerry::world
