#include "game/scene_file/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "game/scene_file/parse.h"

namespace skerry::game {
namespace {

template <class Json>
Result<Json> parse(std::string_view text) {
  using Event = typename Json::parse_event_t;
  bool too_deep = false;
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  std::optional<std::string> twice;
  const auto look = [&](int depth, Event event, Json& parsed) {
    const bool opens = event == Event::object_start || event == Event::array_start;
    too_deep = too_deep || (opens && depth >= kMostJsonDepth);
    if (too_deep) return false;
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key && !keys.back().insert(parsed.template get<std::string>()).second &&
        !twice)
      twice = parsed.template get<std::string>();
    return true;
  };
  Json root = Json::parse(text, look, false);
  if (too_deep)
    return Error{fmt::format("is nested more than {} deep: flatten it", kMostJsonDepth)};
  if (root.is_discarded()) return Error{"is not JSON: check its brackets, quotes and commas"};
  if (twice) return Error{fmt::format("has {} twice in one object: keep one", quote_text(*twice))};
  return root;
}

}  // namespace

Result<nlohmann::json> parse_json(std::string_view text) {
  return parse<nlohmann::json>(text);
}

Result<nlohmann::ordered_json> parse_ordered_json(std::string_view text) {
  return parse<nlohmann::ordered_json>(text);
}

Result<void> check_field(std::string_view field, std::span<const std::string_view> known) {
  if (std::find(known.begin(), known.end(), field) != known.end()) return {};
  return Error{fmt::format("it has an unknown field {}: did you mean '{}'?", quote_text(field),
                           nearest_name(field, known))};
}

Result<void> check_fields(const nlohmann::json& object, std::span<const std::string_view> known) {
  for (const auto& [field, value] : object.items())
    if (Result<void> one = check_field(field, known); !one) return one;
  return {};
}

}  // namespace skerry::game
