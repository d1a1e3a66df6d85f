#pragma once
#include <algorithm>
#include <span>
#include <type_traits>

namespace skerry {

/// Whether two values are equal to the last bit: zeros of either sign differ, NaN is itself.
template <class T>
bool same_bits(const T& a, const T& b) {
  static_assert(std::is_trivially_copyable_v<T>);
  return std::ranges::equal(std::as_bytes(std::span(&a, 1)), std::as_bytes(std::span(&b, 1)));
}

}  // namespace skerry
