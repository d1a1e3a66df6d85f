#include "game/scene_file/vdb_options.h"

#include <fmt/format.h>

#include <array>

#include "game/scene_file/parse.h"

namespace skerry::game {
namespace {

constexpr std::array<std::string_view, 6> kKeys = {"grid",      "scale", "size",
                                                   "threshold", "up",    "expect"};

Result<void> set_number(const std::string& value, const std::string& named, double low, double high,
                        std::optional<double>& out) {
  const Result<double> number = parse_number(value, named, low, high);
  if (!number) return number.error();
  out = *number;
  return {};
}

}  // namespace

bool is_vdb(const std::filesystem::path& path) {
  return path.extension() == ".vdb";
}

Result<std::string> parse_sha256(const std::string& value, const std::string& named) {
  constexpr std::size_t kDigits = 64;
  std::string lower;
  for (const char c : value) {
    const bool letter = (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
    if (!letter && !(c >= '0' && c <= '9')) break;
    lower += c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  if (lower.size() == value.size() && value.size() == kDigits) return lower;
  return Error{fmt::format("{} cannot be {}: give the {} hexadecimal digits that sha256sum prints",
                           named, quote_text(value), kDigits)};
}

Result<void> set_import(std::string_view key, const std::string& value, const std::string& named,
                        world::ImportOptions& options) {
  if (key == "grid") {
    options.grid = value;
  } else if (key == "scale") {
    if (const auto set = set_number(value, named, 1e-6, 1e6, options.scale); !set) return set;
  } else if (key == "size") {
    const Result<std::int64_t> blocks = parse_integer(value, named, 1, 1'000'000);
    if (!blocks) return blocks.error();
    options.size_blocks = static_cast<int>(*blocks);
  } else if (key == "threshold") {
    if (const auto set = set_number(value, named, -1e30, 1e30, options.threshold); !set) return set;
  } else if (key == "up") {
    if (value != "y" && value != "z")
      return Error{fmt::format("{} cannot be {}: give y or z", named, quote_text(value))};
    options.up = value == "z" ? world::UpAxis::kZ : world::UpAxis::kY;
  } else if (key == "expect") {
    const Result<std::string> sum = parse_sha256(value, named);
    if (!sum) return sum.error();
    options.expect = *sum;
  } else {
    return Error{fmt::format("there is no import option {}: did you mean '{}'?", quote_text(key),
                             nearest_name(key, kKeys))};
  }
  if (options.scale && options.size_blocks)
    return Error{fmt::format("{}: scale and size exclude each other, give one of them", named)};
  return {};
}

Result<void> apply_import(const std::string& assignment, world::ImportOptions& options) {
  const std::size_t sign = assignment.find('=');
  if (sign == std::string::npos)
    return Error{fmt::format("--import {} has no value: give KEY=VALUE", quote_text(assignment))};
  const std::string key = assignment.substr(0, sign);
  return set_import(key, assignment.substr(sign + 1), "--import " + key, options);
}

std::vector<std::string> import_assignments(const world::ImportOptions& options) {
  std::vector<std::string> out;
  if (options.grid) out.push_back("grid=" + *options.grid);
  if (options.scale) out.push_back(fmt::format("scale={}", *options.scale));
  if (options.size_blocks) out.push_back(fmt::format("size={}", *options.size_blocks));
  if (options.threshold) out.push_back(fmt::format("threshold={}", *options.threshold));
  if (options.up == world::UpAxis::kZ) out.push_back("up=z");
  if (options.expect) out.push_back("expect=" + *options.expect);
  return out;
}

}  // namespace skerry::game
