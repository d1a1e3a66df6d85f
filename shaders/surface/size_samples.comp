#version 460
#extension GL_GOOGLE_include_directive : require
// Sizes the dispatches of shade_samples.comp by how many pixels were listed, of programs that keep radiance or of those that do not. A pass of
// its own: kept up to date by atomics while pixels are listed, the sizes cost lavapipe 1.5 ms at 1280x720.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 2) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kLayerTilesBinding) readonly buffer Layers { TileDispatch layers[]; };
layout(scalar, binding = kListedPixelsBinding) buffer Listed { TileDispatch listed[kSampleLists]; };  // see choose_samples.comp

layout(constant_id = kTranslucentConstant) const bool kTranslucent = false;  // if not, something is bound in place of the layers

void main() {
  uint list = gl_LocalInvocationIndex, groups = (listed[list].tiles + 63u) / 64u;
  bool keep = kTranslucent && (layers[0].tiles != 0u || frame.camera_medium != 0u);  // as in classify_shaded_tiles.comp
  for (uint i = list; i < kSampleLists; i += kKeepingLists) {
    listed[i].groups_x = keep == (i >= kKeepingLists) ? min(groups, kTileRow) : 0u;
    listed[i].groups_y = max((groups + kTileRow - 1u) / kTileRow, 1u);
    listed[i].groups_z = 1u;
  }
}
