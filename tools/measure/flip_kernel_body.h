// FLIP of a tile, in vectors of flip_kernel_vector.h. Included by each kernel after that: no
// include guard. Filters and colours are doubles: the error is the 0.7th power of a difference of
// colours, to which floats would add 2e-5 where pictures are almost alike.
#include <algorithm>
#include <cstddef>

namespace skerry::measure::flip_detail {
namespace {

// The paper's constants, by its names.
constexpr double kPc = 0.4;   ///< share of the largest colour difference that ...
constexpr double kPt = 0.95;  ///< ... is mapped to this error

/// Two vectors: a strip's width, and enough sums side by side to keep the adders busy.
struct Strip {
  static constexpr int kVecs = kStripWidth / kLanes;
  Vec part[kVecs];
};

SKERRY_FLIP_TARGET inline Strip load_strip(const double* from) {
  Strip out;
  for (int i = 0; i < Strip::kVecs; ++i) out.part[i] = load(from + i * kLanes);
  return out;
}

SKERRY_FLIP_TARGET inline void store_strip(double* to, const Strip& value) {
  for (int i = 0; i < Strip::kVecs; ++i) store(to + i * kLanes, value.part[i]);
}

/// How a value depends on its neighbours along an axis.
enum Symmetry { kEven, kOdd };

/// Filters of one input at `centre`, whose neighbours lie `step` doubles apart, side by side: they
/// share what they read. @pre all have one radius.
template <Symmetry... symmetries, class... Filters>
SKERRY_FLIP_TARGET inline void filter_at(const double* centre, std::ptrdiff_t step,
                                         Strip (&sums)[sizeof...(Filters)],
                                         const Filters&... filters) {
  constexpr int kCount = sizeof...(Filters);
  constexpr Symmetry kSymmetries[] = {symmetries...};
  const double* const weights[] = {filters.weights.data()...};
  const int radius = std::min({filters.radius()...});
  for (int v = 0; v < Strip::kVecs; ++v) {
    const Vec here = load(centre + v * kLanes);
    for (int f = 0; f < kCount; ++f) sums[f].part[v] = weights[f][0] * here;
  }
  for (int i = 1; i <= radius; ++i) {
    const double *before = centre - i * step, *after = centre + i * step;
    for (int v = 0; v < Strip::kVecs; ++v) {
      const Vec a = load(after + v * kLanes), b = load(before + v * kLanes);
      const Vec even = a + b, odd = a - b;
      for (int f = 0; f < kCount; ++f)
        sums[f].part[v] += weights[f][i] * (kSymmetries[f] == kEven ? even : odd);
    }
  }
}

/// Linear colour of `count` pixels of a row from `x` on, the row's outermost pixels repeated beyond
/// it. @param color the colour of the row's pixel of an index.
template <class Color>
inline void fetch_pixels(int x, int count, int width, Scratch& scratch, const Color& color) {
  double *r = scratch.row(0), *g = scratch.row(1), *b = scratch.row(2);
  const auto fetch = [&](int i, const glm::vec3& pixel) {
    r[i] = static_cast<double>(pixel.x);
    g[i] = static_cast<double>(pixel.y);
    b[i] = static_cast<double>(pixel.z);
  };
  if (x >= 0 && x + count <= width) {
    for (int i = 0; i < count; ++i) fetch(i, color(x + i));
  } else {
    for (int i = 0; i < count; ++i) fetch(i, color(std::clamp(x + i, 0, width - 1)));
  }
}

/// Row `y` of a picture around a tile; the picture's outermost rows are repeated beyond it.
inline void fetch_row(const Pair& pair, int picture, int x, int y, int count, Scratch& scratch) {
  const Source& source = pair.sources[picture];
  const int width = static_cast<int>(pair.width);
  const int row = std::clamp(y, 0, static_cast<int>(pair.height) - 1);
  const std::size_t first = static_cast<std::size_t>(row) * pair.width;
  if (source.linear) {
    const glm::vec3* pixels = source.linear + first;
    fetch_pixels(x, count, width, scratch, [&](int i) { return pixels[i]; });
  } else {
    const std::uint8_t* bytes = source.rgba + 4 * first;
    const float* decoded = source.decoded;
    fetch_pixels(x, count, width, scratch, [&](int i) {
      const std::uint8_t* pixel = bytes + 4 * i;
      return glm::vec3(decoded[pixel[0]], decoded[pixel[1]], decoded[pixel[2]]);
    });
  }
}

SKERRY_FLIP_TARGET inline Vec dot(const double (&row)[3], const Vec& x, const Vec& y,
                                  const Vec& z) {
  return row[0] * x + row[1] * y + row[2] * z;
}

/// Colour in place to YCxCz (tools/measure/color.h) without its factors and offsets, which filters
/// that sum to 1 keep: Y, X - Y, Y - Z, each over the white's.
SKERRY_FLIP_TARGET inline void to_opponents(const Constants& constants, int count,
                                            Scratch& scratch) {
  double *first = scratch.row(0), *second = scratch.row(1), *third = scratch.row(2);
  const auto& m = constants.relative_from_linear;
  for (int i = 0; i < count; i += kLanes) {
    const Vec r = clamp_unit(load(first + i)), g = clamp_unit(load(second + i));
    const Vec b = clamp_unit(load(third + i));
    const Vec x = dot(m[0], r, g, b), y = dot(m[1], r, g, b), z = dot(m[2], r, g, b);
    store(first + i, y);
    store(second + i, x - y);
    store(third + i, y - z);
  }
}

/// Filters the rows of a tile and of its margin along x.
SKERRY_FLIP_TARGET inline void filter_rows(const Constants& constants, const Pair& pair,
                                           int picture, const Tile& tile, Scratch& scratch) {
  const FlipFilters& filters = constants.filters;
  const int margin = constants.margin;
  const int columns = (tile.width + kStripWidth - 1) / kStripWidth * kStripWidth;
  const int count = columns + 2 * margin;
  for (int row = 0; row < tile.height + 2 * margin; ++row) {
    fetch_row(pair, picture, tile.x - margin, tile.y - margin + row, count, scratch);
    to_opponents(constants, count, scratch);
    const double *light = scratch.row(0) + margin, *red_green = scratch.row(1) + margin;
    const double* blue_yellow = scratch.row(2) + margin;
    for (int x = 0; x < columns; x += kStripWidth) {
      const auto keep = [&](MiddlePlane plane, const Strip& value) SKERRY_FLIP_TARGET {
        store_strip(scratch.middle(plane, row) + x, value);
      };
      Strip one[1], two[2], three[3];
      filter_at<kEven>(light + x, 1, one, filters.achromatic.parts[0].taps);
      keep(kLight, one[0]);
      filter_at<kEven>(red_green + x, 1, one, filters.red_green.parts[0].taps);
      keep(kRedGreen, one[0]);
      filter_at<kEven, kEven>(blue_yellow + x, 1, two, filters.blue_yellow.parts[0].taps,
                              filters.blue_yellow.parts[1].taps);
      keep(kBlueYellow1, two[0]);
      keep(kBlueYellow2, two[1]);
      filter_at<kEven, kOdd, kEven>(light + x, 1, three, filters.smooth, filters.edge,
                                    filters.point);
      keep(kSmooth, three[0]);
      keep(kEdge, three[1]);
      keep(kPoint, three[2]);
    }
  }
}

/// CIE's cube root with a linear part near zero, of 0..1.
SKERRY_FLIP_TARGET inline Vec lab_curve(const Vec& t) {
  constexpr double kDelta = 6.0 / 29.0, kBend = kDelta * kDelta * kDelta;
  const Vec above = largest_of(t, all(kBend)), inverse = inverse_cube_root(above);
  return t > all(kBend) ? above * inverse * inverse
                        : t * (1.0 / (3.0 * kDelta * kDelta)) + 4.0 / 29.0;
}

/// Three values of a vector of pixels.
struct Color {
  Vec x, y, z;
};

/// Filtered opponents to L*a*b* with chroma scaled by lightness: colours are harder to tell apart
/// in the dark.
SKERRY_FLIP_TARGET inline Color hunt_lab(const Constants& constants, const Color& opponents) {
  const auto &to_linear = constants.linear_from_relative, &m = constants.relative_from_linear;
  const Vec x = opponents.x + opponents.y, z = opponents.x - opponents.z;
  const Vec r = clamp_unit(dot(to_linear[0], x, opponents.x, z));
  const Vec g = clamp_unit(dot(to_linear[1], x, opponents.x, z));
  const Vec b = clamp_unit(dot(to_linear[2], x, opponents.x, z));
  const Vec fx = lab_curve(dot(m[0], r, g, b)), fy = lab_curve(dot(m[1], r, g, b));
  const Vec fz = lab_curve(dot(m[2], r, g, b));
  const Vec lightness = 116.0 * fy - 16.0, scale = 0.01 * lightness;
  return {lightness, scale * (500.0 * (fx - fy)), scale * (200.0 * (fy - fz))};
}

SKERRY_FLIP_TARGET inline Vec length(const Vec& x, const Vec& y) {
  return square_root(x * x + y * y);
}

/// What FLIP sees in row `y` of the strip of a tile that begins at column `x`, all planes of
/// filtered rows at once: the rows that filters share stay in the first cache.
SKERRY_FLIP_TARGET inline void see_row(const Constants& constants, int picture, int x, int y,
                                       Scratch& scratch) {
  const FlipFilters& filters = constants.filters;
  constexpr std::ptrdiff_t kStep = Scratch::kMiddleStride;
  const auto middle = [&](MiddlePlane plane) {
    return scratch.middle(plane, y + constants.margin) + x;
  };
  Strip light[1], red_green[1], blue_yellow1[1], blue_yellow2[1], edge_x[1], point_x[1], along_y[2];
  filter_at<kEven>(middle(kLight), kStep, light, filters.achromatic.parts[0].taps);
  filter_at<kEven>(middle(kRedGreen), kStep, red_green, filters.red_green.parts[0].taps);
  filter_at<kEven>(middle(kBlueYellow1), kStep, blue_yellow1, filters.blue_yellow.parts[0].taps);
  filter_at<kEven>(middle(kBlueYellow2), kStep, blue_yellow2, filters.blue_yellow.parts[1].taps);
  filter_at<kEven>(middle(kEdge), kStep, edge_x, filters.smooth);
  filter_at<kEven>(middle(kPoint), kStep, point_x, filters.smooth);
  filter_at<kOdd, kEven>(middle(kSmooth), kStep, along_y, filters.edge, filters.point);
  const double* share = constants.blue_yellow_share;
  for (int v = 0; v < Strip::kVecs; ++v) {
    const Vec both = share[0] * blue_yellow1[0].part[v] + share[1] * blue_yellow2[0].part[v];
    const Color lab = hunt_lab(constants, {light[0].part[v], red_green[0].part[v], both});
    const int at = y * kTileWidth + x + v * kLanes;
    store(scratch.seen(picture, kL) + at, lab.x);
    store(scratch.seen(picture, kA) + at, lab.y);
    store(scratch.seen(picture, kB) + at, lab.z);
    store(scratch.seen(picture, kEdges) + at, length(edge_x[0].part[v], along_y[0].part[v]));
    store(scratch.seen(picture, kPoints) + at, length(point_x[0].part[v], along_y[1].part[v]));
  }
}

/// Colour difference to error: linear up to a large difference, compressed above it.
SKERRY_FLIP_TARGET inline Vec color_error(const Constants& constants, const Vec& difference) {
  // 0.7 = 1/2 + 1 - 4/5. The root is that of a difference that nobody can see, or a larger one.
  constexpr double kLeast = 1e-60;
  const Vec inverse = inverse_fifth_root(largest_of(difference, all(kLeast)));
  const Vec inverse2 = inverse * inverse;
  const Vec d = square_root(difference) * difference * (inverse2 * inverse2);
  const double knee = kPc * constants.largest;
  const Vec above = kPt + (d - knee) * ((1.0 - kPt) / (constants.largest - knee));
  return d < all(knee) ? d * (kPt / knee) : above;
}

/// Errors of kLanes pixels from what is seen of both pictures.
SKERRY_FLIP_TARGET inline Vec pixel_errors(const Constants& constants, int at, Scratch& scratch) {
  const auto change = [&](SeenPlane plane) SKERRY_FLIP_TARGET {
    return load(scratch.seen(0, plane) + at) - load(scratch.seen(1, plane) + at);
  };
  const Vec color = color_error(constants, magnitude(change(kL)) + length(change(kA), change(kB)));
  const Vec feature = largest_of(magnitude(change(kEdges)), magnitude(change(kPoints)));
  constexpr double kRootHalf = 0.70710678118654752;
  const Vec exponent = 1.0 - square_root(feature * kRootHalf);
  constexpr double kLeast = 1e-60;  // a colour below it is none
  const Vec power = exp_2(exponent * log_2(largest_of(color, all(kLeast))));
  return color > all(kLeast) ? clamp_unit(power) : all(0.0);
}

SKERRY_FLIP_TARGET void tile_errors(const Constants& constants, const Pair& pair, const Tile& tile,
                                    Scratch& scratch, float* errors) {
  for (int picture = 0; picture < 2; ++picture) {
    filter_rows(constants, pair, picture, tile, scratch);
    for (int x = 0; x < tile.width; x += kStripWidth)
      for (int y = 0; y < tile.height; ++y) see_row(constants, picture, x, y, scratch);
  }
  for (int y = 0; y < tile.height; ++y) {
    float* row = errors + (static_cast<std::size_t>(tile.y) + y) * pair.width + tile.x;
    for (int x = 0; x < tile.width; x += kLanes) {
      const Vec found = pixel_errors(constants, y * kTileWidth + x, scratch);
      for (int i = 0; i < std::min(kLanes, tile.width - x); ++i)
        row[x + i] = static_cast<float>(found[i]);
    }
  }
}

}  // namespace
}  // namespace skerry::measure::flip_detail
