#version 460
#extension GL_GOOGLE_include_directive : require
// Sizes the dispatches of shade_samples.comp by how many pixels were listed. A pass of its own: kept up to date by atomics while pixels are
// listed, the sizes cost lavapipe 1.5 ms at 1280x720.
#include "include/frame/common.glsl"
#include "shared/bindings.h"

layout(local_size_x = 2) in;

layout(scalar, binding = kListedPixelsBinding) buffer Listed { TileDispatch listed[2]; };  // see choose_samples.comp

void main() {
  uint list = gl_LocalInvocationIndex, groups = (listed[list].tiles + 63u) / 64u;
  listed[list].groups_x = min(groups, kTileRow);
  listed[list].groups_y = max((groups + kTileRow - 1u) / kTileRow, 1u);
  listed[list].groups_z = 1u;
}
