// Blocks of leaves: cut out, seen from outside as layered foliage.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {
namespace {

// Leaves are put on until this share of the texture is covered.
constexpr float kCover = 0.75f;

struct Shape {
  float length_low, length_high, flatness;
  float turn_low, turn_high;  // of direction()
};

Shape shape_of(Leaf leaf) {
  switch (leaf) {
    case Leaf::kNeedle:
      return {2.2f, 3.2f, 0.24f, 0.0f, 1.0f};
    case Leaf::kFrond:
      return {4.5f, 6.5f, 0.17f, 0.05f, 0.45f};
    case Leaf::kWillow:
      return {3.4f, 5.2f, 0.26f, 0.2f, 0.3f};
    case Leaf::kBlossom:
      return {1.7f, 2.5f, 0.85f, 0.0f, 1.0f};
    default:
      return {2.2f, 3.4f, 0.58f, 0.0f, 1.0f};
  }
}

}  // namespace

Canvas paint_leaves(Color base, Color other, Leaf leaf, std::uint32_t seed) {
  const Shape shape = shape_of(leaf);
  const Ramp first = ramp(base, 0.72f), second = ramp(other, 0.72f);
  Canvas canvas = empty_canvas();
  Random random(seed);
  int covered = 0;
  // Leaves keep to the flesh of the tile, so that the holes are few and round, not everywhere and
  // small.
  const Field flesh = equalize(flatten(even_fbm({5, 5}, 1, seed + 1), 0.6f));
  for (int i = 0; static_cast<float>(covered) < kCover * kTexels; ++i) {
    const float depth = static_cast<float>(covered) / (kCover * kTexels);
    const auto [center_x, center_y] = spread_point(i, seed);
    Dab dab{center_x, center_y, direction(random.range(shape.turn_low, shape.turn_high)), 0, 0};
    dab.half_length = random.range(shape.length_low, shape.length_high);
    dab.half_width = std::max(0.6f, dab.half_length * shape.flatness);
    const float tone = 0.2f + 0.36f * depth + random.range(-0.07f, 0.1f), share = random.next();
    if (flesh.at(static_cast<int>(dab.x), static_cast<int>(dab.y)) < 0.3f) continue;
    // Needles stand in sprays, other leaves alone.
    const int parts = leaf == Leaf::kNeedle ? 5 : 1;
    const float turn = random.next();
    for (int part = 0; part < parts; ++part) {
      Dab blade = dab;
      if (parts > 1) {
        blade.along = direction(turn + 0.075f * static_cast<float>(part));
        blade.x += blade.along.x * dab.half_length * 0.8f;
        blade.y += blade.along.y * dab.half_length * 0.8f;
      }
      for_dab(blade, [&](int x, int y, float u, float v) {
        const float dx = static_cast<float>(x) + 0.5f - dab.x,
                    dy = static_cast<float>(y) + 0.5f - dab.y;
        const float rib = leaf == Leaf::kRound && v * v < 0.05f && u < 0.7f ? 0.1f : 0.0f;
        const float light = tone - 0.11f * (dx + dy) / dab.half_length + rib;
        covered += canvas.at(x, y).alpha == 0.0f ? 1 : 0;
        canvas.set(x, y, mix(first.at(light), second.at(light), share));
      });
    }
  }
  return canvas;
}

}  // namespace skerry::textures
