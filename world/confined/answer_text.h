// What answers of confined processes have in common, whatever they carry.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace skerry::world {

/// Takes bytes in order; returns false when they could not be kept.
using ByteSink = std::function<bool(std::span<const std::byte>)>;

/// Longest text in an answer: a name, a remark, an error message.
inline constexpr std::size_t kMostAnswerText = 1024;

/// At most kMostAnswerText bytes of printable ASCII: anything else becomes '?'.
std::string printable(std::string_view text);

}  // namespace skerry::world
