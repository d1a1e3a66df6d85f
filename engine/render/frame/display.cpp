#include "engine/render/frame/display.h"

#include <cmath>

namespace skerry::render {

double srgb_encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double displayed(double encoded, const DisplaySettings& display) {
  constexpr double kDark = 1.0 / 64.0;
  const double black = display.black;
  return srgb_encoded(display.peak) *
         ((1.0 - black) * encoded + black * (1.0 + kDark) * encoded / (encoded + kDark));
}

}  // namespace skerry::render
