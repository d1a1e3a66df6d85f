#pragma once
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/core/result.h"

namespace skerry::game {

/// A JSON text from outside. Errors, to follow what names the text ("the scene ..."): it is not
/// JSON; an object has a key twice, of which most readers would silently take the last.
Result<nlohmann::json> parse_json(std::string_view text);

}  // namespace skerry::game
