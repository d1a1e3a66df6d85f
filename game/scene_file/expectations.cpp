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
                                  {"pixels_over", &Tolerance::pixels_over},
                                  {"pixels_rounded", &Tolerance::pixels_rounded},
                                  {"bias", &Tolerance::bias}};
struct ValueField {
  std::string_view name;
  std::uint32_t Tolerance::*value;
};
constexpr ValueField kValues[] = {{"channel_threshold", &Tolerance::channel_threshold},
                                  {"code_values", &Tolerance::code_values}};
constexpr std::string_view kShift = "shift", kRegions = "regions";
constexpr std::string_view kName = "name", kRectangle = "rectangle";
constexpr std::string_view kInTolerance = "tolerance.";
constexpr std::size_t kMaxRegionName = 40;
constexpr std::string_view kWantedRegion =
    "a list of {\"name\": TEXT, \"rectangle\": [X, Y, WIDTH, HEIGHT], and what differs}";

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

/// The largest share or threshold, of the scene or of the region that `field` begins with.
Result<void> read_limit(const std::string& field, const std::string& name, const json& value,
                        Tolerance& into) {
  for (const ValueField& known : kValues) {
    if (known.name != name) continue;
    const auto number = whole_number(value, 255);
    if (!number) return kind_error(field + name, "a whole number from 0 to 255");
    into.*known.value = *number;
    return {};
  }
  for (const ShareField& known : kShares) {
    if (known.name != name) continue;
    const double share = value.is_number() ? value.get<double>() : -1.0;
    if (!(share >= 0.0 && share <= 1.0)) return kind_error(field + name, "a number from 0 to 1");
    into.*known.share = share;
    return {};
  }
  const bool of_region = field != kInTolerance;
  std::vector<std::string_view> names;
  for (const ValueField& known : kValues) names.push_back(known.name);
  for (const ShareField& known : kShares) names.push_back(known.name);
  if (of_region) {
    names.insert(names.end(), {kName, kRectangle});
  } else {
    names.insert(names.end(), {kShift, kRegions});
  }
  return Error{fmt::format("the scene's {} has an unknown field {}: did you mean '{}'?",
                           of_region ? "region" : "tolerance", quote_text(name),
                           nearest_name(name, names))};
}

std::optional<Mask> rectangle_of(const json& value) {
  if (!value.is_array() || value.size() != 4) return std::nullopt;
  std::uint32_t numbers[4]{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto number = whole_number(value[i], kMaxPictureEdge);
    if (!number || (i >= 2 && *number == 0)) return std::nullopt;
    numbers[i] = *number;
  }
  return Mask{numbers[0], numbers[1], numbers[2], numbers[3]};
}

bool is_plain(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; });
}

/// @param others whose names are taken. @param base what the region does not state.
Result<Region> read_region(const json& value, std::span<const Region> others,
                           const Tolerance& base) {
  if (!value.is_object() || !value.contains(kName) || !value.contains(kRectangle))
    return kind_error("tolerance.regions", kWantedRegion);
  Region region;
  region.tolerance = base;
  const json& name = value[std::string(kName)];
  region.name = name.is_string() ? name.get<std::string>() : std::string();
  if (region.name.empty() || region.name.size() > kMaxRegionName || !is_plain(region.name))
    return kind_error("tolerance.regions.name",
                      fmt::format("one line of at most {} bytes", kMaxRegionName));
  const bool taken =
      std::ranges::any_of(others, [&](const Region& other) { return other.name == region.name; });
  if (taken || region.name == kElsewhere)
    return Error{fmt::format("the scene has a region {} already: give another name",
                             quote_text(region.name))};
  const std::optional<Mask> rectangle = rectangle_of(value[std::string(kRectangle)]);
  if (!rectangle) return kind_error("tolerance.regions.rectangle", "[X, Y, WIDTH, HEIGHT]");
  region.rectangle = *rectangle;
  for (const auto& [field, entry] : value.items()) {
    if (field == kName || field == kRectangle) continue;
    const auto done = read_limit("tolerance.regions.", field, entry, region.tolerance);
    if (!done) return done.error();
  }
  return region;
}

Result<std::vector<Region>> read_regions(const json& value, const Tolerance& base) {
  if (!value.is_array()) return kind_error("tolerance.regions", kWantedRegion);
  if (value.size() > kMaxRegions)
    return kind_error("tolerance.regions", fmt::format("at most {} regions", kMaxRegions));
  std::vector<Region> regions;
  for (const json& entry : value) {
    Result<Region> region = read_region(entry, regions, base);
    if (!region) return region.error();
    regions.push_back(*std::move(region));
  }
  return regions;
}

Result<void> read_tolerance(const json& value, Expectations& into) {
  if (!value.is_object()) return kind_error("tolerance", "an object of name: number");
  for (const auto& [name, entry] : value.items()) {
    if (name == kRegions) continue;
    if (name == kShift) {
      const auto shift = whole_number(entry, kMaxShift);
      if (!shift)
        return kind_error("tolerance.shift", fmt::format("whole pixels from 0 to {}", kMaxShift));
      into.shift = *shift;
    } else if (const auto done = read_limit(std::string(kInTolerance), name, entry, into.tolerance);
               !done) {
      return done;
    }
  }
  if (!value.contains(kRegions)) return {};
  // Last, since regions begin with what the scene states, wherever it does.
  Result<std::vector<Region>> regions = read_regions(value[std::string(kRegions)], into.tolerance);
  if (!regions) return regions.error();
  into.regions = *std::move(regions);
  return {};
}

Result<void> read_masks(const json& value, std::vector<Mask>& into) {
  constexpr std::string_view kWanted = "a list of [X, Y, WIDTH, HEIGHT] in whole pixels";
  if (!value.is_array()) return kind_error("masks", kWanted);
  if (value.size() > kMaxMasks)
    return kind_error("masks", fmt::format("at most {} rectangles", kMaxMasks));
  std::vector<Mask> masks;
  for (const json& entry : value) {
    const std::optional<Mask> mask = rectangle_of(entry);
    if (!mask) return kind_error("masks", kWanted);
    masks.push_back(*mask);
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

/// The edges of a picture that a shift may leave without a partner.
std::vector<Mask> edges_of(std::uint32_t shift, const PictureSize& size) {
  if (shift == 0) return {};
  if (2 * shift >= size.width || 2 * shift >= size.height) return {{0, 0, size.width, size.height}};
  return {{0, 0, size.width, shift},
          {0, size.height - shift, size.width, shift},
          {0, 0, shift, size.height},
          {size.width - shift, 0, shift, size.height}};
}

Result<void> check_inside(const Mask& rectangle, const PictureSize& size, std::string_view what) {
  if (rectangle.x + rectangle.width <= size.width && rectangle.y + rectangle.height <= size.height)
    return {};
  return Error{fmt::format("{} [{}, {}, {}, {}] leaves the picture of {}x{} pixels: keep it inside",
                           what, rectangle.x, rectangle.y, rectangle.width, rectangle.height,
                           size.width, size.height)};
}

}  // namespace

Result<void> read_expectation(std::string_view field, const json& value, Expectations& into) {
  if (field == "tolerance") return read_tolerance(value, into);
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

Result<void> check_expectations(const Expectations& expected, const PictureSize& size) {
  for (const Mask& mask : expected.masks)
    if (auto inside = check_inside(mask, size, "the mask"); !inside) return inside;
  for (const Region& region : expected.regions) {
    const std::string what = fmt::format("the region {}", quote_text(region.name));
    if (auto inside = check_inside(region.rectangle, size, what); !inside) return inside;
  }
  std::vector<Mask> hidden = edges_of(expected.shift, size);
  hidden.insert(hidden.end(), expected.masks.begin(), expected.masks.end());
  if (leaves_something(hidden, size)) return {};
  return Error{expected.shift == 0
                   ? std::string("the masks cover the whole picture: leave something to compare")
                   : fmt::format("masks and a shift of {} pixels leave nothing of the picture to "
                                 "compare: state less",
                                 expected.shift)};
}

bool is_masked(std::span<const Mask> masks, std::uint32_t x, std::uint32_t y) {
  return std::any_of(masks.begin(), masks.end(), [&](const Mask& mask) {
    return x >= mask.x && x - mask.x < mask.width && y >= mask.y && y - mask.y < mask.height;
  });
}

}  // namespace skerry::game
