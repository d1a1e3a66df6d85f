// Clouds of one frame: the layer and the volumes of files. Model and units: docs/clouds.md. "World"
// is relative to the camera, in blocks; "index" is a file's voxels, samples at whole numbers.
#ifndef SKERRY_SHARED_CLOUDS_H
#define SKERRY_SHARED_CLOUDS_H
#include "frame.h"
#include "types.h"
SHARED_BEGIN

SHARED_CONST uint kMaxCloudVolumes = 8u;

// The layer's noise repeats after these distances [blocks]; all divide kLayerPeriod.
SHARED_CONST uint kCloudNoiseEdge = 128u;  // texels
SHARED_CONST float kCloudShapePeriod = 2048.0f;
SHARED_CONST float kCloudDetailPeriod = 320.0f;
SHARED_CONST float kCloudWeatherPeriod = 10240.0f;
SHARED_CONST uint kLayerPeriod = 10240u;
// The noise as a march asks for it: layers of four slices of height, the last one being the first
// of the next layer.
SHARED_CONST uint kSlicesPerLayer = 3u;
SHARED_CONST uint kCloudNoiseLayers = 43u;  // the last has only two
// The layer thins out between these distances from the eye [blocks].
SHARED_CONST float kLayerFadeBegin = 12000.0f;
SHARED_CONST float kLayerFadeEnd = 16000.0f;

// Optical depth of the layer towards a body: columns along the light, denser near the camera.
SHARED_CONST uint kLayerLightEdge = 256u;  // columns
SHARED_CONST float kLayerLightNear =
    1500.0f;  // distance at which columns are twice as far apart...
SHARED_CONST float kLayerLightReach = 16000.0f;  // last column's distance [blocks]
SHARED_CONST float kLeastLightSine = 0.04f;      // lower light takes the way of this altitude

// Optical depth of a volume towards a body: a box of texels over the volume's box.
SHARED_CONST uint kVolumeLightEdge = 64u;

SHARED_CONST uint kCloudBrickEdge = 8u;    // voxels of a brick, as an OpenVDB leaf
SHARED_CONST uint kCloudBrickTexels = 9u;  // along a brick in the atlas: its voxels and one beyond
SHARED_CONST uint kCloudCellLevels = 3u;   // of the maxima: cells of 1, 2 and 4 bricks

// Ways along which clouds are looked through: to sun, moon and zenith, which stands for the sky.
SHARED_CONST uint kCloudLights = 3u;
SHARED_CONST uint kCloudZenith = 2u;

// What clouds are lit by from one side.
struct CloudLight {
  vec3 to_light;    // unit, world
  vec3 irradiance;  // of a surface facing it; of the zenith 0
};

struct CloudLayer {
  vec3 place;  // of the camera: x and z in the noise, 0..kLayerPeriod; y over the base [blocks]
  float thickness;   // blocks
  float extinction;  // of its densest places [1/block]
  float coverage;    // 0..1
};

// A grid of a file. Values are 0..1, of its largest.
struct CloudVolume {
  vec4 index_x;  // index from world: dot(row, (p, 1))
  vec4 index_y;
  vec4 index_z;
  vec3 low;  // support box [index]: beyond it there is nothing
  vec3 high;
  float extinction;   // of value 1 [1/block]
  vec3 emission;      // of value 1 [radiance/block]
  float step_blocks;  // of the march
  vec3 first_cell;    // of its region in the cells [cells]
  vec3 cell_count;
  vec3 cell_low;                    // its first brick [index]
  vec3 light_texels;                // of its region in the light image
  float light_first[kCloudLights];  // where that begins along z [texels], a way
};

struct CloudConstants {
  CloudLight lights[kCloudLights];
  // Mean radiance of the sky, in two parts: what comes in along a body's way, and what is left of
  // it when none lights the air, along the zenith's.
  vec3 sky_beside_body;
  vec3 sky_above;
  float shadow_steps;
  float steps;  // of the layer
  CloudLayer layer;
  CloudVolume volumes[kMaxCloudVolumes];
};

// The texels of the volumes' light image that one dispatch fills.
struct CloudLightJob {
  uint volume;
  uint light;  // below kCloudLights
};

SHARED_END
#endif
