#pragma once
#include "engine/render/frame/settings.h"

namespace skerry::render {

/// IEC 61966-2-1. @param linear 0..1.
double srgb_encoded(double linear);

/// An sRGB value of the picture as it is fitted to a display (shaders/include/post/tonemap.glsl):
/// rises all the way, from exactly 0 at 0 to the display's peak at 1.
double displayed(double encoded, const DisplaySettings& display);

}  // namespace skerry::render
