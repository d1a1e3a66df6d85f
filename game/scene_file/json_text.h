#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "engine/core/result.h"

namespace skerry::game {

/// Arrays and objects within each other that a text may have: copies, comparisons and prints of
/// what is parsed recurse.
inline constexpr int kMostJsonDepth = 100;

/// A JSON text from outside. Errors, to follow what names the text ("the scene ..."): it is not
/// JSON; it is nested deeper than kMostJsonDepth; an object has a key twice, of which most readers
/// would silently take the last.
Result<nlohmann::json> parse_json(std::string_view text);
/// The same, with keys in the text's order.
Result<nlohmann::ordered_json> parse_ordered_json(std::string_view text);

/// Errors: a field is none of `known`.
Result<void> check_field(std::string_view field, std::span<const std::string_view> known);
/// The same, of all fields of an object.
Result<void> check_fields(const nlohmann::json& object, std::span<const std::string_view> known);

}  // namespace skerry::game
