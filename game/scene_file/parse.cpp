#include "game/scene_file/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/core/check.h"

namespace skerry::game {
namespace {

constexpr int kFractionBits = 16;  // of world::kUnitsPerBlock
static_assert(world::kUnitsPerBlock == 1 << kFractionBits);

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), is_digit);
}

/// The decimal fraction 0.`digits` times 2^16, rounded to the nearest integer, ties up. Doubles the
/// decimal string once a bit: exact for any number of digits.
std::int64_t fraction_units(std::string_view digits) {
  std::vector<int> decimal(digits.size());
  for (std::size_t i = 0; i < digits.size(); ++i) decimal[i] = digits[i] - '0';
  const auto double_it = [&decimal] {
    int carry = 0;
    for (std::size_t i = decimal.size(); i-- > 0;) {
      const int twice = decimal[i] * 2 + carry;
      decimal[i] = twice % 10;
      carry = twice / 10;
    }
    return carry;
  };
  std::int64_t units = 0;
  for (int bit = 0; bit < kFractionBits; ++bit) units = units * 2 + double_it();
  return units + double_it();  // the next bit rounds
}

/// The magnitude of an unsigned decimal in units, or nothing when it is no decimal or above the
/// limit.
std::optional<std::int64_t> magnitude_units(std::string_view text) {
  const std::size_t point = text.find('.');
  std::string_view whole = text.substr(0, point);
  const std::string_view fraction =
      point == std::string_view::npos ? std::string_view() : text.substr(point + 1);
  if (whole.empty() && fraction.empty()) return std::nullopt;
  if (!all_digits(whole) || !all_digits(fraction)) return std::nullopt;
  while (whole.size() > 1 && whole.front() == '0') whole.remove_prefix(1);
  if (whole.size() > 13) return std::nullopt;  // 2^40 has 13 digits
  std::int64_t blocks = 0;
  for (const char c : whole) blocks = blocks * 10 + (c - '0');
  const std::int64_t units = blocks * world::kUnitsPerBlock + fraction_units(fraction);
  if (units > world::kMaxBlock * world::kUnitsPerBlock) return std::nullopt;
  return units;
}

/// Edit distance with swaps of neighbours (optimal string alignment); both texts short.
int edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.emplace_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

bool ends_in(std::string_view file, std::string_view extension) {
  const auto same = [](char small, char any) {
    return std::tolower(static_cast<unsigned char>(any)) == small;
  };
  return file.size() > extension.size() &&
         std::equal(extension.begin(), extension.end(), file.end() - extension.size(), same);
}

std::string quote_text(std::string_view text) {
  constexpr std::size_t kMaxShown = 60;
  std::string out = "'";
  for (const char c : text.substr(0, kMaxShown)) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + (text.size() > kMaxShown ? "...'" : "'");
}

std::string_view nearest_name(std::string_view text, std::span<const std::string_view> candidates) {
  SKERRY_ASSERT(!candidates.empty());
  text = text.substr(0, 64);  // names are shorter; keeps the table small for hostile text
  return *std::min_element(candidates.begin(), candidates.end(), [text](auto a, auto b) {
    return edit_distance(text, a) < edit_distance(text, b);
  });
}

Result<std::int64_t> parse_integer(std::string_view text, std::string_view what, std::int64_t min,
                                   std::int64_t max) {
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || value < min || value > max) {
    return Error{fmt::format("{} cannot be {}: give a whole number from {} to {}", what,
                             quote_text(text), min, max)};
  }
  return value;
}

Result<double> parse_number(std::string_view text, std::string_view what, double min, double max) {
  double value = 0.0;
  // from_chars takes no plus sign, parse_blocks does.
  const bool plus = text.size() > 1 && text[0] == '+' && (is_digit(text[1]) || text[1] == '.');
  const auto [end, code] = std::from_chars(text.data() + plus, text.data() + text.size(), value);
  const bool read = code == std::errc() && end == text.data() + text.size();
  if (!read || !std::isfinite(value) || value < min || value > max) {
    return Error{fmt::format("{} cannot be {}: give a number from {} to {}", what, quote_text(text),
                             min, max)};
  }
  return value;
}

Result<std::int64_t> parse_blocks(std::string_view text, std::string_view what) {
  constexpr std::size_t kMaxLength = 200;
  std::string_view digits = text;
  const bool negative = digits.starts_with('-');
  if (negative || digits.starts_with('+')) digits.remove_prefix(1);
  const auto units = text.size() <= kMaxLength ? magnitude_units(digits) : std::nullopt;
  if (!units) {
    return Error{fmt::format("{} cannot be {}: give plain decimal blocks from -{} to {}", what,
                             quote_text(text), world::kMaxBlock, world::kMaxBlock)};
  }
  return negative ? -*units : *units;
}

std::string format_blocks(std::int64_t units) {
  const std::int64_t magnitude = units < 0 ? -units : units;
  std::string out = fmt::format("{}{}", units < 0 ? "-" : "", magnitude / world::kUnitsPerBlock);
  const std::int64_t fraction = magnitude % world::kUnitsPerBlock;
  if (fraction == 0) return out;
  // Five digits tell neighbours 1/65536 apart; fewer often do.
  for (std::int64_t scale = 10;; scale *= 10) {
    const std::int64_t digits =
        (fraction * scale * 2 + world::kUnitsPerBlock) / (2 * world::kUnitsPerBlock);
    const std::int64_t back = (digits * world::kUnitsPerBlock * 2 + scale) / (2 * scale);
    if (back != fraction || digits == scale) continue;
    const std::string text = std::to_string(scale + digits);  // "1ddd": keeps leading zeros
    return out + "." + text.substr(1);
  }
}

Result<CameraPlace> parse_camera(std::span<const std::string> parts) {
  if (parts.size() != 5) {
    return Error{fmt::format("the camera has {} parts: give X,Y,Z,YAW,PITCH", parts.size())};
  }
  const Result<std::int64_t> x = parse_blocks(parts[0], "camera X");
  if (!x) return x.error();
  const Result<std::int64_t> y = parse_blocks(parts[1], "camera Y");
  if (!y) return y.error();
  const Result<std::int64_t> z = parse_blocks(parts[2], "camera Z");
  if (!z) return z.error();
  const Result<double> yaw = parse_number(parts[3], "camera YAW", -3600.0, 3600.0);
  if (!yaw) return yaw.error();
  const Result<double> pitch = parse_number(parts[4], "camera PITCH", -90.0, 90.0);
  if (!pitch) return pitch.error();
  return CameraPlace{{*x, *y, *z}, *yaw, *pitch};
}

Result<CameraPlace> parse_camera(std::string_view text) {
  return parse_camera(split(text, ','));
}

std::string format_camera(const CameraPlace& camera) {
  return fmt::format("{},{},{},{},{}", format_blocks(camera.position.x),
                     format_blocks(camera.position.y), format_blocks(camera.position.z),
                     camera.yaw_deg, camera.pitch_deg);
}

Result<int> parse_time_of_day(std::string_view text) {
  const Error error{fmt::format(
      "the time cannot be {}: give HH:MM or HH:MM:SS, 00:00:00 to 23:59:59", quote_text(text))};
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() != 2 && parts.size() != 3) return error;
  std::array<int, 3> values{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty() || parts[i].size() > 2 || !all_digits(parts[i])) return error;
    for (const char c : parts[i]) values[i] = values[i] * 10 + (c - '0');
  }
  if (values[0] > 23 || values[1] > 59 || values[2] > 59) return error;
  return (values[0] * 60 + values[1]) * 60 + values[2];
}

std::string format_time_of_day(int seconds) {
  return fmt::format("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

Result<PictureSize> parse_size(std::string_view text) {
  const std::vector<std::string> parts = split(text, 'x');
  if (parts.size() != 2) {
    return Error{fmt::format("the size cannot be {}: give WIDTHxHEIGHT, such as 1280x720",
                             quote_text(text))};
  }
  const Result<std::int64_t> width = parse_integer(parts[0], "the width", 1, kMaxPictureEdge);
  if (!width) return width.error();
  const Result<std::int64_t> height = parse_integer(parts[1], "the height", 1, kMaxPictureEdge);
  if (!height) return height.error();
  return PictureSize{static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height)};
}

}  // namespace skerry::game
