// Rock faces.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {
namespace {

float absolute(float value) { return value < 0.0f ? -value : value; }

Cellular cell_at(int x, int y, Cells cells, float jitter, std::uint32_t seed) {
  return cellular(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, cells, jitter, seed);
}

float noise_at(int x, int y, Cells cells, std::uint32_t seed) {
  return gradient_noise(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, cells, seed);
}

float cell_unit(const Cellular& cell, std::uint32_t seed) {
  return unit(static_cast<int>(cell.id & 0xffffu), 0, seed);
}

}  // namespace

Field stone_tone(Cells cells, float strength, std::uint32_t seed) {
  const Field height = even_fbm(cells, 3, seed);
  const Field light = relief(height);
  return flatten(make_field([&](int x, int y) {
    return 0.5f + strength * (light.at(x, y) + 0.35f * (height.at(x, y) - 0.5f));
  }), 0.85f);
}

Canvas paint_stone(Color base, std::uint32_t seed) {
  // Planes of broken rock: flat facets, each tilted its own way, with a lit edge where they meet.
  const Field height = make_field([&](int x, int y) {
    const int bent_x = x + static_cast<int>(5.0f * noise_at(x, y, {3, 3}, seed + 5));
    const Cellular facet = cell_at(bent_x, y, {3, 5}, 1.0f, seed);
    return 0.55f * cell_unit(facet, seed) + 0.45f * std::min(1.0f, 1.6f * (facet.second - facet.nearest));
  });
  const Field light = relief(height);
  const Field grain = stone_tone({4, 6}, 0.22f, seed + 9);
  return paint(ramp(base, 0.6f), flatten(make_field([&](int x, int y) {
    return grain.at(x, y) + 0.17f * light.at(x, y);
  }), 0.8f));
}

Canvas paint_mossy(const Canvas& stone, std::uint32_t seed) {
  Canvas canvas = stone;
  const Canvas moss = paint_moss(hex(0x74804c), seed);
  const Field cover = flatten(even_fbm({4, 4}, 3, seed + 1), 0.6f);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      if (cover.at(x, y) > 0.56f) canvas.set(x, y, moss.at(x, y).color);
      else if (cover.at(x - 1, y - 1) > 0.56f) canvas.tint(x, y, hex(0x2a2a2c), 0.35f);
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
    return grain.at(x, y) + 0.2f * light.at(x, y) + gap + 0.16f * (cell_unit(stone, seed) - 0.5f);
  }));
}

Canvas paint_strata(const Ramp& tones, Cells waves, std::uint32_t seed) {
  const Field height = make_field([&](int x, int y) {
    const float bend = 1.6f * noise_at(x, y, {2, 2}, seed);
    const int bed = static_cast<int>(std::floor((static_cast<float>(y) + bend) * static_cast<float>(waves.y) / kEdge));
    return unit(((bed % waves.y) + waves.y) % waves.y, 0, seed + 1);
  });
  const Field light = relief(height);
  const Field grain = make_field([&](int x, int y) { return noise_at(x, y, {waves.x, 16}, seed + 2); });
  return paint(tones, flatten(make_field([&](int x, int y) {
    return 0.5f + 0.34f * (height.at(x, y) - 0.5f) + 0.16f * light.at(x, y) + 0.22f * grain.at(x, y);
  }), 0.5f));
}

Canvas paint_banded_rock() {
  const Color bands[] = {hex(0x9c543a), hex(0xb06a45), hex(0x8a4535), hex(0xc29468), hex(0xa65c3e), hex(0x7b3f38),
                         hex(0xb87a52), hex(0xd0ab80)};
  Canvas canvas;
  const Field grain = stone_tone({3, 10}, 0.3f, 702);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const float bend = 2.2f * noise_at(x, y, {2, 2}, 701) + 0.6f * noise_at(x, y, {6, 4}, 703);
      const int bed = wrap(static_cast<int>(std::floor(static_cast<float>(y) + bend)));
      // Beds of two to five texels, never the same twice in a block.
      constexpr int kEnds[] = {5, 8, 13, 15, 20, 24, 29, 32};
      int band = 0;
      while (bed >= kEnds[band]) ++band;
      const bool lip = bed == kEnds[band] - 1;
      canvas.set(x, y, ramp(bands[band], 0.55f).at(grain.at(x, y) - (lip ? 0.16f : 0.0f)));
    }
  }
  return canvas;
}

Canvas paint_basalt_side() {
  // Columns five to eight texels wide, with joints across at different heights.
  constexpr int kEnds[] = {6, 11, 18, 24, 32};
  const Field grain = stone_tone({8, 3}, 0.26f, 712);
  Canvas canvas = paint(ramp(hex(0x55545a), 0.62f), make_field([&](int x, int y) {
    const int bent = wrap(x + (noise_at(x, y, {1, 4}, 713) > 0.12f ? 1 : 0));
    int column = 0;
    while (bent >= kEnds[column]) ++column;
    const int first = column == 0 ? 0 : kEnds[column - 1];
    const float across = static_cast<float>(bent - first) / static_cast<float>(kEnds[column] - 1 - first);
    const int joint = static_cast<int>(unit(column, 0, 714) * kEdge);
    const bool gap = bent == kEnds[column] - 1 || wrap(y + bent / 3 - joint) == 0;
    const bool lip = wrap(y + bent / 3 - joint) == 1;
    return grain.at(x, y) + 0.2f * (0.45f - across) + (gap ? -0.3f : 0.0f) + (lip ? 0.14f : 0.0f);
  }));
  return canvas;
}

Canvas paint_basalt_top() {
  const Field height = make_field([&](int x, int y) {
    const Cellular column = cell_at(x, y, {4, 5}, 0.55f, 721);
    return std::min(1.0f, 3.0f * (column.second - column.nearest));
  });
  const Field light = relief(height);
  const Field grain = stone_tone({5, 5}, 0.2f, 722);
  return paint(ramp(hex(0x55545a), 0.62f), make_field([&](int x, int y) {
    const Cellular column = cell_at(x, y, {4, 5}, 0.55f, 721);
    return grain.at(x, y) + 0.12f * light.at(x, y) + (height.at(x, y) < 0.4f ? -0.26f : 0.0f) +
           0.18f * (cell_unit(column, 723) - 0.5f);
  }));
}

Canvas paint_lava() {
  const Ramp fire{{hex(0x2e1715), hex(0x6b2114), hex(0xc2471a), hex(0xf08a2a), hex(0xffdc7a)}};
  const Field swirl = even_fbm({3, 3}, 3, 731);
  return paint(fire, make_field([&](int x, int y) {
    const float bend = 5.0f * (swirl.at(x, y) - 0.5f);
    const Cellular crust = cellular(static_cast<float>(x) + bend, static_cast<float>(y) - bend, {3, 3}, 0.9f, 732);
    const float vein = std::max(0.0f, 1.0f - 2.6f * (crust.second - crust.nearest));
    return 0.12f + 0.85f * vein * vein + 0.34f * swirl.at(x, y) * swirl.at(x, y);
  }), 9);
}

Canvas paint_obsidian() {
  const Ramp tones{{hex(0x17141d), hex(0x221d2b), hex(0x30293c), hex(0x4b4258), hex(0x8a7f97)}};
  return paint(tones, flatten(make_field([](int x, int y) {
    // Shell-shaped fractures: a slope inside each shard, a bright glint on its upper edge.
    const Cellular shard = cell_at(x, y, {3, 4}, 1.0f, 741);
    const float tilt = noise_at(x, y, {4, 4}, 742 + (shard.id & 3u));
    const float glint = shard.second - shard.nearest < 0.07f ? 0.35f * cell_unit(shard, 743) : 0.0f;
    const float rings = absolute(shard.nearest * 5.0f - std::floor(shard.nearest * 5.0f) - 0.5f);
    return 0.32f + 0.35f * tilt + 0.2f * (rings - 0.25f) + glint + 0.2f * (cell_unit(shard, 744) - 0.5f);
  }), 0.6f), 9);
}

Canvas paint_marble() {
  const Ramp tones{{hex(0xa3a09f), hex(0xbfbcb9), hex(0xd8d5d0), hex(0xe4e1db), hex(0xf0eee9)}};
  const Field cloud = stone_tone({3, 3}, 0.22f, 751);
  return paint(tones, flatten(make_field([&](int x, int y) {
    const float bend = 9.0f * noise_at(x, y, {2, 2}, 752) + 3.0f * noise_at(x, y, {6, 6}, 753);
    const float fx = static_cast<float>(x) + bend, fy = static_cast<float>(y) - bend;
    const float vein = absolute(gradient_noise(fx, fy, {2, 2}, 754));
    const float fine = absolute(gradient_noise(fy, fx, {3, 2}, 755));
    return cloud.at(x, y) + 0.1f - (vein < 0.035f ? 0.36f : vein < 0.08f ? 0.12f : 0.0f) - (fine < 0.025f ? 0.16f : 0.0f);
  }), 0.7f), 8);
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
  }), 0.75f));
}

Canvas paint_limestone() {
  const Ramp tones = ramp(hex(0xc6bba4), 0.48f);
  Canvas canvas = paint(tones, stone_tone({4, 7}, 0.3f, 771), 8);
  // Small fossils: open rings, dark inside.
  Random random(772);
  for (int i = 0; i < 9; ++i) {
    const Dab shell{random.range(0, kEdge), random.range(0, kEdge), direction(random.next()), random.range(1.5f, 2.4f), 1.5f};
    for_dab(shell, [&](int x, int y, float u, float v) {
      const bool edge = u * u + v * v > 0.4f;
      canvas.tint(x, y, edge ? tones.at(v + u < 0 ? 0.85f : 0.6f) : tones.at(0.22f), edge ? 0.55f : 0.5f);
    });
  }
  return canvas;
}

}  // namespace skerry::textures
