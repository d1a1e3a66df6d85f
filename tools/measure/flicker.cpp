#include "tools/measure/flicker.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "engine/core/check.h"

namespace skerry::measure {

FlickerCounts count_flicker(const Moment& before, const Moment& now) {
  const std::size_t bytes = now.shown.size();
  SKERRY_ASSERT(now.ideal.size() == bytes && before.shown.size() == bytes &&
                before.ideal.size() == bytes);
  FlickerCounts out;
  out.pixels = bytes / 4;
  for (std::size_t pixel = 0; pixel < out.pixels; ++pixel) {
    bool changed = false, truly = false, flickered = false;
    for (std::size_t i = 4 * pixel; i < 4 * pixel + 3; ++i) {
      const int shown = now.shown[i] - before.shown[i], ideal = now.ideal[i] - before.ideal[i];
      changed |= std::abs(shown) > kSeenChange;
      truly |= std::abs(ideal) > kSeenChange;
      flickered |= std::abs(shown - ideal) > kSeenChange;
    }
    out.changed += changed;
    out.truly_changed += truly;
    out.flickered += flickered;
  }
  return out;
}

StepCounts count_steps(std::span<const std::uint8_t> before, std::span<const std::uint8_t> now,
                       int may) {
  SKERRY_ASSERT(before.size() == now.size());
  StepCounts out;
  out.pixels = now.size() / 4;
  for (std::size_t pixel = 0; pixel < out.pixels; ++pixel) {
    int most = 0;
    for (std::size_t i = 4 * pixel; i < 4 * pixel + 3; ++i)
      most = std::max(most, std::abs(now[i] - before[i]));
    out.stepped += most > may;
    out.largest = std::max(out.largest, most);
  }
  return out;
}

}  // namespace skerry::measure
