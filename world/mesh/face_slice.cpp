#include "world/mesh/face_slice.h"

#include <algorithm>

#include "world/mesh/face_axes.h"

namespace skerry::world {
namespace {

struct Rectangle {
  int u, v, along_u, along_v;
};

std::uint32_t packed(std::uint32_t face, int plane, const Rectangle& place) {
  const auto [normal, u, v] = axes_of_face(face);
  std::array<int, 3> low{};
  low[normal] = plane;
  low[u] = place.u;
  low[v] = place.v;
  const auto bits = [](int value, int shift) { return static_cast<std::uint32_t>(value) << shift; };
  return bits(low[0], 0) | bits(low[1], 6) | bits(low[2], 12) | bits(place.along_u - 1, 18) |
         bits(place.along_v - 1, 24);
}

}  // namespace

bool FaceSlice::is_run(int u, int v, int count, BlockId id) const {
  const auto first = ids_.begin() + static_cast<std::ptrdiff_t>(index(u, v));
  return std::all_of(first, first + count, [id](BlockId other) { return other == id; });
}

void FaceSlice::merge(std::uint32_t face, int plane, int u_end, int v_end,
                      std::vector<shared::Quad>& out) {
  for (int v = 0; v < v_end; ++v) {
    for (int u = 0; u < u_end; ++u) {
      const BlockId id = ids_[index(u, v)];
      if (id == kAir) continue;
      Rectangle place{u, v, 1, 1};
      while (u + place.along_u < u_end && ids_[index(u + place.along_u, v)] == id) ++place.along_u;
      while (v + place.along_v < v_end && is_run(u, v + place.along_v, place.along_u, id))
        ++place.along_v;
      for (int j = 0; j < place.along_v; ++j)
        std::fill_n(ids_.begin() + static_cast<std::ptrdiff_t>(index(u, v + j)), place.along_u,
                    kAir);
      out.push_back({packed(face, plane, place), id | face << shared::kFaceShift});
    }
  }
}

}  // namespace skerry::world
