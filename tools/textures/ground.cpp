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

Dab random_dab(Random& random, float long_low, float long_high, float flatness) {
  const float length = random.range(long_low, long_high);
  return {random.range(0, kEdge), random.range(0, kEdge), direction(random.next()), length, length * flatness};
}

}  // namespace

Canvas paint_dirt() {
  const Field height = even_fbm({6, 6}, 3, 501);
  const Field light = relief(height);
  const Field tone = flatten(make_field([&](int x, int y) {
    const Cellular clod = cellular(static_cast<float>(x), static_cast<float>(y), {6, 7}, 0.9f, 511);
    const float gap = clod.second - clod.nearest < 0.12f ? -0.16f : 0.0f;
    return 0.47f + 0.28f * light.at(x, y) + 0.16f * (height.at(x, y) - 0.5f) + gap;
  }), 0.8f);
  Canvas canvas = paint(ramp(hex(0x76573f), 0.62f), tone);
  Random random(521);
  const Ramp stones = ramp(hex(0x8d7a68), 0.5f);
  for (int i = 0; i < 7; ++i) put_pebble(canvas, random_dab(random, 1.1f, 1.9f, 0.75f), stones, 0.5f);
  return canvas;
}

Canvas paint_gravel(Color pebble, Color other, std::uint32_t seed) {
  Random random(seed);
  const Ramp first = ramp(pebble, 0.6f), second = ramp(other, 0.6f);
  Canvas canvas = paint(ramp(mix(pebble, other, 0.5f) * 0.62f, 0.4f), even_fbm({8, 8}, 2, seed));
  for (int i = 0; i < 120; ++i) {
    const float size = i < 60 ? 2.6f : 2.0f;
    Ramp stones = first;
    const float share = random.next();
    for (int tone = 0; tone < 5; ++tone) stones.tones[tone] = mix(first.tones[tone], second.tones[tone], share);
    put_pebble(canvas, random_dab(random, size * 0.75f, size * 1.25f, 0.75f), stones, random.range(0.4f, 0.62f));
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
    Dab blade = random_dab(random, 1.8f, 3.4f, 0.3f);
    blade.half_width = random.range(0.55f, 0.85f);
    const float base = 0.26f + 0.26f * age + random.range(-0.1f, 0.12f), hue = random.range(-0.3f, 0.3f);
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
    const float ragged = blades ? (unit(x, 3, seed) - 0.4f) * 5.0f : (unit(x / 3, 3, seed) - 0.5f) * 1.5f;
    const int depth = static_cast<int>(std::max(2.0f, fringe + wave + ragged));
    const float strand = unit(x, 5, seed);
    for (int y = 0; y < depth; ++y) {
      const float down = static_cast<float>(y) / static_cast<float>(depth);
      const float streak = blades ? 0.3f * (strand - 0.5f) + 0.12f * (unit(x, y / 3, seed) - 0.5f)
                                  : 0.25f * gradient_noise(static_cast<float>(x), static_cast<float>(y), {6, 8}, seed);
      canvas.set(x, y, mix(first.at(0.62f - 0.36f * down * down + streak), second.at(0.62f - 0.36f * down * down + streak),
                           unit(x, 9, seed)));
    }
    canvas.tint(x, depth, hex(0x1e1a22), 0.42f);
    canvas.tint(x, depth + 1, hex(0x1e1a22), 0.18f);
  }
  return canvas;
}

Canvas paint_snow() {
  const Field height = even_fbm({3, 4}, 3, 601);
  const Field light = relief(height);
  const Field tone = flatten(make_field([&](int x, int y) { return 0.55f + 0.32f * light.at(x, y); }), 0.9f);
  Ramp tones{{hex(0xbccad9), hex(0xd0dae4), hex(0xe2e8ee), hex(0xedf1f4), hex(0xf7f8f7)}};
  return paint(tones, tone);
}

Canvas paint_ice() {
  const Ramp tones{{hex(0x86b0c4), hex(0x9cc2d2), hex(0xaecfdc), hex(0xc3dee6), hex(0xe4f1f3)}};
  const Field cloud = even_fbm({3, 3}, 3, 611);
  const Field tone = flatten(make_field([&](int x, int y) {
    const float bend = 3.0f * gradient_noise(static_cast<float>(x), static_cast<float>(y), {3, 3}, 617);
    const Cellular cell = cellular(static_cast<float>(x) + bend, static_cast<float>(y) + bend, {2, 3}, 0.9f, 613);
    const float crack = cell.second - cell.nearest < 0.05f ? 0.42f : 0.0f;
    const float streak = gradient_noise(static_cast<float>(x + y), static_cast<float>(y - x), {4, 2}, 619);
    return 0.45f + 0.2f * (cloud.at(x, y) - 0.5f) + 0.2f * streak + crack;
  }), 0.85f);
  return paint(tones, tone);
}

Canvas paint_sand(Color base, std::uint32_t seed) {
  const Field height = make_field([&](int x, int y) {
    const float fx = static_cast<float>(x), fy = static_cast<float>(y);
    // Wind ripples: crests of noise that is long across and short along the wind.
    return 0.5f + 0.5f * gradient_noise(fx, fy + 2.5f * gradient_noise(fx, fy, {3, 3}, seed + 1), {3, 8}, seed);
  });
  const Field light = relief(height);
  const Field grain = even_fbm({16, 16}, 1, seed + 2);
  const Field tone = flatten(make_field([&](int x, int y) {
    return 0.5f + 0.3f * light.at(x, y) + 0.16f * (grain.at(x, y) - 0.5f);
  }), 0.85f);
  return paint(ramp(base, 0.42f), tone, 9);
}

Canvas paint_clay(Color base, std::uint32_t seed) {
  const Field height = even_fbm({4, 5}, 2, seed);
  const Field light = relief(height);
  const Field tone = flatten(make_field([&](int x, int y) {
    return 0.5f + 0.3f * light.at(x, y) + 0.1f * (height.at(x, y) - 0.5f);
  }), 0.8f);
  return paint(ramp(base, 0.45f), tone, 8);
}

Canvas paint_mud() {
  const Field height = even_fbm({5, 5}, 2, 631);
  const Field light = relief(height);
  const Field tone = flatten(make_field([&](int x, int y) {
    const float wet = light.at(x, y) > 0.34f ? 0.22f : 0.0f;
    return 0.42f + 0.34f * light.at(x, y) + wet;
  }), 0.8f);
  return paint(ramp(hex(0x5a483b), 0.6f), tone);
}

Canvas paint_cracked_ground(Color base, std::uint32_t seed) {
  const Field height = make_field([&](int x, int y) {
    const Cellular cell = cellular(static_cast<float>(x), static_cast<float>(y), {4, 4}, 0.85f, seed);
    return std::min((cell.second - cell.nearest) * 2.2f, 0.7f) + 0.08f * unit(static_cast<int>(cell.id & 255u), 1, seed);
  });
  const Field light = relief(height);
  const Field grain = even_fbm({10, 10}, 2, seed + 3);
  return paint(ramp(base, 0.62f), flatten(make_field([&](int x, int y) {
    const float crack = height.at(x, y) < 0.2f ? -0.38f : 0.0f;
    return 0.55f + 0.24f * light.at(x, y) + 0.14f * (grain.at(x, y) - 0.5f) + crack;
  }), 0.6f));
}

Canvas paint_mycelium_top() {
  Canvas canvas = paint_moss(hex(0x7d7188), 641);
  const Ramp threads = ramp(hex(0xbcb0bd), 0.5f);
  Random random(643);
  for (int i = 0; i < 26; ++i) {
    const float x = random.range(0, kEdge), y = random.range(0, kEdge);
    const Direction way = direction(random.next());
    const float reach = random.range(4, 9), bend = random.range(-3, 3);
    for_stroke({x, y, x + way.x * reach * 0.5f - way.y * bend, y + way.y * reach * 0.5f + way.x * bend,
                x + way.x * reach, y + way.y * reach, 1.0f, 1.0f},
               [&](int px, int py, float t, float) { canvas.tint(px, py, threads.at(0.7f - 0.4f * t), 0.6f); });
  }
  return canvas;
}

Canvas paint_moss(Color base, std::uint32_t seed) {
  Random random(seed);
  Field tone = make_field([](int, int) { return 0.25f; });
  constexpr int kTufts = 260;
  for (int i = 0; i < kTufts; ++i) {
    const Dab tuft = random_dab(random, 1.2f, 2.3f, 0.8f);
    const float height = 0.34f + 0.18f * static_cast<float>(i) / kTufts + random.range(-0.08f, 0.08f);
    for_dab(tuft, [&](int x, int y, float, float) {
      const float dx = static_cast<float>(x) + 0.5f - tuft.x, dy = static_cast<float>(y) + 0.5f - tuft.y;
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
    const Dab leaf = random_dab(random, 1.8f, 3.0f, 0.5f);
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
    const Cellular cell = cellular(static_cast<float>(x), static_cast<float>(y), {5, 5}, 0.8f, 661);
    const float ridge = cell.second - cell.nearest < 0.14f ? 0.3f : 0.0f;
    return 0.45f + ridge + 0.12f * (unit(static_cast<int>(cell.id & 1023u), 2, 661) - 0.5f) + 0.1f * (unit(x, y, 663) - 0.5f);
  }), 0.7f);
  return paint({{hex(0xc9bfb8), hex(0xd6cec7), hex(0xe1dbd4), hex(0xebe7e1), hex(0xf6f4ef)}}, tone);
}

Canvas paint_water() {
  const Ramp tones{{hex(0xb4cfd2), hex(0xbdd6d8), hex(0xc6dcdd), hex(0xd0e3e3), hex(0xdeecea)}};
  const Field tone = flatten(make_field([](int x, int y) {
    const float fx = static_cast<float>(x), fy = static_cast<float>(y);
    const float bend = 4.0f * gradient_noise(fx, fy, {3, 3}, 671);
    const float wave = gradient_noise(fx + bend, fy + bend, {3, 6}, 673);
    // Thin crests where the wave passes through zero, as caustics do.
    return 0.38f + 0.5f * std::max(0.0f, 1.0f - 7.0f * (wave < 0 ? -wave : wave)) + 0.2f * wave;
  }), 0.9f);
  return paint(tones, tone, 9);
}

}  // namespace skerry::textures
