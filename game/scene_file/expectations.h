// What a scene file says about the picture it makes: how `skerry test` judges it.
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/parse.h"

namespace skerry::game {

/// How far a picture may be from its reference and still be taken for it. FLIP errors are 0..1.
/// The defaults let another driver's rounding pass, and nothing that a player would notice.
struct Tolerance {
  double flip_mean = 0.004;
  double flip_p99 = 0.08;
  double flip_max = 1.0;                ///< one pixel on an edge may be anything
  double pixels_over = 0.005;           ///< share of pixels off by more than the next in a channel
  std::uint32_t channel_threshold = 8;  ///< of 255
  /// A pixel off by no more than this in each channel [of 255] is *rounded* otherwise: for FLIP it
  /// is the reference's. Such pixels have limits of their own.
  std::uint32_t code_values = 1;
  double pixels_rounded = 0.4;  ///< share of them
  double bias = 0.1;  ///< of a channel: mean of their differences over all pixels [code values]
  bool operator==(const Tolerance&) const = default;
};

/// A rectangle of a picture that is not compared [pixels]; (0, 0) is the top left.
struct Mask {
  std::uint32_t x = 0, y = 0, width = 1, height = 1;
  bool operator==(const Mask&) const = default;
};

/// The most masks a scene may have.
inline constexpr std::size_t kMaxMasks = 64;

/// A rectangle of a picture that has a tolerance of its own.
struct Region {
  std::string name;
  Mask rectangle;
  Tolerance tolerance;
  bool operator==(const Region&) const = default;
};

inline constexpr std::size_t kMaxRegions = 64;
inline constexpr std::uint32_t kMaxShift = 16;  ///< [pixels]
/// The name of what is left of a picture beside its regions.
inline constexpr std::string_view kElsewhere = "elsewhere";

struct Expectations {
  Tolerance tolerance;          ///< of what lies in no region
  std::vector<Region> regions;  ///< a pixel belongs to the first that has it
  std::uint32_t shift = 0;      ///< a picture may be moved by so many pixels along each axis
  bool expects_dark = false;    ///< a black picture is right
  std::vector<Mask> masks;
  std::string description;  ///< what the scene is there to show
};

/// The fields of a scene file that read_expectation reads.
inline constexpr std::string_view kExpectationFields[] = {"tolerance", "expects_dark", "masks",
                                                          "description"};

/// Reads one of kExpectationFields. Errors: a value of the wrong kind or out of its range, an
/// unknown tolerance (names the nearest).
Result<void> read_expectation(std::string_view field, const nlohmann::json& value,
                              Expectations& into);

/// Checks that every mask and region lies within a picture of this size, and that masks and a shift
/// leave something of it.
Result<void> check_expectations(const Expectations& expected, const PictureSize& size);

/// Whether a mask covers the pixel.
bool is_masked(std::span<const Mask> masks, std::uint32_t x, std::uint32_t y);

}  // namespace skerry::game
