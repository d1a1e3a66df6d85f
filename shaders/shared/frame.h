// The constants of one frame. Spaces and units: docs/conventions.md ("world" is relative to the
// camera, in blocks).
#ifndef SKERRY_SHARED_FRAME_H
#define SKERRY_SHARED_FRAME_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST uint kBodyCount = 2u;          // 0 the sun, 1 the moon
SHARED_CONST float kBodyRadius = 0.00465f;  // of the discs they light from [rad]
SHARED_CONST uint kCascadeCount = 4u;       // a body
SHARED_CONST uint kViewCount = 17u;  // 0 the camera, then cascades of the sun (1..4) and of the
                                     // moon (5..8), parts of those that may lag, two a body, and
                                     // glass before one body's cascades
SHARED_CONST uint kListCount =
    3u;  // draw lists a view: 0 opaque, 1 cut-out and plants, 2 translucent
SHARED_CONST uint kMaxIslands = 65536u;       // resident at once: what a surface's word can name
SHARED_CONST uint kMaxQuadsPerDraw = 16384u;  // 4 vertices a quad, 16-bit indices
SHARED_CONST uint kCullGroup = 256u;          // sections a culling work group looks at

// A directional light that is above the horizon; irradiance 0 otherwise.
struct Body {
  vec3 to_light;       // unit, world axes
  vec3 irradiance;     // linear RGB on a surface facing it
  uint first_cascade;  // index into FrameConstants.cascades
  uint cascade_count;  // 0: casts no shadows because it gives no light, or shadows are off
};

// One shadow map layer: an orthographic view of a sphere around the camera.
struct Cascade {
  vec4 map_from_world_x;  // dot(row, (p, 1)): texel coordinate, 0..map size
  vec4 map_from_world_y;
  vec4 map_from_world_z;  // reverse depth, 1 nearest the light
  float radius;           // blocks; the cascade serves points up to this far from the camera
  float texel_blocks;     // a texel's edge [blocks]
  float depth_per_block;  // change of depth for one block towards the light
  uint layer;             // of the shadow map array
  uint glass_layer;       // of the array of maps of glass
  uvec4 glass_area;  // its texels that show glass, from xy to before zw; empty: none stands before
};

struct FrameConstants {
  mat4 clip_from_world;
  vec3 ray_right;  // camera axes; ray_right and ray_up are scaled by the tangent of the half field
                   // of view
  vec3 ray_up;
  vec3 ray_forward;
  vec2 pixel_to_ndc;     // 2 / image size
  vec2 sample_in_pixel;  // place that is sampled, from the pixel's corner [pixels]: 0.5, its
                         // centre, unless pictures are mixed over time
  uvec2 size;            // of the images that are drawn [pixels]
  uvec4 layers_area;  // from xy to before zw: pixels outside show no water or glass, and its layers
                      // have any value there
  uvec4 radiance_area;    // from xy to before zw: pixels whose radiance is kept as an image beside
                          // the picture, or before it is made
  uvec2 picture_size;     // smaller by the samples along a pixel's edge [pixels]
  float near_plane;       // blocks
  float display_peak;     // brightest value of the picture, sRGB-encoded, 0..1
  float display_black;    // darkest value that the display shows apart from 0, sRGB-encoded
  float time_s;           // seconds of play, reduced to one hour, for water ripples
  uint shading_flat;      // 1: shadow result times light colour, no N.L
  uint glass_body;        // whose light is known to pass through glass: the brighter one's
  float glass_per_texel;  // texels of a map of glass along one of a shadow map; the middle of each
                          // is that of one
  uint camera_medium;     // block id the camera is in: 0 air, else a translucent block
  uint medium_surface;    // word of the face above the camera through which light enters that
                          // medium, as the G-buffer has words; 0: none is known
  vec3 medium_surface_place;  // its middle
  float medium_light;         // share of the light that enters there, which reaches the camera
  float shadow_blur;          // largest radius of the shadow filter [blocks]
  float sky_horizon;          // elevation of the true horizon [rad], not positive
  float sky_yaw;              // azimuth of a panorama's middle [rad]
  float haze_per_block;       // extinction of clear air [1/block]
  float body_in_air;  // where the sky lights the air: how much of it sun or moon lights first
  float ao_strength;  // share of light that a closed corner takes, 0..1
  Body bodies[kBodyCount];
  Cascade cascades[8];
};

// One frustum to cull against.
struct CullView {
  vec4 planes[6];     // dot(plane, (p, 1)) >= 0 inside
  vec3 eye;           // perspective: the eye; orthographic: unit vector towards the light
  uint orthographic;  // 0 or 1
  uint enabled;       // 0: nothing is drawn in this view
  uint first_section, section_limit;  // slots that it draws, [first, limit); limit 0: there is none
  uint glass;  // 1: translucent quads alone are drawn; 0: of an orthographic view, all others
};

// Source-relative world from voxel coordinates of one section: p.x = dot(x, (v, 1)). The source is
// the view's own centre.
struct SectionTransform {
  vec4 x;
  vec4 y;
  vec4 z;
  uint blend;         // Section.blend
  uint first_cutout;  // the section's first quad in the arena that is not opaque
};

// Counts of one view, read back for --stats and the overlay.
struct CullStats {
  uint sections_in;      // resident sections
  uint sections_passed;  // inside the frustum with something facing the view
  uint draws;            // indirect commands
  uint quads;            // drawn
  uint quads_in_view;    // of sections_passed, drawn or hidden by others
};

// Depths by which what is hidden is found: the farthest surface of each square of pixels. The fine
// squares of the picture, row by row, then the coarse ones.
SHARED_CONST uint kFineDepthEdge = 8u;     // pixels
SHARED_CONST uint kCoarseDepthEdge = 64u;  // pixels

SHARED_CONST uint kTileEdge = 8u;  // pixels
SHARED_CONST uint kTileRow =
    32768u;  // tiles in one row of an indirect dispatch; 65,535 is the least a device must take

SHARED_CONST uint kChooseGroup = 16u;  // invocations that choose_samples.comp has for a tile

// Lists of pixels whose light is worked out: those that ask no light and those that ask some; then,
// without pixels of their own, the same for programs that keep radiance.
SHARED_CONST uint kSampleLists = 4u;
SHARED_CONST uint kKeepingLists = 2u;  // the first of the latter

// One kind's tiles: arguments of vkCmdDispatchIndirect, then how many tiles they are for.
struct TileDispatch {
  uint groups_x;
  uint groups_y;
  uint groups_z;
  uint tiles;
};

struct PixelStats {
  uint non_finite;  // pixels in which a pass met a NaN or Inf
  uint black;       // pixels that are exactly (0, 0, 0) before tone mapping
};

SHARED_END
#endif
