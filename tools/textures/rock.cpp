// Rock faces.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {
Field stone_tone(Cells cells, float strength, std::uint32_t seed) {
  const Field height = even_fbm(cells, 3, seed);
  const Field light = relief(height);
  return flatten(make_field([&](int x, int y) {
                   return 0.5f + strength * (light.at(x, y) + 0.35f * (height.at(x, y) - 0.5f));
                 }),
                 0.85f);
}

Canvas paint_stone(Color base, std::uint32_t seed) {
  const Field planes = brush({130, 2.2f, 5.2f, 0.42f, -0.09f, 0.05f, 0.13f}, seed);
  Canvas canvas = paint(ramp(base, 0.6f), planes, 9);
  // A few faint cracks, each with a lit lower lip.
  Random random(seed + 1);
  for (int i = 0; i < 7; ++i) {
    const auto [x, y] = spread_point(i, seed + 2);
    const float reach = random.range(2.0f, 5.0f);
    const float drop = random.range(-2.5f, 2.5f), bend = random.range(-1.5f, 1.5f);
    for_stroke({x, y, x + reach * 0.5f, y + drop * 0.5f + bend, x + reach, y + drop, 1.0f, 1.0f},
               [&](int px, int py, float t, float) {
                 canvas.tint(px, py, base * 0.5f, 0.34f - 0.2f * t);
                 canvas.tint(px, py + 1, mix(base, hex(0xfff3d6), 0.4f), 0.12f);
               });
  }
  return canvas;
}

Canvas paint_mossy(const Canvas& stone, std::uint32_t seed) {
  Canvas canvas = stone;
  const Canvas moss = paint_moss(hex(0x74804c), seed);
  const Field cover = flatten(even_fbm({5, 5}, 3, seed + 1), 0.85f);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      if (cover.at(x, y) > 0.56f)
        canvas.set(x, y, moss.at(x, y).color);
      else if (cover.at(x - 1, y - 1) > 0.56f)
        canvas.tint(x, y, hex(0x2a2a2c), 0.35f);
    }
  }
  return canvas;
}

Canvas paint_cobble(Color base, std::uint32_t seed) {
  const Field height = make_field([&](int x, int y) {
    const Cellular stone = cell_at(x, y, {4, 4}, 0.75f, seed);
    return std::min(1.0f, 2.2f * (stone.second - stone.nearest));
  });
  const Field light = relief(height);
  const Field grain = stone_tone({6, 6}, 0.18f, seed + 1);
  return paint(ramp(base, 0.7f), make_field([&](int x, int y) {
                 const Cellular stone = cell_at(x, y, {4, 4}, 0.75f, seed);
                 const float gap = height.at(x, y) < 0.3f ? -0.3f : 0.0f;
                 return grain.at(x, y) + 0.2f * light.at(x, y) + gap +
                        0.16f * (cell_unit(stone, seed) - 0.5f);
               }));
}

Canvas paint_beds(std::span<const Bed> beds, float waves, std::uint32_t seed) {
  Canvas canvas;
  const Field grain = brush({90, 2.5f, 5.5f, 0.22f, -0.03f, 0.03f, 0.14f}, seed);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const float bend =
          waves * (noise_at(x, y, {2, 2}, seed + 1) + 0.3f * noise_at(x, y, {6, 4}, seed + 2));
      int row = wrap(static_cast<int>(std::floor(static_cast<float>(y) + bend)));
      std::size_t bed = 0;
      while (row >= beds[bed].thickness) row -= beds[bed++].thickness;
      // Softer beds recede: the lip above shades them, their own top edge catches light.
      const float edge = row == 0 ? 0.1f : row == beds[bed].thickness - 1 ? -0.14f : 0.0f;
      canvas.set(x, y, ramp(beds[bed].color, 0.55f).at(grain.at(x, y) + edge));
    }
  }
  return canvas;
}

Canvas paint_sandstone_side() {
  constexpr Bed kBeds[] = {{hex(0xd3ba88), 5}, {hex(0xc6a873), 3}, {hex(0xd8c294), 6},
                           {hex(0xbf9f6b), 2}, {hex(0xcfb480), 5}, {hex(0xd6be8e), 4},
                           {hex(0xc3a46f), 3}, {hex(0xcdb27e), 4}};
  return paint_beds(kBeds, 1.6f, 83);
}

Canvas paint_banded_rock() {
  constexpr Bed kBeds[] = {{hex(0x9d5a42), 5}, {hex(0xae6f4e), 3}, {hex(0x8c4c3c), 5},
                           {hex(0xba8a64), 2}, {hex(0xa66246), 5}, {hex(0x84463c), 4},
                           {hex(0xb17a57), 5}, {hex(0xc49f7a), 3}};
  return paint_beds(kBeds, 2.2f, 701);
}

Canvas paint_basalt_side() {
  // Columns five to eight texels wide, with joints across at different heights.
  constexpr int kEnds[] = {6, 11, 18, 24, 32};
  const Field grain = stone_tone({8, 3}, 0.26f, 712);
  Canvas canvas =
      paint(ramp(hex(0x55545a), 0.62f), make_field([&](int x, int y) {
              const int bent = wrap(x + (noise_at(x, y, {1, 4}, 713) > 0.12f ? 1 : 0));
              int column = 0;
              while (bent >= kEnds[column]) ++column;
              const int first = column == 0 ? 0 : kEnds[column - 1];
              const float across =
                  static_cast<float>(bent - first) / static_cast<float>(kEnds[column] - 1 - first);
              const int joint = static_cast<int>(unit(column, 0, 714) * kEdge);
              const bool gap = bent == kEnds[column] - 1 || wrap(y + bent / 3 - joint) == 0;
              const bool lip = wrap(y + bent / 3 - joint) == 1;
              return grain.at(x, y) + 0.2f * (0.45f - across) + (gap ? -0.3f : 0.0f) +
                     (lip ? 0.14f : 0.0f);
            }));
  return canvas;
}

Canvas paint_basalt_top() {
  const Field height = make_field([&](int x, int y) {
    const Cellular column = cell_at(x, y, {5, 5}, 0.7f, 727);
    return std::min(1.0f, 3.0f * (column.second - column.nearest));
  });
  const Field light = relief(height);
  const Field grain = stone_tone({5, 5}, 0.2f, 722);
  return paint(ramp(hex(0x55545a), 0.62f), make_field([&](int x, int y) {
                 const Cellular column = cell_at(x, y, {5, 5}, 0.7f, 727);
                 return grain.at(x, y) + 0.12f * light.at(x, y) +
                        (height.at(x, y) < 0.4f ? -0.26f : 0.0f) +
                        0.18f * (cell_unit(column, 723) - 0.5f);
               }));
}

Canvas paint_lava() {
  const Ramp fire{{hex(0x2e1715), hex(0x6b2114), hex(0xc2471a), hex(0xf08a2a), hex(0xffdc7a)}};
  const Field swirl = even_fbm({3, 3}, 3, 731);
  return paint(fire, make_field([&](int x, int y) {
                 const float bend = 5.0f * (swirl.at(x, y) - 0.5f);
                 const Cellular crust = cellular(static_cast<float>(x) + bend,
                                                 static_cast<float>(y) - bend, {4, 4}, 0.85f, 732);
                 const float vein = std::max(0.0f, 1.0f - 1.9f * (crust.second - crust.nearest));
                 return 0.24f + 0.62f * vein * vein + 0.24f * swirl.at(x, y) * swirl.at(x, y);
               }),
               11);
}

Canvas paint_obsidian() {
  const Ramp tones{{hex(0x17141d), hex(0x221d2b), hex(0x30293c), hex(0x4b4258), hex(0x8a7f97)}};
  return paint(tones,
               flatten(make_field([](int x, int y) {
                         // Shell-shaped fractures: a slope inside each shard, a bright glint on its
                         // upper edge.
                         const Cellular shard = cell_at(x, y, {3, 4}, 1.0f, 741);
                         const float tilt = noise_at(x, y, {4, 4}, 742 + (shard.id & 3u));
                         const float glint = shard.second - shard.nearest < 0.07f
                                                 ? 0.35f * cell_unit(shard, 743)
                                                 : 0.0f;
                         const float rings = absolute(shard.nearest * 5.0f -
                                                      std::floor(shard.nearest * 5.0f) - 0.5f);
                         return 0.32f + 0.35f * tilt + 0.2f * (rings - 0.25f) + glint +
                                0.2f * (cell_unit(shard, 744) - 0.5f);
                       }),
                       0.6f),
               9);
}

Canvas paint_marble() {
  const Ramp tones{{hex(0xa3a09f), hex(0xbfbcb9), hex(0xd8d5d0), hex(0xe4e1db), hex(0xf0eee9)}};
  const Field cloud = stone_tone({3, 3}, 0.22f, 751);
  return paint(tones,
               flatten(make_field([&](int x, int y) {
                         const float bend = 9.0f * noise_at(x, y, {2, 2}, 757) +
                                            3.0f * noise_at(x, y, {6, 6}, 753);
                         const float fx = static_cast<float>(x) + bend,
                                     fy = static_cast<float>(y) - bend;
                         const float vein = absolute(gradient_noise(fx, fy, {2, 2}, 754));
                         const float fine = absolute(gradient_noise(fy, fx, {3, 2}, 755));
                         return cloud.at(x, y) + 0.1f -
                                (vein < 0.035f  ? 0.36f
                                 : vein < 0.08f ? 0.12f
                                                : 0.0f) -
                                (fine < 0.025f ? 0.16f : 0.0f);
                       }),
                       0.7f),
               8);
}

Canvas paint_slate() {
  const Ramp tones = ramp(hex(0x66707a), 0.6f);
  const Field height = make_field([](int x, int y) {
    const float bend = 3.0f * noise_at(x, y, {2, 3}, 761);
    return 0.5f + gradient_noise(static_cast<float>(x), static_cast<float>(y) + bend, {2, 11}, 762);
  });
  const Field light = relief(height);
  const Field grain = stone_tone({4, 12}, 0.14f, 763);
  return paint(tones, flatten(make_field([&](int x, int y) {
                                const float split = height.at(x, y) < 0.17f ? -0.2f : 0.0f;
                                return grain.at(x, y) + 0.22f * light.at(x, y) + split;
                              }),
                              0.75f));
}

Canvas paint_limestone() {
  const Ramp tones = ramp(hex(0xc6bba4), 0.48f);
  Canvas canvas = paint(tones, brush({110, 2.0f, 4.6f, 0.38f, -0.05f, 0.05f, 0.14f}, 771), 9);
  // Small fossils: open rings, dark inside.
  Random random(772);
  for (int i = 0; i < 9; ++i) {
    const Dab shell{random.range(0, kEdge), random.range(0, kEdge), direction(random.next()),
                    random.range(1.5f, 2.4f), 1.5f};
    for_dab(shell, [&](int x, int y, float u, float v) {
      const bool edge = u * u + v * v > 0.4f;
      canvas.tint(x, y, edge ? tones.at(v + u < 0 ? 0.85f : 0.6f) : tones.at(0.22f),
                  edge ? 0.55f : 0.5f);
    });
  }
  return canvas;
}

}  // namespace skerry::textures
