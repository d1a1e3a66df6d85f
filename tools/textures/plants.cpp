// Plants: silhouettes on nothing, rooted in the bottom row, not wrapped.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {
namespace {

// A blade or stem: lit on its left side, lighter towards the tip.
void put_stroke(Canvas& canvas, const Stroke& stroke, const Ramp& tones, float root_tone,
                float tip_tone) {
  for_stroke(stroke, [&](int x, int y, float t, float side) {
    canvas.set_clipped(x, y, tones.at(root_tone + (tip_tone - root_tone) * t - 0.09f * side));
  });
}

void put_dab(Canvas& canvas, const Dab& dab, const Ramp& tones, float tone) {
  for_dab(dab, [&](int x, int y, float, float) {
    const float dx = static_cast<float>(x) + 0.5f - dab.x,
                dy = static_cast<float>(y) + 0.5f - dab.y;
    canvas.set_clipped(x, y, tones.at(tone - 0.16f * (dx + dy) / std::max(dab.half_length, 1.0f)));
  });
}

void put_flower_head(Canvas& canvas, float x, float y, Flower flower, const Ramp& petal,
                     Color center) {
  switch (flower) {
    case Flower::kDaisy:
    case Flower::kPoppy: {
      const int petals = flower == Flower::kDaisy ? 8 : 5;
      const float reach = flower == Flower::kDaisy ? 2.6f : 2.1f;
      for (int i = 0; i < petals; ++i) {
        const Direction way =
            direction((static_cast<float>(i) + 0.25f) / static_cast<float>(petals));
        put_dab(canvas,
                {x + way.x * reach, y + way.y * reach, way, 2.2f,
                 flower == Flower::kDaisy ? 0.95f : 1.9f},
                petal, 0.55f - 0.12f * (way.x + way.y));
      }
      put_dab(canvas, {x, y, {1, 0}, 1.5f, 1.5f}, ramp(center, 0.6f), 0.55f);
      break;
    }
    case Flower::kTulip:
      put_dab(canvas, {x, y, {0, 1}, 3.1f, 2.5f}, petal, 0.5f);
      for (const float side : {-1.7f, 0.0f, 1.7f})
        put_dab(canvas, {x + side, y - 2.4f, {0, 1}, 2.0f, 0.8f}, petal, 0.66f);
      break;
    case Flower::kBell:
      for (int i = 0; i < 6; ++i) {
        const float side = i % 2 == 0 ? -1.5f : 1.5f;
        put_dab(canvas, {x + side, y + 1.9f * static_cast<float>(i) - 2.0f, {0, 1}, 1.7f, 1.3f},
                petal, 0.62f - 0.04f * static_cast<float>(i));
      }
      break;
  }
}

}  // namespace

Canvas paint_tall_grass(Color base, std::uint32_t seed) {
  Canvas canvas = empty_canvas();
  Random random(seed);
  const Ramp tones = ramp(base, 0.72f);
  constexpr int kBlades = 17;
  for (int i = 0; i < kBlades; ++i) {
    // Back blades first, dark and tall; front blades short and light. Roots step over the width by
    // a golden section.
    const float front = static_cast<float>(i) / kBlades;
    const float step = 0.618f * static_cast<float>(i), x = 4.0f + 24.0f * (step - std::floor(step));
    const float lean = (x - 16.0f) * 0.35f + random.range(-4.0f, 4.0f);
    const float tall = random.range(0.6f, 1.0f) * (29.0f - 14.0f * front);
    put_stroke(canvas,
               {x, 31.5f, x + lean * 0.1f, 31.5f - tall * 0.7f, std::clamp(x + lean, 0.5f, 31.5f),
                32.0f - tall, 2.3f, 1.0f},
               tones, 0.14f + 0.2f * front, 0.5f + 0.25f * front);
  }
  return canvas;
}

Canvas paint_fern(Color base, Color tip, std::uint32_t seed) {
  Canvas canvas = empty_canvas();
  Random random(seed);
  const Ramp tones = ramp(base, 0.72f), tips = ramp(tip, 0.66f);
  // Ends of the fronds and how high they arch; back fronds first.
  constexpr float kFronds[][3] = {{9, 4, 10},     {23.5f, 3, 8}, {16, 1, 12}, {1.5f, 18, 6},
                                  {30.5f, 17, 5}, {4, 26, 19},   {28, 26, 19}};
  for (const auto& [end_x, end_y, arch] : kFronds) {
    const Stroke spine{16, 31.5f, 16 + (end_x - 16) * 0.35f, arch, end_x, end_y, 1.0f, 1.0f};
    constexpr int kPairs = 9;
    for (int i = 2; i <= kPairs; ++i) {
      const float t = static_cast<float>(i) / kPairs, r = 1.0f - t;
      const float x = r * r * spine.x0 + 2 * r * t * spine.x1 + t * t * spine.x2;
      const float y = r * r * spine.y0 + 2 * r * t * spine.y1 + t * t * spine.y2;
      const float along_x = r * (spine.x1 - spine.x0) + t * (spine.x2 - spine.x1);
      const float along_y = r * (spine.y1 - spine.y0) + t * (spine.y2 - spine.y1);
      const float length = std::sqrt(along_x * along_x + along_y * along_y) + 0.001f;
      const float reach = (1.2f + 3.0f * r) * random.range(0.85f, 1.1f);
      // Leaflets stand out to both sides and lean towards the tip.
      for (const float side : {-1.0f, 1.0f}) {
        const float way_x = (-along_y * side + 0.6f * along_x) / length,
                    way_y = (along_x * side + 0.6f * along_y) / length;
        put_stroke(canvas,
                   {x, y, x + way_x * reach * 0.5f, y + way_y * reach * 0.5f, x + way_x * reach,
                    y + way_y * reach, 1.0f, 1.0f},
                   t > 0.7f ? tips : tones, 0.3f + 0.2f * t,
                   (way_y < 0 ? 0.62f : 0.42f) + 0.15f * t);
      }
    }
    put_stroke(canvas, spine, tones, 0.12f, 0.45f);
  }
  return canvas;
}

Canvas paint_flower(Color petal, Color center, Flower flower, std::uint32_t seed) {
  Canvas canvas = empty_canvas();
  Random random(seed);
  const Ramp stem = ramp(hex(0x66803f), 0.7f), petals = ramp(petal, 0.62f);
  // A tuft of leaves, then three stems out of it.
  for (int i = 0; i < 9; ++i) {
    const float lean = (static_cast<float>(i) - 4.0f) * 2.9f, tall = random.range(6.0f, 11.5f);
    put_stroke(canvas,
               {16 + lean * 0.35f, 31.5f, 16 + lean * 0.6f, 31.0f - tall, 16 + lean, 32.0f - tall,
                2.2f, 1.0f},
               stem, 0.18f, 0.5f);
  }
  constexpr float kHeads[][3] = {{12.5f, 6.5f, 14.5f}, {19.5f, 25.5f, 12.0f}, {16.0f, 15.5f, 5.0f}};
  for (const auto& [root, head_x, head_y] : kHeads) {
    const float y = head_y + random.range(-0.6f, 0.6f);
    put_stroke(canvas, {root, 31.5f, root + (head_x - root) * 0.3f, 22.0f, head_x, y, 1.4f, 1.2f},
               stem, 0.25f, 0.6f);
    put_flower_head(canvas, head_x + 0.5f, y + 0.5f, flower, petals, center);
  }
  return canvas;
}

Canvas paint_reed() {
  Canvas canvas = empty_canvas();
  const Ramp stalk = ramp(hex(0x86915a), 0.7f), head = ramp(hex(0x6d4a33), 0.7f);
  constexpr float kStalks[][3] = {{5, 3.5f, 11},  {10, 10.5f, 5}, {15, 16, 13},
                                  {20.5f, 20, 3}, {25, 27, 8},    {28, 29.5f, 16}};
  for (const auto& [root, tip, top] : kStalks)
    put_stroke(canvas, {root, 31.5f, root, 18, tip, top, 1.8f, 1.0f}, stalk, 0.2f, 0.62f);
  constexpr float kBlades[][3] = {{7, 1.5f, 17}, {13, 18.5f, 10}, {18, 12, 19}, {23, 30, 20}};
  for (const auto& [root, tip, top] : kBlades)
    put_stroke(canvas, {root, 31.5f, root, top + 2, tip, top, 2.2f, 1.0f}, stalk, 0.3f, 0.75f);
  for (const int i : {1, 3, 4})
    put_dab(canvas, {kStalks[i][1], kStalks[i][2] + 4.0f, {0, 1}, 3.8f, 1.5f}, head, 0.5f);
  return canvas;
}

Canvas paint_dead_bush() {
  Canvas canvas = empty_canvas();
  const Ramp twig = ramp(hex(0x8a6c4c), 0.7f);
  constexpr float kTwigs[][6] = {
      {16, 31.5f, 15, 24, 6, 15}, {16, 31.5f, 18, 22, 26, 13}, {16, 31.5f, 16, 20, 14, 6},
      {16, 31.5f, 10, 27, 2, 24}, {16, 31.5f, 23, 28, 30, 22}, {11, 20, 8, 17, 10, 9},
      {20, 19, 23, 14, 21, 6},    {9, 18, 5, 17, 3, 14},       {23, 16, 27, 16, 30, 11},
      {15, 16, 18, 12, 18, 8},    {7, 26, 5, 22, 6, 20},       {25, 25, 26, 22, 24, 19}};
  for (const auto& t : kTwigs)
    put_stroke(canvas, {t[0], t[1], t[2], t[3], t[4], t[5], 1.9f, 1.0f}, twig, 0.25f, 0.6f);
  return canvas;
}

Canvas paint_glow_shroom() {
  Canvas canvas = empty_canvas();
  const Ramp stem = ramp(hex(0x8fa39b), 0.6f);
  const Ramp cap{{hex(0x1f5a66), hex(0x2f8f93), hex(0x55c6b8), hex(0x96ecd4), hex(0xdcfff0)}};
  constexpr float kShrooms[][4] = {{8, 19, 5.0f, 3.6f},
                                   {24, 22, 4.6f, 3.2f},
                                   {16, 9, 7.0f, 5.0f},
                                   {28, 28, 2.6f, 1.9f},
                                   {4, 28, 2.6f, 1.9f}};
  for (const auto& [x, top, wide, tall] : kShrooms) {
    const float root = x + (16 - x) * 0.12f;
    put_stroke(canvas, {root, 31.5f, root, (top + 32) * 0.5f, x, top, 2.6f, 2.0f}, stem, 0.3f,
               0.6f);
    for_dab({x, top, {1, 0}, wide, tall},
            [&, top = top, tall = tall](int px, int py, float u, float) {
              const float down = (static_cast<float>(py) + 0.5f - top) / tall;
              if (down > 0.25f) return;
              const bool gills = down > 0.02f;
              canvas.set_clipped(px, py,
                                 cap.at(gills ? 0.18f + 0.5f * static_cast<float>(px & 1)
                                              : 0.62f - 0.28f * u - 0.3f * down));
            });
    put_dab(canvas, {x - wide * 0.35f, top - tall * 0.5f, {1, 0}, 0.9f, 0.8f}, cap, 0.95f);
  }
  return canvas;
}

Canvas paint_heather() {
  Canvas canvas = empty_canvas();
  Random random(911);
  const Ramp stem = ramp(hex(0x66704a), 0.7f), bell = ramp(hex(0xa0709a), 0.66f);
  constexpr float kSprigs[][3] = {{4, 2.5f, 16},   {8, 7, 9},    {12, 11, 13},
                                  {16, 17, 6},     {20, 21, 11}, {24, 26, 8},
                                  {28, 29.5f, 15}, {14, 14, 19}, {22, 23, 19}};
  for (const auto& [root, tip, top] : kSprigs) {
    put_stroke(canvas, {root, 31.5f, root, 24, tip, top, 1.4f, 1.0f}, stem, 0.2f, 0.5f);
    for (float y = 30.0f; y > top + 9.0f; y -= 2.0f) {
      const float side = random.next() < 0.5f ? -1.6f : 1.6f,
                  x = root + (tip - root) * (31.5f - y) / 25.0f;
      put_stroke(canvas, {x, y, x + side * 0.5f, y - 1.0f, x + side, y - 1.6f, 1.0f, 1.0f}, stem,
                 0.35f, 0.6f);
    }
    for (float y = top; y < top + 10.5f; y += 1.7f) {
      const float side = random.range(-1.4f, 1.4f);
      put_dab(canvas, {tip + (root - tip) * (y - top) / 20.0f + side, y, {1, 0}, 1.2f, 1.0f}, bell,
              random.range(0.4f, 0.75f));
    }
  }
  return canvas;
}

Canvas paint_wheat() {
  Canvas canvas = empty_canvas();
  Random random(921);
  const Ramp straw = ramp(hex(0xb99a55), 0.66f), ear = ramp(hex(0xd0ad62), 0.66f);
  for (int i = 0; i < 10; ++i) {
    const float root = 2.0f + 3.1f * static_cast<float>(i), lean = random.range(-2.8f, 2.8f),
                top = 2.0f + 9.0f * unit(i, 7, 922);
    const float tip = std::clamp(root + lean, 2.0f, 30.0f);
    put_stroke(canvas, {root, 31.5f, root, 18, tip, top, 1.2f, 1.0f}, straw, 0.2f, 0.55f);
    for (int grain = 0; grain < 5; ++grain) {
      const float side = grain % 2 == 0 ? -0.9f : 0.9f;
      put_dab(canvas, {tip + side, top + 1.5f * static_cast<float>(grain), {0, 1}, 1.5f, 0.9f}, ear,
              0.7f - 0.07f * static_cast<float>(grain));
    }
  }
  return canvas;
}

Canvas paint_kelp() {
  Canvas canvas = empty_canvas();
  const Ramp blade = ramp(hex(0x5f7042), 0.7f);
  constexpr float kStems[][2] = {{6, 3}, {13, -3}, {20, 3}, {27, -2}};
  for (const auto& [root, sway] : kStems) {
    put_stroke(canvas, {root, 31.5f, root + sway * 2, 16, root, 0, 1.8f, 1.4f}, blade, 0.25f, 0.5f);
    for (int i = 0; i < 7; ++i) {
      const float y = 29.0f - 4.2f * static_cast<float>(i), side = i % 2 == 0 ? 1.0f : -1.0f;
      const float t = (31.5f - y) / 31.5f, x = root + 4.0f * sway * t * (1.0f - t);
      put_dab(canvas, {x + side * 2.2f, y - 0.8f, {0.8f, -0.6f * side}, 2.7f, 1.1f}, blade,
              0.5f + 0.1f * side);
    }
  }
  return canvas;
}

Canvas paint_torch() {
  Canvas canvas = empty_canvas();
  // Darker than what glows (BlockType::glows_from), and so dark that the flame just above does not
  // bleach it.
  const Ramp post = ramp(hex(0x4f3722), 0.8f), iron = ramp(hex(0x33312f), 0.6f);
  for (int y = 13; y < kEdge; ++y)
    for (int x = 14; x < 18; ++x) {
      const float grain =
          0.9f * gradient_noise(static_cast<float>(x) + 0.5f, static_cast<float>(y), {16, 8}, 931);
      const bool band = y < 17;
      const float soot = 0.05f * static_cast<float>(std::max(0, 25 - y));
      canvas.set(x, y,
                 band ? iron.at(0.6f - 0.26f * static_cast<float>(x - 14))
                      : post.at(0.8f - 0.24f * static_cast<float>(x - 14) + grain - soot));
    }
  // The flame: three nested drops from red to nearly white.
  constexpr Color kFire[] = {hex(0xd2571f), hex(0xf39a33), hex(0xffe08a), hex(0xfff8dc)};
  constexpr float kSize[][3] = {
      {8.0f, 6.2f, 4.4f}, {8.8f, 4.8f, 3.3f}, {9.8f, 3.4f, 2.2f}, {10.6f, 2.0f, 1.2f}};
  for (int i = 0; i < 4; ++i) {
    const auto& [y, tall, wide] = kSize[i];
    for_dab({16, y, {0, -1}, tall, wide}, [&](int px, int py, float u, float v) {
      // A drop: narrow above, where u is positive.
      if (v * v < (1.0f - u) * 0.75f) canvas.set_clipped(px, py, kFire[i]);
    });
  }
  return canvas;
}

}  // namespace skerry::textures
