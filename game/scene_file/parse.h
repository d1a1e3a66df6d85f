// Reading numbers, times, sizes and places that a person typed. Every error is one line that quotes
// the text and says what is accepted.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "game/player/camera_place.h"

namespace skerry::game {

struct PictureSize {
  std::uint32_t width = 1280, height = 720;
  bool operator==(const PictureSize&) const = default;
};

/// The largest picture edge parse_size accepts; the device's own limit is checked when there is a
/// device.
inline constexpr std::uint32_t kMaxPictureEdge = 65535;

/// A whole number in [min, max]. @param what names the thing in the error.
Result<std::int64_t> parse_integer(std::string_view text, std::string_view what, std::int64_t min,
                                   std::int64_t max);
/// A finite number in [min, max].
Result<double> parse_number(std::string_view text, std::string_view what, double min, double max);

/// Decimal blocks ("-12.25") to fixed-point units, rounded to the nearest unit (ties away from
/// zero) in integer arithmetic, so that all 56 bits of a far place survive. @return within
/// +-kMaxBlock blocks.
Result<std::int64_t> parse_blocks(std::string_view text, std::string_view what);
/// The shortest decimal that parse_blocks reads back as `units`.
std::string format_blocks(std::int64_t units);

/// "X,Y,Z,YAW,PITCH".
Result<CameraPlace> parse_camera(std::string_view text);
/// The same from five parts already apart.
Result<CameraPlace> parse_camera(std::span<const std::string> parts);
/// Reads back as an equal place.
std::string format_camera(const CameraPlace& camera);

/// "HH:MM" or "HH:MM:SS" to seconds since midnight, 0 .. 86399.
Result<int> parse_time_of_day(std::string_view text);
std::string format_time_of_day(int seconds);

/// "WxH", each 1 .. kMaxPictureEdge.
Result<PictureSize> parse_size(std::string_view text);

/// Splits at each `separator`; n separators give n + 1 parts.
std::vector<std::string> split(std::string_view text, char separator);

/// Whether the name of a file ends so, in letters of either case, behind at least one other.
/// @param extension in small letters, as ".hdr".
bool ends_in(std::string_view file, std::string_view extension);

/// `text` in quotes for an error line: control characters escaped, long text cut, so that the error
/// stays one line.
std::string quote_text(std::string_view text);

/// The candidate with the smallest edit distance (insert, delete, replace, swap neighbours), first
/// in order on ties. @pre not empty.
std::string_view nearest_name(std::string_view text, std::span<const std::string_view> candidates);

}  // namespace skerry::game
