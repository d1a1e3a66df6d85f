// Ores, crystals and glowing stone.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {
namespace {

const Color kHostStone = hex(0x8b8984);
constexpr std::uint32_t kHostSeed = 11;

// Centres of lumps, spread over the tile so that no two touch.
constexpr float kLumps[][2] = {{7, 6}, {21, 4}, {28, 14}, {14, 15}, {4, 20}, {23, 24}, {12, 27}};

// A crystal as a long prism: a lit side, a dark side and a bright edge between.
void put_crystal(Canvas& canvas, const Dab& dab, const Ramp& tones) {
  for_dab(dab, [&](int x, int y, float u, float v) {
    if (v * v > 1.0f - 0.9f * (u < 0 ? -u : u)) return;
    const float side = v < -0.15f ? 0.72f : v < 0.2f ? 0.95f : 0.3f;
    canvas.set(x, y, tones.at(side - 0.12f * u));
  });
}

}  // namespace

Canvas paint_ore(const Ramp& mineral, float gloss, std::uint32_t seed) {
  Canvas canvas = paint_stone(kHostStone, kHostSeed);
  Random random(seed);
  for (const auto& lump : kLumps) {
    const float x0 = lump[0] + random.range(-1.5f, 1.5f), y0 = lump[1] + random.range(-1.5f, 1.5f);
    const int grains = 3 + random.below(3);
    // The socket first, so that the lump looks set in, then the grains of the lump.
    for_dab({x0 + 0.5f, y0 + 0.7f, direction(random.next()), 4.0f, 3.2f},
            [&](int x, int y, float, float) { canvas.tint(x, y, hex(0x2d2a30), 0.42f); });
    for (int i = 0; i < grains; ++i) {
      const Dab grain{x0 + random.range(-1.9f, 1.9f), y0 + random.range(-1.7f, 1.7f), direction(random.next()),
                      random.range(1.3f, 2.2f), random.range(1.0f, 1.5f)};
      const float tone = random.range(0.35f, 0.6f);
      for_dab(grain, [&](int x, int y, float, float) {
        const float dx = static_cast<float>(x) + 0.5f - grain.x, dy = static_cast<float>(y) + 0.5f - grain.y;
        canvas.set(x, y, mineral.at(tone - 0.24f * (dx + dy)));
      });
      canvas.tint(static_cast<int>(grain.x - 0.4f), static_cast<int>(grain.y - 0.4f), mineral.tones[4], gloss);
    }
  }
  return canvas;
}

Canvas paint_crystal_ore(Color crystal, std::uint32_t seed) {
  Canvas canvas = paint_stone(kHostStone, kHostSeed);
  const Ramp tones = ramp(crystal, 0.8f);
  Random random(seed);
  for (const auto& lump : kLumps) {
    for_dab({lump[0] + 0.5f, lump[1] + 0.7f, {1, 0}, 3.6f, 3.2f},
            [&](int x, int y, float, float) { canvas.tint(x, y, hex(0x24222c), 0.5f); });
    for (int i = 0; i < 3; ++i) {
      put_crystal(canvas, {lump[0] + random.range(-1.6f, 1.6f), lump[1] + random.range(-1.2f, 1.2f),
                           direction(random.range(0.15f, 0.4f)), random.range(2.4f, 3.6f), random.range(1.0f, 1.5f)}, tones);
    }
  }
  return canvas;
}

Canvas paint_crystal(Color base, std::uint32_t seed) {
  // A mass of prisms: shards of one flat tone each, split by a bright ridge.
  const Ramp tones = ramp(base, 0.72f);
  return paint(tones, flatten(make_field([&](int x, int y) {
    const float fx = static_cast<float>(x) + 0.5f, fy = static_cast<float>(y) + 0.5f;
    const Cellular shard = cellular(fx + 0.0f, fy, {5, 3}, 1.0f, seed);
    const float tone = unit(static_cast<int>(shard.id & 0xffffu), 1, seed);
    const float ridge = shard.second - shard.nearest;
    const float slope = 0.3f * gradient_noise(fx, fy, {6, 4}, seed + 1 + (shard.id & 7u));
    return 0.3f + 0.42f * tone + slope + (ridge < 0.09f ? 0.3f : 0.0f);
  }), 0.5f), 8);
}

Canvas paint_glowstone(Color core, std::uint32_t seed) {
  const Ramp tones{{hex(0x5a4632), mix(core, hex(0x6b4a2a), 0.6f), mix(core, hex(0xa8743a), 0.35f), core, mix(core, hex(0xfff7dc), 0.75f)}};
  return paint(tones, make_field([&](int x, int y) {
    const Cellular grain = cellular(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, {5, 5}, 0.9f, seed);
    const float tone = unit(static_cast<int>(grain.id & 0xffffu), 1, seed);
    const float seam = grain.second - grain.nearest < 0.14f ? -0.35f : 0.0f;
    return 0.85f - 0.5f * grain.nearest + 0.25f * (tone - 0.5f) + seam;
  }), 8);
}

}  // namespace skerry::textures
