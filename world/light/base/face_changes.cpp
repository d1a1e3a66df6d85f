#include "world/light/base/face_changes.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace skerry::world {
namespace {

using Quads = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // geometry, material

std::array<Quads, 8> by_face(std::span<const shared::Quad> quads) {
  std::array<Quads, 8> out;
  for (const shared::Quad& quad : quads)
    out[shared::surface_face(quad.material)].emplace_back(quad.geometry, quad.material);
  return out;
}

/// Takes out of both what they have in common.
void keep_differing(Quads& a, Quads& b) {
  const auto start = std::ranges::mismatch(a, b);
  a.erase(a.begin(), start.in1);
  b.erase(b.begin(), start.in2);
  while (!a.empty() && !b.empty() && a.back() == b.back()) a.pop_back(), b.pop_back();
  std::ranges::sort(a);
  std::ranges::sort(b);
  Quads only_a, only_b;
  std::ranges::set_difference(a, b, std::back_inserter(only_a));
  std::ranges::set_difference(b, a, std::back_inserter(only_b));
  a = std::move(only_a), b = std::move(only_b);
}

/// Ascending and unique by place: a plant has two quads.
struct PlacedFace {
  std::uint32_t place = 0;
  BlockFace face{};
};
std::vector<PlacedFace> faces_of(const Quads& quads) {
  std::vector<PlacedFace> out;
  for (const auto& [geometry, material] : quads)
    for_each_face(
        {geometry, material}, [&, block = shared::surface_block(material)](const DrawnFace& drawn) {
          const auto place =
              static_cast<std::uint32_t>(drawn.voxel.z | drawn.voxel.x << 6 | drawn.voxel.y << 12);
          out.push_back({place, {drawn, static_cast<std::uint16_t>(block)}});
        });
  std::ranges::stable_sort(out, {}, &PlacedFace::place);
  const auto twice = std::ranges::unique(out, {}, &PlacedFace::place);
  out.erase(twice.begin(), twice.end());
  return out;
}

}  // namespace

FaceChanges face_changes(std::span<const shared::Quad> before, std::span<const shared::Quad> now) {
  std::array<Quads, 8> old_quads = by_face(before), new_quads = by_face(now);
  FaceChanges out;
  for (std::size_t face = 0; face < old_quads.size(); ++face) {
    keep_differing(old_quads[face], new_quads[face]);
    const std::vector<PlacedFace> old_faces = faces_of(old_quads[face]),
                                  new_faces = faces_of(new_quads[face]);
    auto o = old_faces.begin();
    for (const PlacedFace& n : new_faces) {
      for (; o != old_faces.end() && o->place < n.place; ++o) out.went.push_back(o->face);
      if (o == old_faces.end() || o->place != n.place) {
        out.came.push_back(n.face);
        continue;
      }
      if (o->face.block != n.face.block) out.turned.push_back(n.face);
      ++o;
    }
    for (; o != old_faces.end(); ++o) out.went.push_back(o->face);
  }
  return out;
}

}  // namespace skerry::world
