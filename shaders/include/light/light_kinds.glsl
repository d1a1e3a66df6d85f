// Kinds of lights that the frame has, a bit each. A constant, so that the others cost nothing.
#ifndef SKERRY_LIGHT_KINDS_GLSL
#define SKERRY_LIGHT_KINDS_GLSL
#include "shared/constants.h"
layout(constant_id = kLightKindsConstant) const uint kLightKinds = 31u;
#endif
