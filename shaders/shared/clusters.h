// The grid of clusters that lights are sorted into (Olsson, Billeter and Assarsson, Clustered
// Deferred and Forward Shading, 2012; docs/decisions/0012): picture tiles times slices of depth.
#ifndef SKERRY_SHARED_CLUSTERS_H
#define SKERRY_SHARED_CLUSTERS_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST uint kClusterSlices = 24u;      // of depth: two an octave from one block on
SHARED_CONST uint kBinClusters = 4u;         // tiles along a coarse bin
SHARED_CONST uint kClusterGroup = 64u;       // invocations of a work group
SHARED_CONST uint kAllLights = 0xffffffffu;  // as Cluster.first: its list did not fit

// Of one frame. Axes are unit and camera's; positions are relative to the camera.
struct ClusterGrid {
  vec3 right;
  vec3 up;
  vec3 forward;
  vec2 tan_half;     // of the field of view, along right and up
  uvec2 size;        // picture [pixels]
  float near_plane;  // blocks
  uint edge_log2;    // of the pixels along a tile, 3 to 6
  uint tiles_x;      // in the picture
  uint tiles_y;
  uint bins_x;  // of kBinClusters tiles
  uint bins_y;
  uint light_count;
  uint light_words;  // 32-bit words that hold a bit a light
  uint chunk_words;  // of them that one invocation looks through
  uint chunks;
  uint unit_log2;     // lists begin at multiples of 2^this entries
  uint capacity;      // of the entries [such units]
  uvec4 layers_area;  // see FrameConstants
  uint
      marked_slices;  // a bit a slice: occupied in every tile, as about a camera in water or clouds
};

// What an 8x8-pixel tile, or a cluster's tile, shows.
struct TileDepths {
  uint slices;    // bit a slice: it holds a surface
  float nearest;  // distance along the view axis [blocks]; nearest > farthest: nothing
  float farthest;
};

// A cluster's lights: entries[first .. first + count), in the order of the lights; or all of them.
struct Cluster {
  uint first;
  uint count;
};

// Arguments of the indirect dispatch over occupied clusters, then what a frame asked for.
struct ClusterWork {
  uint groups_x;
  uint groups_y;
  uint groups_z;
  uint clusters;  // occupied
  uint units;     // of entries, wanted: more than the capacity where lists did not fit
};

SHARED_END
#endif
