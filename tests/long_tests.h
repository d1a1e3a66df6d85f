#pragma once
#include <cstdlib>

namespace skerry {

/// Whether suites that have a short version run whole: where SKERRY_LONG_TESTS is set, as
/// `tools/test --long` does.
inline bool long_tests() {
  return std::getenv("SKERRY_LONG_TESTS") != nullptr;
}

}  // namespace skerry
