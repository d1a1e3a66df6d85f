#pragma once

namespace skerry::render {

/// Time constants of an eye that adapts [seconds]: after this long 1/e of the way is left. Getting
/// used to light is fast; to the dark slower, a hundred times faster than in life, which has
/// minutes to spare.
inline constexpr double kLightAdaptationSeconds = 0.4, kDarkAdaptationSeconds = 2.5;

/// Exposure after `dt_s` seconds of looking at a scene that asks for `target_ev`, from `ev`
/// [stops]. Closed form: the rest of the way, in stops, falls off exponentially. So the result lies
/// between `ev` and the target, never beyond, moves towards the target the farther the longer, is
/// `ev` at 0 and the target after long, and is the same (to rounding) however the time is split.
/// @param dt_s seconds, >= 0; asserted. @param target_ev not finite: nothing was metered, `ev`
/// stays.
double adapted_ev(double ev, double target_ev, double dt_s);

}  // namespace skerry::render
