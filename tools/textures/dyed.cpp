// Materials that come in every dye.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {

Canvas paint_wool(Color dye, std::uint32_t seed) {
  // Knit: columns of V stitches, four texels wide and four high, softened by loose fibres.
  const Field fuzz = even_fbm({10, 10}, 2, seed);
  return paint(ramp(dye, 0.5f), make_field([&](int x, int y) {
                 const int column = x % 4, lean = column < 2 ? column : 3 - column;
                 const int row = (y + lean) % 4;
                 const float stitch = row == 0 ? -0.22f : row == 1 ? 0.14f : 0.02f;
                 const float groove = column == 0 || column == 3 ? -0.05f : 0.05f;
                 return 0.5f + stitch + groove + 0.22f * (fuzz.at(x, y) - 0.5f);
               }),
               9);
}

Canvas paint_glazed_tile(Color dye, std::uint32_t seed) {
  // Pale glazes get a dark ornament, dark ones a pale one.
  const Color accent =
      dye.g > 0.6f ? mix(dye, hex(0x4f5f78), 0.55f) : mix(dye, hex(0xeee6d6), 0.62f);
  const Ramp glaze = ramp(dye, 0.55f), ornament = ramp(accent, 0.5f);
  const Field cloud = even_fbm({4, 4}, 2, seed);
  const int motif = static_cast<int>(seed % 4u);
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      // One quarter is drawn and mirrored; i and j count from the middle of the block.
      const int i = x < 16 ? 15 - x : x - 16, j = y < 16 ? 15 - y : y - 16;
      const int diamond = i + j, square = std::max(i, j), round = i * i + j * j,
                corner = (15 - i) * (15 - i) + (15 - j) * (15 - j);
      bool marked = false;
      switch (motif) {
        case 0:
          marked = diamond == 9 || diamond == 10 || (diamond < 5 && diamond > 1) || corner < 26;
          break;
        case 1:
          marked = (round > 60 && round < 95) || (corner > 40 && corner < 72) || round < 10;
          break;
        case 2:
          marked = square == 10 || square == 11 || diamond < 4 || (i == j && square > 5);
          break;
        default:
          marked = (i * j < 9 && square < 11 && square > 2) || corner < 40;
          break;
      }
      const bool grout = square == 15;
      const float bevel = square == 14 ? (x + y < kEdge ? 0.14f : -0.14f) : 0.0f;
      const float tone = 0.5f + bevel + 0.16f * (cloud.at(x, y) - 0.5f);
      canvas.set(x, y,
                 grout    ? mix(dye * 0.5f, hex(0x8b857c), 0.5f)
                 : marked ? ornament.at(tone)
                          : glaze.at(tone));
    }
  }
  return canvas;
}

Canvas paint_plaster(Color dye, std::uint32_t seed) {
  // Trowel marks: broad, shallow arcs.
  Field tone = make_field([](int, int) { return 0.5f; });
  Random random(seed);
  for (int i = 0; i < 70; ++i) {
    const auto [center_x, center_y] = spread_point(i, seed);
    const Dab mark{center_x, center_y, direction(random.range(0.0f, 0.2f)), random.range(3, 6),
                   random.range(1.2f, 2.2f)};
    const float level = random.range(0.42f, 0.58f);
    for_dab(mark, [&](int x, int y, float, float v) { tone.at(x, y) = level - 0.09f * v; });
  }
  return paint(ramp(mix(dye, hex(0xcfc8bb), 0.22f), 0.4f), flatten(tone, 0.8f), 11);
}

Canvas paint_terracotta(Color dye, std::uint32_t seed) {
  const Field tone = brush({100, 2.5f, 5.5f, 0.3f, -0.04f, 0.04f, 0.1f}, seed);
  return paint(ramp(mix(dye, hex(0x9a5f45), 0.45f), 0.45f),
               flatten(make_field([&](int x, int y) {
                         const float turn = noise_at(x, y, {2, 16}, seed + 1);
                         return tone.at(x, y) + 0.16f * turn;
                       }),
                       0.8f),
               9);
}

Canvas paint_sailcloth(Color dye, std::uint32_t seed) {
  const Field fold = even_fbm({3, 2}, 2, seed);
  return paint(ramp(dye, 0.4f),
               flatten(make_field([&](int x, int y) {
                         // Plain weave: over and under alternate; a seam every half block.
                         const float weave = (x / 2 + y / 2) % 2 == 0 ? 0.06f : -0.06f;
                         const float seam = x % 16 == 0 ? -0.2f : x % 16 == 1 ? 0.1f : 0.0f;
                         return 0.5f + weave + seam + 0.16f * (fold.at(x, y) - 0.5f);
                       }),
                       0.7f),
               9);
}

}  // namespace skerry::textures
