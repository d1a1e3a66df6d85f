// Light of the sky that stays in the world, as CPU and GPU share it: for each drawn face, how much
// of the sky its corners see. docs/decisions/0028-sky-light-on-faces.md.
//
// Two buffers of RGBA32_UINT texels. The first begins with a word an island, four a texel: the
// first texel of its sky. A sky is kIndirectIslandTexels, which islands may share: what it sends to
// their six faces now (sky_irradiance()), then harmonics of what sky, sun and moon send to them: a
// texel a channel, halves of degrees 1 and 2 in order, then a texel with floats of degree 0, then
// one for each slot of key directions: irradiance, floats, of sun and moon that are followed from
// there, which the harmonics are without. Of the
// second, texel i < kMaxIslands is island i's grid: x lowest chunk (10 bits each of x, y, z from
// bit 0 up, two's complement), y chunks along x, y, z (8 bits each; 24-31 log2 of a voxel's edge),
// z first texel of its tables, w one of kIndirectDark and the like. The record of a face that sees
// all of its sky is at kIndirectOpenRecord. From kIndirectFirst on:
// - a table a chunk of the grid (z fastest, x, y slowest): kIndirectTableTexels, a word a brick of
// 8^3
//   voxels (index z + 8 x + 64 y), the first texel of the brick's masks, or 0: it has no face; with
//   kIndirectTinted if records of the chunk have a tint, kIndirectKeyed if they have light
//   from key directions;
// - a brick's masks: for each face direction and y of the brick a texel: xy which voxels have the
// face
//   (x: those with x < 4; bit z + 8 (x % 4)), zw the record of the first of each;
// - a face's record: two texels with two words a corner, a byte a lobe: share of the lobe that is
// seen;
//   then a texel with a word a corner: irradiance of weak lamps and of all light of lamps that
//   other faces reflect, shared exponent (9, 9, 9, 5 bits); then a texel of the light of the sky
//   that other faces reflect, as a function of harmonics e of what comes from infinity
//   (engine/core/harmonics.h): x colour c, shared exponent; y a byte a corner, its share s; zw a
//   signed byte each of 8 numbers h in -1..1: irradiance c s max(0, e[0] + kMostBounceShape * sum
//   of h[i] e[i + 1]). Corner b + 2 c, where b and c are 1 at the far end of the axes after the
//   face's own (y, z for x faces; z, x for y faces; x, y for z faces). Then, if it has them, what
//   other faces reflect to it under irradiance 1 from the key directions: x, z colour of each slot,
//   shared exponent; y, w a byte a corner, its share. Then, if it has one, its
//   tint: a word a corner: colour of the light that lobes say is seen, 0..1, shared exponent.
#ifndef SKERRY_SHARED_INDIRECT_H
#define SKERRY_SHARED_INDIRECT_H
#include "types.h"
SHARED_BEGIN

// Ways to the sky that are looked along, in each octant: lattice vectors.
SHARED_CONST uint kSkyPatternCount = 16u;
SHARED_CONST ivec3 kSkyPatterns[16] = {
    {1, 1, 1}, {1, 1, 2}, {1, 2, 1}, {2, 1, 1}, {1, 2, 2}, {2, 1, 2}, {2, 2, 1}, {1, 1, 4},
    {1, 4, 1}, {4, 1, 1}, {1, 2, 4}, {1, 4, 2}, {2, 1, 4}, {2, 4, 1}, {4, 1, 2}, {4, 2, 1}};

// A face's hemisphere has eight lobes, by height most, as the sky changes. Level faces have four
// quarters (bit 0: negative z, bit 1: negative x), and each of them a steep part and a grazing one,
// 2 * quarter + (0 steep, 1 grazing). Upright faces have two halves by the other level axis (bit 0:
// negative), and each of them four parts, 4 * half + (0 steep, 1 halfway, 2 low, 3 below the
// level).
SHARED_CONST uint kSkyLobes = 8u;
SHARED_CONST float kSteepSine = 0.6f;
SHARED_CONST float kLowSine = 0.3f;
// Of a face of an axis, the lobe that a pattern's cell belongs to.
// @param octant bit a: negative along axis a. @param sine of the pattern's height, from 0 to 1.
SHARED_FUNCTION uint sky_lobe(uint axis, uint octant, float sine) {
  uint x = octant & 1u, z = octant >> 2u;
  uint steep = sine >= kSteepSine ? 0u : 1u;
  if (axis == 1u) return 2u * (z + 2u * x) + steep;
  uint part = (octant & 2u) != 0u ? 3u : sine >= kLowSine ? steep : 2u;
  return 4u * (axis == 0u ? z : x) + part;
}

SHARED_CONST uint kIndirectSkyTexels =
    3u;  // a face: red, green, blue; halves of the lobes in order
SHARED_CONST uint kIndirectHarmonics = 18u;  // of a sky's texels: after 6 faces
SHARED_CONST uint kIndirectKeys = 22u;       // of a sky's texels: after them
SHARED_CONST uint kIndirectIslandTexels = 24u;
SHARED_CONST uint kIndirectDark = 0u;            // nothing is known of an island's faces
SHARED_CONST uint kIndirectFaces = 1u;           // tables say what each face sees
SHARED_CONST uint kIndirectOpen = 2u;            // all faces see all of their sky
SHARED_CONST uint kIndirectOpenRecord = 65536u;  // kMaxIslands
SHARED_CONST uint kIndirectFirst = 65540u;       // + kIndirectRecordTexels
SHARED_CONST uint kIndirectTableTexels = 128u;
SHARED_CONST uint kIndirectBrickTexels = 48u;
SHARED_CONST uint kIndirectRecordTexels = 4u;
SHARED_CONST uint kIndirectTinted = 0x80000000u;
SHARED_CONST uint kIndirectKeyed = 0x40000000u;
// The most that a harmonic of degree 1 or 2 can be of that of degree 0, rounded up.
SHARED_CONST float kMostBounceShape = 2.25f;

// What is read of it: FrameConstants do not have it, programs are made for it.
SHARED_CONST uint kIndirectOff = 0u;
SHARED_CONST uint kIndirectSky = 1u;   // light of the sky
SHARED_CONST uint kIndirectFull = 2u;  // and of weak lamps, and what surfaces reflect

SHARED_END
#endif
