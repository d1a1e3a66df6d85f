#include "game/scene_file/expectations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/check.h"

namespace skerry::game {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxDescription = 400;

struct ShareField {
  std::string_view name;
  double Tolerance::*share;
};
constexpr ShareField kShares[] = {{"flip_mean", &Tolerance::flip_mean},
                                  {"flip_p99", &Tolerance::flip_p99},
                                  {"flip_max", &Tolerance::flip_max},
                                  {"pixels_over", &Tolerance::pixels_over}};
constexpr std::string_view kThreshold = "channel_threshold";

Error kind_error(std::string_view field, std::string_view wanted) {
  return Error{fmt::format("the scene's field '{}' is wrong: give {}", field, wanted)};
}

/// A whole number in [0, max], or nothing. JSON keeps 3 and 3.0 apart; both are whole.
std::optional<std::uint32_t> whole_number(const json& value, std::uint32_t max) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  if (!(number >= 0.0 && number <= max) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

Result<void> read_tolerance_entry(const std::string& name, const json& value, Tolerance& into) {
  if (name == kThreshold) {
    const auto threshold = whole_number(value, 255);
    if (!threshold)
      return kind_error("tolerance.channel_threshold", "a whole number from 0 to 255");
    into.channel_threshold = *threshold;
    return {};
  }
  for (const ShareField& field : kShares) {
    if (field.name != name) continue;
    const double share = value.is_number() ? value.get<double>() : -1.0;
    if (!(share >= 0.0 && share <= 1.0))
      return kind_error("tolerance." + name, "a number from 0 to 1");
    into.*field.share = share;
    return {};
  }
  std::vector<std::string_view> names{kThreshold};
  for (const ShareField& field : kShares) names.push_back(field.name);
  return Error{fmt::format("the scene's tolerance has an unknown field {}: did you mean '{}'?",
                           quote_text(name), nearest_name(name, names))};
}

Result<void> read_tolerance(const json& value, Tolerance& into) {
  if (!value.is_object()) return kind_error("tolerance", "an object of name: number");
  for (const auto& [name, entry] : value.items()) {
    if (const auto done = read_tolerance_entry(name, entry, into); !done) return done;
  }
  return {};
}

Result<void> read_masks(const json& value, std::vector<Mask>& into) {
  constexpr std::string_view kWanted = "a list of [X, Y, WIDTH, HEIGHT] in whole pixels";
  if (!value.is_array()) return kind_error("masks", kWanted);
  if (value.size() > kMaxMasks)
    return kind_error("masks", fmt::format("at most {} rectangles", kMaxMasks));
  std::vector<Mask> masks;
  for (const json& entry : value) {
    if (!entry.is_array() || entry.size() != 4) return kind_error("masks", kWanted);
    std::uint32_t numbers[4]{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto number = whole_number(entry[i], kMaxPictureEdge);
      if (!number || (i >= 2 && *number == 0)) return kind_error("masks", kWanted);
      numbers[i] = *number;
    }
    masks.push_back({numbers[0], numbers[1], numbers[2], numbers[3]});
  }
  into = std::move(masks);
  return {};
}

/// From an uncovered pixel one can go left, then up, until an edge of the picture or of a mask: so
/// it is enough to look at the corners those make.
bool leaves_something(std::span<const Mask> masks, const PictureSize& size) {
  std::vector<std::uint32_t> xs{0}, ys{0};
  for (const Mask& mask : masks) {
    xs.push_back(mask.x + mask.width);
    ys.push_back(mask.y + mask.height);
  }
  for (const std::uint32_t x : xs) {
    for (const std::uint32_t y : ys) {
      if (x < size.width && y < size.height && !is_masked(masks, x, y)) return true;
    }
  }
  return false;
}

bool is_plain(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; });
}

}  // namespace

Result<void> read_expectation(std::string_view field, const json& value, Expectations& into) {
  if (field == "tolerance") return read_tolerance(value, into.tolerance);
  if (field == "masks") return read_masks(value, into.masks);
  if (field == "expects_dark") {
    if (!value.is_boolean()) return kind_error(field, "true or false");
    into.expects_dark = value.get<bool>();
    return {};
  }
  SKERRY_ASSERT(field == "description");
  const std::string text = value.is_string() ? value.get<std::string>() : std::string();
  if (text.empty() || text.size() > kMaxDescription || !is_plain(text))
    return kind_error(field, fmt::format("one line of at most {} bytes", kMaxDescription));
  into.description = text;
  return {};
}

Result<void> check_masks(std::span<const Mask> masks, const PictureSize& size) {
  for (const Mask& mask : masks) {
    if (mask.x + mask.width <= size.width && mask.y + mask.height <= size.height) continue;
    return Error{
        fmt::format("the mask [{}, {}, {}, {}] leaves the picture of {}x{} pixels: keep it inside",
                    mask.x, mask.y, mask.width, mask.height, size.width, size.height)};
  }
  if (leaves_something(masks, size)) return {};
  return Error{"the masks cover the whole picture: leave something to compare"};
}

bool is_masked(std::span<const Mask> masks, std::uint32_t x, std::uint32_t y) {
  return std::any_of(masks.begin(), masks.end(), [&](const Mask& mask) {
    return x >= mask.x && x - mask.x < mask.width && y >= mask.y && y - mask.y < mask.height;
  });
}

}  // namespace skerry::game
