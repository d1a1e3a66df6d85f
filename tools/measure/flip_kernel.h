// FLIP of a tile of two pictures, for the instruction sets that are worth code of their own. All
// kernels give the same bits: they do the same IEEE operations in the same order, in vectors of
// different lengths, and take no function of the C library.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "tools/measure/flip_filters.h"
#include "tools/measure/picture.h"

namespace skerry::measure::flip_detail {

/// Pixels of a tile: its filtered planes fit the second cache.
inline constexpr int kTileWidth = 64, kTileHeight = 64;
/// Columns that are filtered at a time; divides kTileWidth.
inline constexpr int kStripWidth = 8;

/// What a picture's rows are filtered to before its columns are.
enum MiddlePlane {
  kLight,
  kRedGreen,
  kBlueYellow1,
  kBlueYellow2,
  kSmooth,
  kEdge,
  kPoint,
  kMiddles
};
/// What FLIP sees of a picture: colour after the eye's blur, Hunt-adjusted L*a*b*, and the
/// magnitudes of its features.
enum SeenPlane { kL, kA, kB, kEdges, kPoints, kSeens };

/// The filters and matrices as the kernels read them.
struct Constants {
  explicit Constants(double pixels_per_degree);

  FlipFilters filters;
  int margin;  ///< pixels around a tile that its filters read
  double relative_from_linear[3][3], linear_from_relative[3][3];  ///< rows
  double blue_yellow_share[2];
  double largest;  ///< colour difference that is the error 1, to the power kQc
};

/// Memory of one thread, kept between tiles.
class Scratch {
 public:
  explicit Scratch(int margin);

  int margin() const { return margin_; }
  /// Doubles from one row of a middle plane to the next; no multiple of a page's.
  static constexpr int kMiddleStride = kTileWidth + kStripWidth;
  double* middle(MiddlePlane plane, int row) {
    const int rows = kTileHeight + 2 * margin_;
    return middles_.data() + (static_cast<std::ptrdiff_t>(plane) * rows + row) * kMiddleStride;
  }
  /// One of three rows of linear colour, `margin` pixels before a tile to as many behind it.
  double* row(int channel) { return rows_.data() + static_cast<std::ptrdiff_t>(channel) * stride_; }
  /// kTileHeight rows of kTileWidth values, of the first or the second picture.
  double* seen(int picture, SeenPlane plane) {
    return seen_.data() +
           static_cast<std::ptrdiff_t>(picture * kSeens + plane) * kTileHeight * kTileWidth;
  }

 private:
  int margin_, stride_;
  std::vector<double> middles_, rows_, seen_;
};

/// Pixels [x, x + width) and [y, y + height) of two pictures.
struct Tile {
  int x = 0, y = 0;
  int width = 0, height = 0;  ///< 1..kTileWidth, 1..kTileHeight
};

/// One of two pictures of equal size: linear colour, or bytes of sRGB and what they decode to.
struct Source {
  const glm::vec3* linear = nullptr;   ///< nullptr: bytes are given
  const std::uint8_t* rgba = nullptr;  ///< four a pixel
  const float* decoded = nullptr;      ///< linear light of each of 256 bytes

  std::size_t pixel_bytes() const { return linear ? sizeof(glm::vec3) : 4; }
  const void* pixel(std::size_t index) const {
    return linear ? static_cast<const void*>(linear + index) : rgba + 4 * index;
  }
};

struct Pair {
  std::uint32_t width = 0, height = 0;
  Source sources[2];  ///< the reference and the test, of one kind
};

struct Kernel {
  const char* name;
  /// Writes a tile's errors. @param errors of the whole picture. @pre scratch has the margin.
  void (*tile_errors)(const Constants& constants, const Pair& pair, const Tile& tile,
                      Scratch& scratch, float* errors);
};

extern const Kernel kPortableKernel;
#if defined(__x86_64__)
extern const Kernel kAvx2Kernel, kAvx512Kernel;
#endif

/// The kernels this CPU can run, fastest first; the last one is the portable one.
std::span<const Kernel* const> kernels();

/// flip_ldr with a kernel of choice. @pre the pictures have one size and a pixel.
std::vector<float> errors_with(const Kernel& kernel, const Pair& pair, double pixels_per_degree);
Pair pair_of(const Picture& reference, const Picture& test);

}  // namespace skerry::measure::flip_detail
