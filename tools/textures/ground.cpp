// Loose ground: soil, grass, sand, snow, water.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {
namespace {

// Two greens (or browns) and where each blade uses which.
struct TwoTone {
  Ramp first, second;
  Color at(float tone, float share) const { return mix(first.at(tone), second.at(tone), share); }
};

// A pebble: lit at the top left, dark rim at the bottom right.
void put_pebble(Canvas& canvas, const Dab& dab, const Ramp& tones, float tone) {
  for_dab(dab, [&](int x, int y, float, float) {
    const float dx = (static_cast<float>(x) + 0.5f - dab.x) / dab.half_length;
    const float dy = (static_cast<float>(y) + 0.5f - dab.y) / dab.half_length;
    const float rim = dx * dx + dy * dy > 0.7f && dx + dy > 0.2f ? -0.2f : 0.0f;
    canvas.set(x, y, tones.at(tone - 0.22f * (dx + dy) + rim));
  });
}

Dab random_dab(Point center, Random& random, float long_low, float long_high, float flatness) {
  const float length = random.range(long_low, long_high);
  return {center.x, center.y, direction(random.next()), length, length * flatness};
}

}  // namespace

Canvas paint_dirt() {
  Canvas canvas = paint(ramp(hex(0x7a5b43), 0.62f),
                        brush({170, 1.3f, 3.0f, 0.7f, -0.25f, 0.25f, 0.15f}, 501), 9);
  Random random(521);
  const Ramp stones = ramp(hex(0x8b7866), 0.5f);
  for (int i = 0; i < 7; ++i)
    put_pebble(canvas, random_dab(spread_point(i, 522), random, 1.0f, 1.7f, 0.75f), stones, 0.48f);
  return canvas;
}

Canvas paint_gravel(Color pebble, Color other, std::uint32_t seed) {
  Random random(seed);
  const Ramp first = ramp(pebble, 0.6f), second = ramp(other, 0.6f);
  Canvas canvas = paint(ramp(mix(pebble, other, 0.5f) * 0.62f, 0.4f), even_fbm({8, 8}, 2, seed));
  for (int i = 0; i < 170; ++i) {
    const float size = i < 110 ? 2.8f : 2.0f;
    Ramp stones = first;
    const float share = random.next();
    for (int tone = 0; tone < 5; ++tone)
      stones.tones[tone] = mix(first.tones[tone], second.tones[tone], share);
    const Dab dab = random_dab(spread_point(i, seed), random, size * 0.75f, size * 1.25f, 0.75f);
    put_pebble(canvas, dab, stones, random.range(0.4f, 0.62f));
  }
  return canvas;
}

Canvas paint_grass_top(Color leaf, Color other, std::uint32_t seed) {
  Random random(seed);
  Field tone = make_field([](int, int) { return 0.3f; });
  Field share = even_fbm({4, 4}, 2, seed + 1);
  constexpr int kBlades = 340;
  for (int i = 0; i < kBlades; ++i) {
    const float age = static_cast<float>(i) / kBlades;
    Dab blade = random_dab(spread_point(i, seed), random, 1.8f, 3.4f, 0.3f);
    blade.half_width = random.range(0.55f, 0.85f);
    const float base = 0.26f + 0.26f * age + random.range(-0.1f, 0.12f),
                hue = random.range(-0.3f, 0.3f);
    // The tip is the end nearer to the top of the texture, where the light comes from.
    const float tip = blade.along.y < 0.0f ? 1.0f : -1.0f;
    for_dab(blade, [&](int x, int y, float u, float v) {
      tone.at(x, y) = base + 0.13f * u * tip - 0.05f * v;
      share.at(x, y) = std::clamp(share.at(x, y) * 0.5f + 0.25f + hue, 0.0f, 1.0f);
    });
  }
  const TwoTone greens{ramp(leaf, 0.66f), ramp(other, 0.66f)};
  tone = flatten(tone, 0.85f);
  share = flatten(share, 0.8f);
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x) canvas.set(x, y, greens.at(tone.at(x, y), share.at(x, y)));
  return canvas;
}

Canvas paint_covered_side(Color cover, Color other, float fringe, bool blades, std::uint32_t seed) {
  Canvas canvas = paint_dirt();
  const Ramp first = ramp(cover, 0.66f), second = ramp(other, 0.66f);
  for (int x = 0; x < kEdge; ++x) {
    const float wave = gradient_noise(static_cast<float>(x), 0.5f, {5, 1}, seed) * 3.0f;
    const float ragged =
        blades ? (unit(x, 3, seed) - 0.4f) * 5.0f : (unit(x / 3, 3, seed) - 0.5f) * 1.5f;
    const int depth = static_cast<int>(std::max(2.0f, fringe + wave + ragged));
    const float strand = unit(x, 5, seed);
    for (int y = 0; y < depth; ++y) {
      const float down = static_cast<float>(y) / static_cast<float>(depth);
      const float streak = blades ? 0.3f * (strand - 0.5f) + 0.12f * (unit(x, y / 3, seed) - 0.5f)
                                  : 0.25f * noise_at(x, y, {7, 9}, seed);
      canvas.set(
          x, y,
          mix(first.at(0.62f - 0.36f * down * down + streak),
              second.at(0.62f - 0.36f * down * down + streak), blades ? unit(x, 9, seed) : down));
    }
    canvas.tint(x, depth, hex(0x1e1a22), 0.42f);
    canvas.tint(x, depth + 1, hex(0x1e1a22), 0.18f);
  }
  return canvas;
}

Canvas paint_snow() {
  const Ramp tones{{hex(0xc3d0de), hex(0xd4dee8), hex(0xe3e9ef), hex(0xedf1f4), hex(0xf7f8f7)}};
  return paint(tones, brush({90, 3.0f, 6.0f, 0.45f, -0.2f, 0.16f, 0.17f}, 601), 9);
}

Canvas paint_ice() {
  const Ramp tones{{hex(0x86b0c4), hex(0x9cc2d2), hex(0xaecfdc), hex(0xc3dee6), hex(0xe4f1f3)}};
  const Field cloud = even_fbm({3, 3}, 3, 611);
  const Field tone = flatten(
      make_field([&](int x, int y) {
        const float bend = 3.0f * noise_at(x, y, {3, 3}, 617);
        const Cellular cell =
            cellular(static_cast<float>(x) + bend, static_cast<float>(y) + bend, {2, 3}, 0.9f, 613);
        const float crack = cell.second - cell.nearest < 0.05f ? 0.42f : 0.0f;
        const float streak =
            gradient_noise(static_cast<float>(x + y), static_cast<float>(y - x), {4, 2}, 619);
        return 0.45f + 0.2f * (cloud.at(x, y) - 0.5f) + 0.2f * streak + crack;
      }),
      0.85f);
  return paint(tones, tone);
}

Canvas paint_sand(Color base, std::uint32_t seed) {
  // Wind ripples: long, flat touches of the brush.
  return paint(ramp(base, 0.42f), brush({150, 2.5f, 5.5f, 0.26f, -0.05f, 0.03f, 0.13f}, seed), 9);
}

Canvas paint_smooth_ground(Color base, std::uint32_t seed) {
  return paint(ramp(base, 0.45f), brush({120, 2.0f, 4.2f, 0.6f, -0.2f, 0.2f, 0.13f}, seed), 9);
}

Canvas paint_mud() {
  // Wet ridges shine where they face the sky.
  const Field tone = brush({110, 2.0f, 4.4f, 0.5f, -0.12f, 0.12f, 0.17f}, 631);
  return paint(ramp(hex(0x5e4c3f), 0.62f), make_field([&](int x, int y) {
                 return tone.at(x, y) + (tone.at(x, y) > 0.66f ? 0.16f : 0.0f);
               }),
               9);
}

Canvas paint_cracked_ground(Color base, std::uint32_t seed) {
  const Field height = make_field([&](int x, int y) {
    const Cellular cell = cell_at(x, y, {4, 4}, 0.85f, seed);
    return std::min((cell.second - cell.nearest) * 2.2f, 0.7f) + 0.08f * cell_unit(cell, seed);
  });
  const Field light = relief(height);
  const Field grain = even_fbm({10, 10}, 2, seed + 3);
  return paint(ramp(base, 0.62f), flatten(make_field([&](int x, int y) {
                                            const float crack =
                                                height.at(x, y) < 0.2f ? -0.38f : 0.0f;
                                            return 0.55f + 0.24f * light.at(x, y) +
                                                   0.14f * (grain.at(x, y) - 0.5f) + crack;
                                          }),
                                          0.6f));
}

Canvas paint_mycelium_top() {
  Canvas canvas = paint_moss(hex(0x83788c), 641);
  const Ramp threads = ramp(hex(0xbcb0bd), 0.5f);
  Random random(643);
  for (int i = 0; i < 22; ++i) {
    const auto [x, y] = spread_point(i, 644);
    const Direction way = direction(random.next());
    const float reach = random.range(4, 9), bend = random.range(-3, 3);
    for_stroke(
        {x, y, x + way.x * reach * 0.5f - way.y * bend, y + way.y * reach * 0.5f + way.x * bend,
         x + way.x * reach, y + way.y * reach, 1.0f, 1.0f},
        [&](int px, int py, float t, float) {
          canvas.tint(px, py, threads.at(0.6f - 0.4f * t), 0.38f);
        });
  }
  return canvas;
}

Canvas paint_moss(Color base, std::uint32_t seed) {
  Random random(seed);
  Field tone = make_field([](int, int) { return 0.25f; });
  constexpr int kTufts = 260;
  for (int i = 0; i < kTufts; ++i) {
    const Dab tuft = random_dab(spread_point(i, seed), random, 1.2f, 2.3f, 0.8f);
    const float height =
        0.34f + 0.18f * static_cast<float>(i) / kTufts + random.range(-0.08f, 0.08f);
    for_dab(tuft, [&](int x, int y, float, float) {
      const float dx = static_cast<float>(x) + 0.5f - tuft.x,
                  dy = static_cast<float>(y) + 0.5f - tuft.y;
      tone.at(x, y) = height - 0.1f * (dx + dy) / tuft.half_length;
    });
  }
  return paint(ramp(base, 0.62f), flatten(tone, 0.85f), 9);
}

Canvas paint_leaf_litter() {
  Canvas canvas = paint_dirt();
  const Color kinds[] = {hex(0x8a5a34), hex(0xa3703a), hex(0x7a4a36), hex(0x9c8148), hex(0x6b5138)};
  Random random(653);
  for (int i = 0; i < 110; ++i) {
    const Ramp tones = ramp(kinds[random.below(5)], 0.6f);
    const Dab leaf = random_dab(spread_point(i, 654), random, 1.8f, 3.0f, 0.5f);
    const float light = random.range(0.3f, 0.6f);
    for_dab(leaf, [&](int x, int y, float u, float v) {
      const float vein = v * v < 0.06f ? 0.14f : 0.0f;
      canvas.set(x, y, tones.at(light - 0.12f * v + 0.06f * u + vein));
    });
  }
  return canvas;
}

Canvas paint_salt() {
  const Field tone = flatten(make_field([&](int x, int y) {
                               const Cellular cell = cell_at(x, y, {5, 5}, 0.8f, 661);
                               const float ridge = cell.second - cell.nearest < 0.14f ? 0.3f : 0.0f;
                               return 0.45f + ridge + 0.12f * (cell_unit(cell, 661) - 0.5f) +
                                      0.1f * (unit(x, y, 663) - 0.5f);
                             }),
                             0.7f);
  return paint({{hex(0xc9bfb8), hex(0xd6cec7), hex(0xe1dbd4), hex(0xebe7e1), hex(0xf6f4ef)}}, tone);
}

Canvas paint_water() {
  const Ramp tones{{hex(0xb4cfd2), hex(0xbdd6d8), hex(0xc6dcdd), hex(0xd0e3e3), hex(0xdeecea)}};
  const Field crest = make_field([](int x, int y) {
    const float bend = 4.0f * noise_at(x, y, {3, 3}, 671);
    const float wave =
        gradient_noise(static_cast<float>(x) + bend, static_cast<float>(y) + bend, {3, 6}, 673);
    // Thin lines where the wave passes through zero, as caustics do.
    return std::max(0.0f, 1.0f - 7.0f * absolute(wave)) + 0.4f * wave;
  });
  const Field tone = flatten(crest, 0.9f);
  Canvas canvas =
      paint(tones, make_field([&](int x, int y) { return 0.38f + 0.5f * tone.at(x, y); }), 9);
  // Clear water; the crests carry a trace of foam.
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x)
      canvas.at(x, y).alpha = 0.01f + 0.05f * std::clamp(crest.at(x, y), 0.0f, 1.0f);
  return canvas;
}

}  // namespace skerry::textures
