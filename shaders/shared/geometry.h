// Voxel geometry as the GPU sees it: quads, sections (one resident chunk mesh each), islands,
// materials. Axes, faces and winding: docs/conventions.md.
#ifndef SKERRY_SHARED_GEOMETRY_H
#define SKERRY_SHARED_GEOMETRY_H
#include "types.h"
SHARED_BEGIN

// Faces: axis * 2 + (negative ? 1 : 0): 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z. 6 and 7: the two
// diagonals of a plant. A face's in-plane axes (u, v): x faces (z, y); y faces (x, z); z faces (x,
// y).
SHARED_CONST uint kFaceCount = 6u;
SHARED_CONST uint kChunkEdge = 64u;  // voxels along a chunk's edge

SHARED_CONST uint kMaxMaterials = 1024u;  // block ids with a look of their own

// A surface's word: bits 0-9 block id, 10-12 face, 13-28 index into the island table, and in the
// G-buffer bit 31, set where there is a surface.
SHARED_CONST uint kFaceShift = 10u;
SHARED_CONST uint kIslandShift = 13u;
SHARED_CONST uint kSurfaceHere = 0x80000000u;
SHARED_CONST uint kOppositeFace = 1024u;  // xor turns a face into the one that looks the other way
SHARED_FUNCTION uint surface_block(uint word) {
  return word & 1023u;
}
SHARED_FUNCTION uint surface_face(uint word) {
  return (word >> kFaceShift) & 7u;
}
SHARED_FUNCTION uint surface_island(uint word) {
  return (word >> kIslandShift) & 65535u;
}

// Quad ranges of a section, in this order in memory. Opaque and cut-out go to the G-buffer,
// translucent to layers.
SHARED_CONST uint kRangeOpaque = 0u;        // 6 ranges, one a face
SHARED_CONST uint kRangeCutout = 6u;        // 6 ranges, one a face
SHARED_CONST uint kRangePlant = 12u;        // 1 range, faces 6 and 7, drawn from both sides
SHARED_CONST uint kRangeTranslucent = 13u;  // 6 ranges, one a face, drawn from both sides
SHARED_CONST uint kRangeCount = 19u;

// One merged rectangle of faces, 8 bytes.
struct Quad {
  uint geometry;  // bits 0-5 x, 6-11 y, 12-17 z: the lowest voxel, chunk-local; 18-23 extent along
                  // u minus 1; 24-29 along v minus 1; 30-31 see touched_by()
  uint material;  // bits 0-28 a surface's word; the island is 0 from the mesher and set on upload;
                  // 29-31 see touched_by()
};
// Which other translucent block a translucent face touches, by Material.translucent_block; 0: none.
SHARED_CONST uint kTouchedShift = 29u;  // of all but its two lowest bits, in Quad.material
SHARED_FUNCTION uint touched_by(uint geometry, uint material) {
  return (geometry >> 30) | ((material >> kTouchedShift) << 2);
}

// One resident chunk mesh. Its quads are first_quad .. first_quad + range_end[kRangeCount - 1].
struct Section {
  ivec3 origin;          // lattice position of the chunk's lowest corner [blocks]
  uint island;           // index into the island table
  uint voxel_size_log2;  // a voxel's edge is 2^this blocks (0: full detail)
  uint first_quad;       // index into the quad arena
  uint bounds_min;       // tight box of the faces, voxels: bits 0-6 x, 7-13 y, 14-20 z (0..64)
  uint bounds_max;       // same packing, exclusive upper corner
  uint blend;            // see below
  uint range_end[kRangeCount];  // running ends of the ranges, relative to first_quad
};

// In which pixels a section is drawn while its level of detail changes (Section.blend). 0: in all.
// Else bits 0-7: the first, and 8-15: past the last of the steps of a pattern of pixels
// (include/scene/blend.glsl).
SHARED_CONST uint kBlendSteps = 64u;
SHARED_CONST uint kBlendGoes = 65536u;  // bit: the light falls on what comes, and so does water
SHARED_FUNCTION uint blend_first(uint blend) {
  return blend & 255u;
}
SHARED_FUNCTION uint blend_end(uint blend) {
  return (blend >> 8) & 255u;
}

// Camera-relative world from island lattice: p = x * axis_x + y * axis_y + z * axis_z + translation
// [blocks]. kIslandTexels texels of 128 bits.
SHARED_CONST uint kIslandTexels = 3u;
struct IslandTransform {
  vec3 axis_x;
  vec3 axis_y;
  vec3 axis_z;
  vec3 translation;
};

// From the albedo (of its brightest channel) where a block's texels begin to emit to that where
// they emit in full.
SHARED_CONST float kGlowRise = 0.5;

// What a block id looks like. Indexed by block id.
struct Material {
  uint layer_side;    // layer of the block texture array for faces +-x, +-z and plants
  uint layer_top;     // for +y
  uint layer_bottom;  // for -y
  uint emission;     // half floats. Bits 0-15: radiance = albedo * this [the unit of sun radiance];
                     // 16-31: the albedo from which texels emit in full (see kGlowRise), 0: all do
  vec3 absorption;   // translucent kinds [1/block of path]; else 0
  float roughness;   // 0..1 perceptual
  float metalness;   // 0..1: how much of what it reflects is mirrored, in its own colour
  uint light_class;  // equal for ids that light shows alike, but for their textures
  uint translucent_block;  // of row n, not of id n: the nth translucent block's id, see Quad; or 0
  float scattering;  // translucent kinds: evenly to all sides, white [1/block of path]; else 0
  uint liquid;       // 1: level surfaces ripple
};
// A Material as words of 32 bits, for shaders that load one of them, and which of these is a layer.
SHARED_CONST uint kMaterialWords = 13u;
SHARED_CONST uint kLayerSideWord = 0u;
SHARED_CONST uint kLayerTopWord = 1u;
SHARED_CONST uint kLayerBottomWord = 2u;

// Arguments of vkCmdDrawIndexedIndirect (VkDrawIndexedIndirectCommand). firstInstance carries the
// section index.
struct DrawCommand {
  uint index_count;
  uint instance_count;
  uint first_index;
  uint vertex_offset;
  uint section;
};

SHARED_END
#endif
