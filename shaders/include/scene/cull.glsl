// What the three culling steps share. The draws of a list keep the order of the sections, so that pictures do not depend on
// the timing of threads: each step is a scan, not an atomic counter.
#ifndef SKERRY_CULL_GLSL
#define SKERRY_CULL_GLSL
#include "include/frame/common.glsl"

// Of a mask of ranges: the program for cut-outs draws the opaque ones, too, because it leaves pixels out.
const uint kBlendedMask = 1u << 30;

// Ranges of a list, in memory order.
uint list_first_range(uint mask, uint list) {
  return list == 0u || (list == 1u && (mask & kBlendedMask) != 0u) ? kRangeOpaque : list == 1u ? kRangeCutout : kRangeTranslucent;
}
uint list_end_range(uint mask, uint list) {
  return list == 0u ? ((mask & kBlendedMask) != 0u ? kRangeOpaque : kRangeCutout) : list == 1u ? kRangeTranslucent : kRangeCount;
}

uint range_begin(Section s, uint range) { return range == 0u ? 0u : s.range_end[range - 1u]; }

// Draws a list needs for the ranges in `mask`: neighbouring ranges become one run, a run is split at kMaxQuadsPerDraw.
uint draw_count(Section s, uint mask, uint list) {
  uint draws = 0u;
  uint begin = 0u, end = 0u;
  for (uint r = list_first_range(mask, list); r < list_end_range(mask, list); ++r) {
    uint b = range_begin(s, r), e = s.range_end[r];
    if ((mask & (1u << r)) == 0u || b == e) continue;
    if (b != end || begin == end) {
      draws += (end - begin + kMaxQuadsPerDraw - 1u) / kMaxQuadsPerDraw;
      begin = b;
    }
    end = e;
  }
  return draws + (end - begin + kMaxQuadsPerDraw - 1u) / kMaxQuadsPerDraw;
}
#endif
