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
    if (v * v > 1.0f - 0.9f * absolute(u)) return;
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
      const Dab grain{x0 + random.range(-1.9f, 1.9f), y0 + random.range(-1.7f, 1.7f),
                      direction(random.next()), random.range(1.3f, 2.2f), random.range(1.0f, 1.5f)};
      const float tone = random.range(0.35f, 0.6f);
      for_dab(grain, [&](int x, int y, float, float) {
        const float dx = static_cast<float>(x) + 0.5f - grain.x,
                    dy = static_cast<float>(y) + 0.5f - grain.y;
        canvas.set(x, y, mineral.at(tone - 0.24f * (dx + dy)));
      });
      canvas.tint(static_cast<int>(grain.x - 0.4f), static_cast<int>(grain.y - 0.4f),
                  mineral.tones[4], gloss);
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
      put_crystal(canvas,
                  {lump[0] + random.range(-1.6f, 1.6f), lump[1] + random.range(-1.2f, 1.2f),
                   direction(random.range(0.15f, 0.4f)), random.range(2.4f, 3.6f),
                   random.range(1.0f, 1.5f)},
                  tones);
    }
  }
  return canvas;
}

Canvas paint_crystal(Color base, std::uint32_t seed) {
  // A thicket of prisms; the last ones lie in front and are the lightest.
  const Ramp tones = ramp(base, 0.75f);
  Canvas canvas = paint(tones, make_field([](int, int) { return 0.12f; }));
  Random random(seed);
  constexpr int kPrisms = 64;
  for (int i = 0; i < kPrisms; ++i) {
    const float front = static_cast<float>(i) / kPrisms;
    Ramp shade = tones;
    for (Color& tone : shade.tones) tone = mix(tone, tones.tones[0], 0.5f * (1.0f - front));
    const auto [x, y] = spread_point(i, seed);
    put_crystal(canvas,
                {x, y, direction(random.range(0.13f, 0.37f)), random.range(4.0f, 7.5f),
                 random.range(1.6f, 2.5f)},
                shade);
  }
  // Dull edges: what glows by itself has no shadows that show where it is bent.
  constexpr int kLast = kEdge - 1;
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x)
      if (x == 0 || x == kLast || y == 0 || y == kLast)
        canvas.tint(x, y, mix(tones.tones[0], tones.tones[1], 0.3f), 0.9f);
  return canvas;
}

Canvas paint_glowstone(Color core, std::uint32_t seed) {
  // Lumps that glow from inside: each is brightest at its heart and dull at its rim.
  const Ramp tones{{mix(core, hex(0x4a3a30), 0.72f), mix(core, hex(0x7a5636), 0.5f),
                    mix(core, hex(0xa8743a), 0.2f), mix(core, hex(0xfff7dc), 0.2f),
                    mix(core, hex(0xfff7dc), 0.8f)}};
  Field tone = make_field([](int, int) { return 0.1f; });
  Random random(seed);
  for (int i = 0; i < 110; ++i) {
    const auto [center_x, center_y] = spread_point(i, seed);
    const Dab lump{center_x, center_y, direction(random.next()), random.range(2.2f, 4.0f),
                   random.range(1.8f, 3.0f)};
    const float heart = random.range(0.7f, 1.0f);
    for_dab(lump, [&](int x, int y, float u, float v) {
      tone.at(x, y) = heart - 0.55f * (u * u + v * v);
    });
  }
  return paint(tones, flatten(tone, 0.6f), 9);
}

}  // namespace skerry::textures
