#pragma once
#include <array>
#include <cmath>

#include "tools/textures/color.h"
#include "tools/textures/noise.h"

namespace skerry::textures {

inline constexpr int kTexels = kEdge * kEdge;

/// One number a texel, row 0 at the top; coordinates wrap around all four edges.
class Field {
 public:
  float& at(int x, int y) { return values_[wrap(x) + kEdge * wrap(y)]; }
  float at(int x, int y) const { return values_[wrap(x) + kEdge * wrap(y)]; }
  std::array<float, kTexels>& values() { return values_; }
  const std::array<float, kTexels>& values() const { return values_; }

 private:
  std::array<float, kTexels> values_{};
};

/// A field of value(x, y) for every texel.
template <class Value>
Field make_field(Value&& value) {
  Field field;
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x) field.at(x, y) = value(x, y);
  return field;
}
/// fbm() as a field whose values are spread evenly over 0..1.
Field even_fbm(Cells cells, int octaves, std::uint32_t seed);
/// Replaces values by their rank over the texel count: an even spread over 0..1, whatever the
/// noise.
Field equalize(const Field& field);
/// How much a height field's slope faces the light at the top left; about -1..1 for heights of
/// 0..1.
Field relief(const Field& height);
/// Mean over a (2 radius + 1)^2 square, twice.
Field blur(const Field& field, int radius);
/// Takes out `amount` (0..1) of what is wider than some eight texels: such blotches would show the
/// repetition of a texture over a wide field.
Field flatten(const Field& field, float amount);

/// The texture being painted. Alpha is coverage: 1 for solid matter; 0 or 1 where shapes are cut
/// out; in between for what is seen through (glass, water), where it says how much of the light a
/// film on the surface catches.
class Canvas {
 public:
  struct Texel {
    Color color;
    float alpha = 1.0f;
  };
  Texel& at(int x, int y) { return texels_[wrap(x) + kEdge * wrap(y)]; }
  const Texel& at(int x, int y) const { return texels_[wrap(x) + kEdge * wrap(y)]; }
  /// Sets an opaque colour, coordinates wrapped.
  void set(int x, int y, Color color) { at(x, y) = {color, 1.0f}; }
  /// Sets an opaque colour, or nothing outside the texture: for plants, which do not tile.
  void set_clipped(int x, int y, Color color) {
    if (x >= 0 && x < kEdge && y >= 0 && y < kEdge) set(x, y, color);
  }
  /// Mixes the colour already there towards `color`.
  void tint(int x, int y, Color color, float amount) {
    at(x, y).color = mix(at(x, y).color, color, amount);
  }

 private:
  std::array<Texel, kTexels> texels_{};
};

/// A canvas without any coverage.
Canvas empty_canvas();
/// Colours of `ramp` at `tone`, drawn together into `steps` flat tones with soft edges, as a brush
/// leaves them.
Canvas paint(const Ramp& ramp, const Field& tone, int steps = 7);

/// A unit vector; `turn` 0..1 goes once around from +x over +y. Rational, so no sine decides a
/// byte.
struct Direction {
  float x, y;
};
Direction direction(float turn);

/// An elliptic touch of the brush.
struct Dab {
  float x, y;       ///< centre [texels]
  Direction along;  ///< its long axis
  float half_length, half_width;
};

/// Calls put(x, y, u, v) for the texels inside, unwrapped; u and v are -1..1 along and across.
template <class Put>
void for_dab(const Dab& dab, Put&& put) {
  const int reach =
      static_cast<int>(dab.half_length > dab.half_width ? dab.half_length : dab.half_width) + 1;
  const int center_x = static_cast<int>(std::floor(dab.x)),
            center_y = static_cast<int>(std::floor(dab.y));
  for (int y = center_y - reach; y <= center_y + reach; ++y) {
    for (int x = center_x - reach; x <= center_x + reach; ++x) {
      const float dx = static_cast<float>(x) + 0.5f - dab.x,
                  dy = static_cast<float>(y) + 0.5f - dab.y;
      const float u = (dx * dab.along.x + dy * dab.along.y) / dab.half_length;
      const float v = (dy * dab.along.x - dx * dab.along.y) / dab.half_width;
      if (u * u + v * v <= 1.0f) put(x, y, u, v);
    }
  }
}

/// How a surface is brushed: many overlapping touches, each lit along its upper edge and shaded
/// below.
struct Brushwork {
  int touches;
  float length_low, length_high;  ///< half lengths [texels]
  float flatness;                 ///< width over length
  float turn_low, turn_high;      ///< of direction(), within -0.25..0.25
  float contrast;                 ///< how far tones are from 0.5
};
/// Tones around 0.5.
Field brush(const Brushwork& work, std::uint32_t seed);

/// A quadratic Bezier stroke that thins out towards its end.
struct Stroke {
  float x0, y0, x1, y1, x2, y2;  ///< start, control point, end [texels]
  float width0, width1;          ///< at start and end [texels]
};

/// Calls put(x, y, t, side) along the stroke, unwrapped, once a texel unless it is wide and flat; t
/// is 0..1 along, side -1 or 1 left and right of the middle.
template <class Put>
void for_stroke(const Stroke& s, Put&& put) {
  constexpr int kSteps = 96;
  int last_row = 0, last_left = 0, last_right = -1;
  for (int i = 0; i <= kSteps; ++i) {
    const float t = static_cast<float>(i) / kSteps, r = 1.0f - t;
    const float x = r * r * s.x0 + 2.0f * r * t * s.x1 + t * t * s.x2;
    const float y = r * r * s.y0 + 2.0f * r * t * s.y1 + t * t * s.y2;
    const float half = (s.width0 * r + s.width1 * t) * 0.5f;
    const int left = static_cast<int>(std::floor(x - half + 0.5f));
    const int right = static_cast<int>(std::floor(x + half - 0.5f));
    const int row = static_cast<int>(std::floor(y));
    if (i > 0 && row == last_row && left == last_left && right == last_right) continue;
    last_row = row;
    last_left = left;
    last_right = right;
    for (int column = left; column <= (right < left ? left : right); ++column)
      put(column, row, t, static_cast<float>(column) + 0.5f < x ? -1.0f : 1.0f);
  }
}

}  // namespace skerry::textures
