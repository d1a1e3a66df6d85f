// Logs, planks and what is made of them.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {
namespace {

// Long fibres along y that flow around each other.
float fibre(int x, int y, Cells cells, std::uint32_t seed) {
  const float bend = 2.0f * noise_at(x, y, {3, 2}, seed + 1);
  return gradient_noise(static_cast<float>(x) + 0.5f + bend, static_cast<float>(y), cells, seed);
}

Canvas paint_birch(Color base) {
  const Ramp tones = ramp(base, 0.45f);
  Canvas canvas = paint(tones, make_field([&](int x, int y) {
                          return 0.58f + 0.4f * fibre(x, y, {6, 3}, 812);
                        }),
                        8);
  // Dark lenticels lie across the trunk.
  Random random(813);
  for (int i = 0; i < 15; ++i) {
    const auto [center_x, center_y] = spread_point(i, 814);
    const Dab mark{center_x, center_y, {1, 0}, random.range(1.5f, 4.5f), random.range(0.5f, 1.1f)};
    for_dab(mark, [&](int x, int y, float u, float) {
      canvas.set(x, y, mix(hex(0x3b3532), hex(0x6f655d), u * u));
    });
    canvas.tint(static_cast<int>(mark.x), static_cast<int>(mark.y) + 1, tones.tones[4], 0.6f);
  }
  return canvas;
}

Canvas paint_plated(Color base, std::uint32_t seed) {
  const Field height = make_field([&](int x, int y) {
    const Cellular plate = cell_at(x, y, {5, 3}, 0.85f, seed);
    return std::min(1.0f, 2.4f * (plate.second - plate.nearest));
  });
  const Field light = relief(height);
  return paint(ramp(base, 0.7f), make_field([&](int x, int y) {
                 const float gap = height.at(x, y) < 0.3f ? -0.3f : 0.0f;
                 return 0.5f + 0.17f * light.at(x, y) + gap + 0.3f * fibre(x, y, {8, 3}, seed + 4);
               }));
}

Canvas paint_ringed(Color base, std::uint32_t seed) {
  // Palm: collars of old leaf stems, eight texels apart, with a ragged lower rim.
  return paint(ramp(base, 0.65f), make_field([&](int x, int y) {
                 const float sag = 1.6f * noise_at(x, y, {3, 4}, seed);
                 const int row =
                     wrap(static_cast<int>(std::floor(static_cast<float>(y) + sag))) % 8;
                 const float collar = row == 7   ? -0.34f
                                      : row == 0 ? 0.22f
                                                 : 0.06f - 0.035f * static_cast<float>(row);
                 return 0.52f + collar + 0.34f * noise_at(x, y, {10, 4}, seed + 1);
               }));
}

}  // namespace

Canvas paint_bark(Color base, Bark bark, std::uint32_t seed) {
  if (bark == Bark::kBirch) return paint_birch(base);
  if (bark == Bark::kPlated) return paint_plated(base, seed);
  if (bark == Bark::kRinged) return paint_ringed(base, seed);
  // Ridges run up the trunk and split; fibrous bark is the same with finer, shallower ridges.
  const Cells ridges = bark == Bark::kRidged ? Cells{6, 2} : Cells{9, 2};
  const Field height = make_field(
      [&](int x, int y) { return std::min(1.0f, 4.0f * absolute(fibre(x, y, ridges, seed))); });
  const Field light = relief(height);
  return paint(
      ramp(base, 0.72f), make_field([&](int x, int y) {
        const float furrow = height.at(x, y) < 0.3f ? -0.24f : 0.08f;
        return 0.5f + 0.16f * light.at(x, y) + furrow + 0.28f * fibre(x, y, {12, 4}, seed + 3);
      }));
}

Canvas paint_log_top(Color wood, Color bark, std::uint32_t seed) {
  const Ramp rings = ramp(wood, 0.6f), rim = ramp(bark, 0.7f);
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const float dx = static_cast<float>(x) - 15.2f, dy = static_cast<float>(y) - 16.1f;
      const float wobble = 1.3f * noise_at(x, y, {3, 3}, seed);
      const float round = std::sqrt(dx * dx + dy * dy);
      const float square = std::max(absolute(dx), absolute(dy));
      // Rings are round at the heart and follow the block's square outline at the bark.
      const float outward = std::min(square / 16.0f, 1.0f);
      const float radius = round + (square - round) * outward + wobble;
      const float ring = radius / 2.7f - std::floor(radius / 2.7f);
      const bool in_bark = square + 0.5f * wobble > 13.9f;
      if (in_bark) {
        canvas.set(x, y, rim.at(0.42f + 0.5f * noise_at(x, y, {10, 10}, seed + 1)));
      } else {
        const float check =
            absolute(dx - dy * 0.35f) < 0.6f && dy > 2.0f && dy < 9.0f ? -0.3f : 0.0f;
        const float heart = round < 2.0f ? -0.16f : 0.0f;
        canvas.set(x, y,
                   rings.at(0.6f - (ring > 0.62f ? 0.24f : 0.06f * ring) + check + heart +
                            0.2f * noise_at(x, y, {8, 8}, seed + 2)));
      }
    }
  }
  return canvas;
}

Canvas paint_planks(Color wood, std::uint32_t seed) {
  const Ramp tones = ramp(wood, 0.62f);
  Canvas canvas =
      paint(tones, make_field([&](int x, int y) {
              const int board = y / 8, row = y % 8;
              const int end = static_cast<int>(unit(board, 1, seed) * kEdge);
              const float grain = gradient_noise(
                  static_cast<float>(x) + 0.5f,
                  static_cast<float>(row) + 0.5f + 1.5f * noise_at(x, y, {3, 4}, seed + 2), {3, 16},
                  seed + 3 + static_cast<std::uint32_t>(board));
              const float edge = row == 7 ? -0.36f : row == 0 ? 0.12f : 0.0f;
              const float joint = wrap(x - end) == 0 && row < 7 ? -0.32f
                                  : wrap(x - end) == 1          ? 0.09f
                                                                : 0.0f;
              return 0.52f + 0.13f * (unit(board, 2, seed) - 0.5f) + 0.32f * grain + edge + joint;
            }));
  // A nail at both sides of every joint.
  for (int board = 0; board < 4; ++board) {
    const int end = static_cast<int>(unit(board, 1, seed) * kEdge);
    for (const int side : {-2, 3}) canvas.tint(end + side, board * 8 + 3, tones.tones[0], 0.8f);
  }
  return canvas;
}

Canvas paint_parquet(Color wood, Color other, std::uint32_t seed) {
  const Ramp light = ramp(wood, 0.6f), dark = ramp(other, 0.6f);
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      // Squares of four strips, every other square turned.
      const bool turned = (x / 16 + y / 16) % 2 != 0;
      const int along = turned ? y : x, across = turned ? x : y;
      const int strip = across / 4;
      const float edge = across % 4 == 3 ? -0.22f : across % 4 == 0 ? 0.06f : 0.0f;
      const float end = along % 16 == 15 ? -0.22f : 0.0f;
      const float grain = turned ? noise_at(x, y, {16, 4}, seed) : noise_at(x, y, {4, 16}, seed);
      const float share = unit(strip, turned ? x / 16 + 8 : x / 16, seed);
      canvas.set(x, y,
                 mix(light.at(0.52f + edge + end + 0.25f * grain),
                     dark.at(0.52f + edge + end + 0.25f * grain), share));
    }
  }
  return canvas;
}

Canvas paint_crate(Color wood, Color frame, std::uint32_t seed) {
  Canvas canvas = paint_planks(wood, seed);
  const Ramp tones = ramp(frame, 0.6f);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const int inset = std::min(std::min(x, kEdge - 1 - x), std::min(y, kEdge - 1 - y));
      const float diagonal = absolute(static_cast<float>(x - y));
      const bool brace = diagonal < 3.0f && inset > 3;
      if (inset > 3 && !brace) {
        if (inset == 4 || diagonal < 4.0f) canvas.tint(x, y, hex(0x241c18), 0.4f);
        continue;
      }
      const bool vertical = inset == std::min(x, kEdge - 1 - x);
      const float grain =
          vertical ? noise_at(x, y, {12, 3}, seed + 7) : noise_at(x, y, {3, 12}, seed + 7);
      const float lip = inset == 0 || inset == 3 ? -0.12f : 0.05f;
      canvas.set(x, y, tones.at(0.52f + 0.3f * grain + (brace ? 0.0f : lip)));
      const bool nail = (x == 2 || x == 29) && (y == 2 || y == 29);
      if (nail) canvas.set(x, y, hex(0x4a4644));
    }
  }
  return canvas;
}

Canvas paint_barrel_side(Color wood, Color hoop) {
  const Ramp staves = ramp(wood, 0.62f), metal = ramp(hoop, 0.6f);
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const int stave = x / 4;
      const float edge = x % 4 == 3 ? -0.3f : x % 4 == 0 ? 0.1f : 0.0f;
      const bool band = (y >= 4 && y < 8) || (y >= 24 && y < 28);
      const bool shadow = y == 8 || y == 28;
      if (band) {
        const float round = y % 4 == 0 ? 0.2f : y % 4 == 3 ? -0.25f : 0.0f;
        const bool rivet = x % 8 == 2 && y % 4 == 1;
        canvas.set(
            x, y,
            metal.at(0.5f + round + (rivet ? 0.4f : 0.0f) + 0.14f * noise_at(x, y, {8, 8}, 851)));
      } else {
        const float tone = 0.53f + edge + 0.14f * (unit(stave, 0, 852) - 0.5f) +
                           0.3f * noise_at(x, y, {12, 3}, 853);
        canvas.set(x, y, staves.at(tone - (shadow ? 0.25f : 0.0f)));
      }
    }
  }
  return canvas;
}

Canvas paint_barrel_top(Color wood, Color hoop) {
  Canvas canvas = paint_planks(wood, 861);
  const Ramp metal = ramp(hoop, 0.6f);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const int inset = std::min(std::min(x, kEdge - 1 - x), std::min(y, kEdge - 1 - y));
      if (inset < 2)
        canvas.set(
            x, y,
            metal.at(0.48f + (inset == 0 ? 0.15f : -0.1f) + 0.2f * noise_at(x, y, {8, 8}, 862)));
      if (inset == 2) canvas.tint(x, y, hex(0x1f1a1a), 0.5f);
    }
  }
  return canvas;
}

Canvas paint_bookshelf(Color wood) {
  const Color spines[] = {hex(0x7c3b34), hex(0x3f5a6b), hex(0x6b6a3d), hex(0x8a6a3f),
                          hex(0x54405e), hex(0x3f6052), hex(0x9c8a6a)};
  Canvas canvas = paint_planks(wood, 871);
  Random random(872);
  for (const int shelf : {3, 18}) {
    for (int x = 0; x < kEdge;) {
      const int width = std::min(2 + random.below(3), kEdge - x), height = 9 + random.below(3);
      const Ramp tones = ramp(spines[random.below(7)], 0.6f);
      for (int column = 0; column < width; ++column) {
        const float round = column == 0 ? 0.14f : column == width - 1 ? -0.22f : 0.0f;
        for (int y = 0; y < 11; ++y) {
          const bool gilt = y == 11 - height + 2 || y == 8;
          const Color color =
              y < 11 - height ? hex(0x241c1c) : tones.at(0.5f + round + (gilt ? 0.3f : 0.0f));
          canvas.set(x + column, shelf + y, color);
        }
      }
      x += width;
    }
  }
  return canvas;
}

}  // namespace skerry::textures
