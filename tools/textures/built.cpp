// What builders make: glass, masonry, roofs, metal, straw.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {
namespace {

int inset_of(int x, int y) {
  return std::min(std::min(x, kEdge - 1 - x), std::min(y, kEdge - 1 - y));
}

// Light on the upper left of a raised square, shade on its lower right. @param edge of the squares
// [texels].
float bevel(int x, int y, int edge, float strength) {
  const int i = x % edge, j = y % edge;
  if (i == edge - 1 || j == edge - 1) return -strength;
  return i == 0 || j == 0 ? 0.6f * strength : 0.0f;
}

// Engraved ornaments; i and j count from the middle of the block, 0..15. @return -1 groove, 1 lit
// rim, 0 plain.
int ornament(int i, int j, std::uint32_t kind) {
  const int diamond = i + j, square = std::max(i, j), round = i * i + j * j;
  const auto line = [](int value, int at) { return value == at ? -1 : value == at + 1 ? 1 : 0; };
  switch (kind % 4u) {
    case 0:
      return diamond < 11 ? (diamond < 3 ? -1 : line(diamond, 8)) : 0;
    case 1:
      return round < 110 ? (round > 80 ? -1 : round > 62 ? 1 : round < 12 ? -1 : 0) : 0;
    case 2:
      return square < 11 ? (square == 9                         ? -1
                            : square == 5 && std::min(i, j) < 5 ? -1
                            : square == 6                       ? 1
                                                                : 0)
                         : 0;
    default:
      return square < 11 && square > 1 ? (i * j < 10 ? -1 : i * j < 17 ? 1 : 0) : 0;
  }
}

float brick_tone(int x, int y, std::uint32_t seed, bool& mortar) {
  const int course = y / 8, row = y % 8;
  const int shifted = wrap(x + (course % 2) * 8), brick = shifted / 16, column = shifted % 16;
  mortar = row == 7 || column == 15;
  const float rim = row == 0 || column == 0 ? 0.1f : row == 6 || column == 14 ? -0.12f : 0.0f;
  return rim + 0.16f * (unit(course, brick, seed) - 0.5f);
}

}  // namespace

Canvas paint_glass(Color tint, Color frame, float pane_cover) {
  const Ramp bar = ramp(frame, 0.4f);
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      // A thin frame, and two slanting smears on the pane.
      const int slant = wrap(x + y + 3);
      const bool smear = (slant < 4 || slant == 6) && inset_of(x, y) > 3;
      if (inset_of(x, y) == 0) {
        canvas.set(x, y, bar.at(0.5f + 0.2f * noise_at(x, y, {8, 8}, 1002)));
      } else {
        canvas.at(x, y) = {smear ? mix(tint, hex(0xffffff), 0.5f) : tint,
                           pane_cover + (smear ? 0.06f : 0.0f)};
      }
    }
  }
  return canvas;
}

Canvas paint_bricks(Color brick, Color mortar, std::uint32_t seed) {
  const Ramp clay = ramp(brick, 0.62f), joint = ramp(mortar, 0.45f);
  const Field grain = stone_tone({8, 8}, 0.2f, seed);
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      bool is_mortar = false;
      const float tone = grain.at(x, y) + brick_tone(x, y, seed, is_mortar);
      canvas.set(x, y, is_mortar ? joint.at(grain.at(x, y) - 0.1f) : clay.at(tone));
    }
  }
  return canvas;
}

Canvas paint_masonry(const Ramp& stone, Masonry style, std::uint32_t seed) {
  const Field grain =
      brush({110, 2.0f, 4.5f, 0.42f, -0.1f, 0.1f, style == Masonry::kBricks ? 0.12f : 0.07f}, seed);
  return paint(
      stone, make_field([&](int x, int y) {
        const float tone = grain.at(x, y);
        switch (style) {
          case Masonry::kPolished:
            return tone + bevel(x, y, kEdge, 0.22f);
          case Masonry::kBricks: {
            bool mortar = false;
            const float brick = brick_tone(x, y, seed, mortar);
            return tone + (mortar ? -0.32f : brick);
          }
          case Masonry::kTiles:
            return tone + bevel(x, y, 16, 0.24f) + ((x / 16 + y / 16) % 2 == 0 ? 0.07f : -0.07f);
          case Masonry::kCarved: {
            const int i = x < 16 ? 15 - x : x - 16, j = y < 16 ? 15 - y : y - 16;
            const int frame = inset_of(x, y) == 2 ? -1 : inset_of(x, y) == 3 ? 1 : 0;
            const int cut = frame != 0 ? frame : ornament(i, j, seed);
            // The far wall of a groove catches the light.
            const float light = x + y < kEdge ? 0.0f : 0.08f;
            return tone + 0.6f * bevel(x, y, kEdge, 0.2f) +
                   (cut < 0   ? -0.3f + light
                    : cut > 0 ? 0.16f
                              : 0.0f);
          }
          default: {
            // Flutes: half-round hollows, eight texels wide.
            const int flute = x % 8;
            constexpr float kProfile[] = {0.2f, -0.24f, -0.16f, -0.06f, 0.02f, 0.1f, 0.14f, 0.04f};
            return tone + kProfile[flute];
          }
        }
      }),
      9);
}

Canvas paint_lamp(Color glow, Color frame) {
  const Ramp metal = ramp(frame, 0.6f);
  const Ramp light{{mix(glow, hex(0x8a4f24), 0.6f), mix(glow, hex(0xb87434), 0.35f), glow,
                    mix(glow, hex(0xfff6dc), 0.5f), hex(0xfffaea)}};
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const int inset = inset_of(x, y);
      const bool bar = inset < 3 || x == 15 || x == 16 || y == 15 || y == 16;
      const float i = (static_cast<float>(x % 16) - 7.5f) / 8.0f,
                  j = (static_cast<float>(y % 16) - 7.5f) / 8.0f;
      const float edge = inset == 0 ? 0.14f : inset == 2 ? -0.2f : 0.0f;
      canvas.set(
          x, y,
          bar ? metal.at(0.48f + edge + 0.25f * noise_at(x, y, {8, 8}, 1011))
              : light.at(0.85f - 0.42f * (i * i + j * j) + 0.12f * noise_at(x, y, {6, 6}, 1012)));
    }
  }
  return canvas;
}

Canvas paint_shingles(Color base, std::uint32_t seed) {
  return paint(ramp(base, 0.66f), make_field([&](int x, int y) {
                 // Rows eight high, each moved by half a shingle; the lower rim is round.
                 const int course = y / 8, row = y % 8, shifted = wrap(x + (course % 2) * 4),
                           column = shifted % 8;
                 const bool corner = row == 7 && (column < 2 || column > 5);
                 const bool gap = column == 7 && row < 6;
                 const float rim =
                     row == 7 || (row == 6 && (column == 0 || column == 7)) ? -0.16f : 0.0f;
                 const float tone = 0.16f * (unit(shifted / 8, course, seed) - 0.5f) +
                                    0.035f * static_cast<float>(row) - 0.08f;
                 const float grain = 0.26f * noise_at(x, y, {12, 5}, seed + 1);
                 return 0.5f + tone + grain + rim + (corner || gap ? -0.26f : 0.0f) +
                        (row == 0 ? -0.18f : 0.0f);
               }));
}

Canvas paint_metal_plate(Color base, std::uint32_t seed) {
  const Ramp tones = ramp(base, 0.6f);
  Canvas canvas = paint(tones, make_field([&](int x, int y) {
                          const float brushed = 0.22f * noise_at(x, y, {2, 16}, seed) +
                                                0.12f * noise_at(x, y, {4, 4}, seed + 1);
                          return 0.5f + brushed + bevel(x, y, kEdge, 0.26f);
                        }),
                        10);
  for (const int y : {4, 27}) {
    for (const int x : {4, 27}) {
      canvas.set(x, y, tones.tones[4]);
      canvas.set(x + 1, y + 1, tones.tones[0]);
      canvas.tint(x + 1, y, tones.tones[1], 0.6f);
      canvas.tint(x, y + 1, tones.tones[1], 0.6f);
    }
  }
  return canvas;
}

Canvas paint_metal_tread(Color base, std::uint32_t seed) {
  const Ramp tones = ramp(base, 0.62f);
  Canvas canvas = paint(tones, make_field([&](int x, int y) {
                          return 0.42f + 0.2f * noise_at(x, y, {6, 6}, seed);
                        }),
                        10);
  // Raised bars, turned a quarter from cell to cell.
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const Direction way =
          (row + column) % 2 == 0 ? Direction{0.7071f, 0.7071f} : Direction{0.7071f, -0.7071f};
      const float x = 4.0f + 8.0f * static_cast<float>(column),
                  y = 4.0f + 8.0f * static_cast<float>(row);
      for_dab({x + 0.9f, y + 0.9f, way, 3.6f, 1.5f},
              [&](int px, int py, float, float) { canvas.tint(px, py, tones.tones[0], 0.6f); });
      for_dab({x, y, way, 3.6f, 1.4f}, [&](int px, int py, float, float v) {
        canvas.set(px, py, tones.at(0.72f + 0.18f * v));
      });
    }
  }
  return canvas;
}

Canvas paint_lattice(Color base, bool diagonal) {
  const Ramp tones = ramp(base, 0.62f);
  Canvas canvas = empty_canvas();
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const int a = diagonal ? wrap(x + y) % 8 : x % 8, b = diagonal ? wrap(x - y) % 8 : y % 8;
      const bool first = a < 3, second = b < 3;
      if (!first && !second) continue;
      // The strips pass over and under each other in turn.
      const bool over = ((diagonal ? wrap(x + y) / 8 + wrap(x - y) / 8 : x / 8 + y / 8) % 2 == 0)
                            ? first
                            : !second;
      const int across = over ? a : b;
      const float grain = 0.3f * noise_at(x, y, {8, 8}, 1021);
      canvas.set(x, y,
                 tones.at(0.52f +
                          (across == 0   ? 0.18f
                           : across == 2 ? -0.22f
                                         : 0.0f) +
                          grain));
    }
  }
  return canvas;
}

Canvas paint_thatch(Color base, bool ends, std::uint32_t seed) {
  Random random(seed);
  const Ramp tones = ramp(base, 0.66f);
  Field tone = make_field([](int, int) { return 0.22f; });
  constexpr int kStraws = 300;
  for (int i = 0; i < kStraws; ++i) {
    const float age = static_cast<float>(i) / kStraws,
                light = 0.34f + 0.22f * age + random.range(-0.12f, 0.12f);
    const auto [x, y] = spread_point(i, seed);
    if (ends) {
      // Cut straw seen from its end: round, with a dark rim.
      for_dab({x, y, {1, 0}, 1.9f, 1.9f}, [&](int px, int py, float u, float v) {
        tone.at(px, py) = u * u + v * v > 0.62f ? light - 0.16f : light + 0.06f - 0.1f * (u + v);
      });
    } else {
      for_dab({x, y, direction(random.range(0.21f, 0.29f)), random.range(3.0f, 6.0f), 0.62f},
              [&](int px, int py, float u, float) { tone.at(px, py) = light - 0.1f * u; });
    }
  }
  return paint(tones, flatten(tone, 0.85f), 9);
}

Canvas paint_basket(Color base, std::uint32_t seed) {
  return paint(ramp(base, 0.66f), make_field([&](int x, int y) {
                 const bool across = (x / 8 + y / 8) % 2 == 0;
                 const int along = (across ? x : y) % 8, side = (across ? y : x) % 4;
                 constexpr float kRound[] = {-0.2f, 0.06f, 0.12f, 0.02f, 0.02f, 0.08f, 0.0f, -0.2f};
                 const float edge = side == 3 ? -0.26f : side == 0 ? 0.08f : 0.0f;
                 return 0.5f + kRound[along] + edge + 0.22f * noise_at(x, y, {10, 10}, seed);
               }));
}

Canvas paint_rope(Color base) {
  return paint(ramp(base, 0.66f), make_field([](int x, int y) {
                 // Coils eight high; strands slant across each.
                 const int row = y % 8, strand = wrap(x + row) % 4;
                 constexpr float kRound[] = {-0.24f, 0.04f, 0.14f,  0.12f,
                                             0.06f,  0.0f,  -0.08f, -0.3f};
                 return 0.5f + kRound[row] +
                        (strand == 0   ? -0.2f
                         : strand == 1 ? 0.1f
                                       : 0.0f) +
                        0.16f * noise_at(x, y, {12, 12}, 1031);
               }));
}

}  // namespace skerry::textures
