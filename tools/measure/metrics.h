#pragma once
#include "tools/measure/picture.h"

namespace skerry::measure {

/// Mean over pixels and channels of (test - reference)^2 / (reference^2 + 0.01). 0: equal.
double rel_mse(const Picture& reference, const Picture& test);

/// Peak signal to noise ratio of linear radiance [dB]; the peak is the reference's 99.9th
/// percentile of all channels (a sun disc of thousands would hide every error), 1 when that is 0.
/// Infinity for equal pictures.
double psnr(const Picture& reference, const Picture& test);

}  // namespace skerry::measure
