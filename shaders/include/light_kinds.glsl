// Kinds of lights that the frame has, a bit each. A constant, so that the others cost nothing.
#ifndef SKERRY_LIGHT_KINDS_GLSL
#define SKERRY_LIGHT_KINDS_GLSL
layout(constant_id = 12) const uint kLightKinds = 31u;
#endif
