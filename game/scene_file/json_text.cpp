#include "game/scene_file/json_text.h"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "game/scene_file/parse.h"

namespace skerry::game {

Result<nlohmann::json> parse_json(std::string_view text) {
  using nlohmann::json;
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  std::optional<std::string> twice;
  const auto look = [&](int, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key &&
        !keys.back().insert(parsed.get<std::string>()).second && !twice)
      twice = parsed.get<std::string>();
    return true;
  };
  json root = json::parse(text, look, false);
  if (root.is_discarded()) return Error{"is not JSON: check its brackets, quotes and commas"};
  if (twice) return Error{fmt::format("has {} twice in one object: keep one", quote_text(*twice))};
  return root;
}

}  // namespace skerry::game
