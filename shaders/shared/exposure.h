// What the meter hands to the passes that make a picture of scene radiance: docs/exposure.md.
#ifndef SKERRY_SHARED_EXPOSURE_H
#define SKERRY_SHARED_EXPOSURE_H
#include "types.h"
SHARED_BEGIN

// Histogram of luminance. A bin's number is the upper bits of a float: eight bins to a power of
// two, of equal width within it, so that CPU and GPU agree to the last count.
SHARED_CONST uint kHistogramBins = 256u;
SHARED_CONST uint kBinsPerOctave = 8u;
SHARED_CONST int kFirstOctave = -16;  // bin 0 begins at 2^-16; darker pixels are not counted
SHARED_CONST uint kBinShift = 20u;    // of a float's bits: 23 of the mantissa less 3
SHARED_CONST uint kFirstBin = 888u;   // (127 + kFirstOctave) * kBinsPerOctave
SHARED_CONST uint kMeterGroup = 16u;  // edge of a work group of meter_radiance.comp

// Shares of the pixels that are not black, as fractions of 2^32, that the meter passes over.
SHARED_CONST uint kPassedOverDark = 1717986918u;   // the darkest two fifths: shade
SHARED_CONST uint kPassedOverBright = 214748365u;  // the brightest twentieth

// The eye follows changes of light this far: of a stop, 0.7 stops. So nights stay darker than days.
SHARED_CONST float kFollowed = 0.7f;
// Mean luminance that is exposed to the key exactly: a landscape under the noon sun.
SHARED_CONST float kDayLuminance = 0.25f;

// How to meter.
struct Metering {
  float key;     // exposed luminance of kDayLuminance
  float min_ev;  // [stops]
  float max_ev;
  uint stride;   // one pixel of each stride x stride is looked at
  uint decides;  // 1: the picture is developed at what was metered; 0: it is only reported
};

struct Exposure {
  float ev;          // the picture is developed at: tone curve(radiance * 2^-ev) [stops]
  float metered_ev;  // what was metered; holds nothing when `metered` is 0
  uint metered;      // pixels looked at that count as light; 0: the rest holds nothing
  uint first_bin;    // that the mean takes pixels of
  uint last_bin;
  uint most;  // pixels in the fullest bin
};

SHARED_END
#endif
