#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace skerry::fuzz {

/// A parser of what comes from outside. run() must return for any bytes; what breaks a promise
/// (a crash, an error of several lines, a value that does not read back) ends the process.
struct Target {
  std::string_view name;
  void (*run)(std::span<const std::uint8_t> input);
};

std::span<const Target> targets();

}  // namespace skerry::fuzz
