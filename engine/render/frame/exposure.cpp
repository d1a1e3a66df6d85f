#include "engine/render/frame/exposure.h"

#include <cmath>

#include "engine/core/check.h"

namespace skerry::render {

double adapted_ev(double ev, double target_ev, double dt_s) {
  SKERRY_ASSERT(std::isfinite(ev) && dt_s >= 0.0);
  if (!std::isfinite(target_ev)) return ev;
  const double constant_s = target_ev > ev ? kLightAdaptationSeconds : kDarkAdaptationSeconds;
  // lerp promises exact ends and no overshoot; expm1 keeps short steps from rounding to nothing.
  return std::lerp(ev, target_ev, -std::expm1(-dt_s / constant_s));
}

}  // namespace skerry::render
