// Triangles of the overlay: text and panels over the picture.
#ifndef SKERRY_SHARED_OVERLAY_H
#define SKERRY_SHARED_OVERLAY_H
#include "types.h"
SHARED_BEGIN

struct OverlayVertex {
  vec2 position;  // picture [pixels], docs/conventions.md
  vec2 uv;        // font atlas, 0..1
  uint color;     // sRGB with straight alpha: bits 0-7 red, 8-15 green, 16-23 blue, 24-31 alpha
  uint clip;      // index of the rectangle that bounds it, kOverlayPicture for a coloured picture
};
const uint kOverlayPicture = 0x80000000u;  // uv is of the pictures, not of the font

struct OverlayConstants {
  vec2 ndc_from_pixel;  // 2 / picture size
};

SHARED_END
#endif
