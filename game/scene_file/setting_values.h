// From the text of a setting's value to its field.
#pragma once
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/result.h"

namespace skerry::game {

inline constexpr std::array<std::string_view, 2> kSwitchNames{"0", "1"};

/// The index of a name among the accepted ones; the error names the nearest.
Result<std::size_t> parse_name(std::string_view text, std::string_view what,
                               std::span<const std::string_view> names);

/// The name of an enumerator or a bool, which parse_name gives the index of.
template <class E>
std::string name_of(std::span<const std::string_view> names, E value) {
  return std::string(names[static_cast<std::size_t>(value)]);
}

/// Stores a parsed integer, or passes its error on.
template <class T>
Result<void> into(const Result<std::int64_t>& parsed, T& field) {
  if (!parsed) return parsed.error();
  field = static_cast<T>(*parsed);
  return {};
}

/// Stores one of a few integers, listed as text; the error names the nearest.
template <class T>
Result<void> into_listed(std::string_view text, std::string_view what,
                         std::span<const std::string_view> values, T& field) {
  const Result<std::size_t> at = parse_name(text, what, values);
  if (!at) return at.error();
  std::from_chars(values[*at].data(), values[*at].data() + values[*at].size(), field);
  return {};
}

/// Stores the enumerator (or bool) whose index parse_name found, or passes its error on.
template <class E>
Result<void> into_name(const Result<std::size_t>& parsed, E& field) {
  if (!parsed) return parsed.error();
  field = static_cast<E>(*parsed);
  return {};
}

/// Stores a parsed number, or passes its error on.
template <class T>
Result<void> into_number(const Result<double>& parsed, T& field) {
  if (!parsed) return parsed.error();
  field = static_cast<T>(*parsed);
  return {};
}

}  // namespace skerry::game
