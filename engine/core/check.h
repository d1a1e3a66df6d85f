#pragma once

namespace skerry {

/// Prints expression, file and line on stderr, then aborts.
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);

}  // namespace skerry

/// For programmer mistakes; on in every build.
#define SKERRY_ASSERT(x) \
  ((x) ? static_cast<void>(0) : ::skerry::assertion_failed(#x, __FILE__, __LINE__))
