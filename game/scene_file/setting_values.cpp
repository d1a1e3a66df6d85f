#include "game/scene_file/setting_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "game/scene_file/parse.h"

namespace skerry::game {

Result<std::size_t> parse_name(std::string_view text, std::string_view what,
                               std::span<const std::string_view> names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == text) return i;
  }
  return Error{fmt::format("{} cannot be {}: did you mean '{}'? It takes {}", what,
                           quote_text(text), nearest_name(text, names), fmt::join(names, ", "))};
}

}  // namespace skerry::game
