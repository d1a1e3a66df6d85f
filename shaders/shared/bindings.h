// Descriptor bindings of set 0: one number for one thing, in every program. Shaders declare and
// passes bind by these names; no number is written elsewhere. Whether a thing is read as a uniform
// or as a storage buffer is the shader's choice. docs/conventions.md.
#ifndef SKERRY_SHARED_BINDINGS_H
#define SKERRY_SHARED_BINDINGS_H
#include "types.h"

SHARED_BEGIN
// The frame and the scene.
SHARED_CONST uint kFrameBinding = 0u;          // FrameConstants
SHARED_CONST uint kIslandsBinding = 1u;        // texels of IslandTransform[]
SHARED_CONST uint kMaterialsBinding = 2u;      // Material[]
SHARED_CONST uint kBlockTexturesBinding = 3u;  // array of all blocks' textures
SHARED_CONST uint kSkyBinding = 4u;            // SkyConstants
SHARED_CONST uint kSkyTableBinding = 5u;       // radiance of the sky by direction
SHARED_CONST uint kPixelStatsBinding = 6u;     // PixelStats
SHARED_CONST uint kExposureBinding = 7u;       // Exposure

// G-buffer and shadow maps.
SHARED_CONST uint kSurfacesBinding = 8u;  // words of opaque surfaces
SHARED_CONST uint kDepthsBinding = 9u;    // of opaque surfaces
SHARED_CONST uint kStoredNormalsBinding = 10u;
SHARED_CONST uint kStoredPositionsBinding = 11u;
SHARED_CONST uint kShadowMapsBinding = 12u;
SHARED_CONST uint kPreviousDepthsBinding = 13u;  // of the translucent layer before
SHARED_CONST uint kLayerSurfacesBinding = 14u;   // words of the translucent layers
SHARED_CONST uint kLayerDepthsBinding = 18u;     // four numbers: depths of each layer

// What is drawn to.
SHARED_CONST uint kRadianceBinding = 22u;
SHARED_CONST uint kPictureBinding = 23u;

// Lists of 8x8 tiles.
SHARED_CONST uint kTilesBinding = 24u;
SHARED_CONST uint kTileDispatchesBinding = 25u;  // TileDispatch[]

// Occupancy of the islands.
SHARED_CONST uint kOccupancyGridsBinding = 26u;
SHARED_CONST uint kOccupancyTablesBinding = 27u;
SHARED_CONST uint kOccupancyBricksBinding = 28u;
SHARED_CONST uint kLightIslandsBinding = 29u;  // islands that each light's reach touches

// Clustered lights.
SHARED_CONST uint kLightGridBinding = 30u;     // ClusterGrid
SHARED_CONST uint kLightsBinding = 31u;        // texels of Light[]
SHARED_CONST uint kClustersBinding = 32u;      // Cluster[]
SHARED_CONST uint kLightEntriesBinding = 33u;  // lights of each cluster
SHARED_CONST uint kTileDepthsBinding = 34u;    // TileDepths[] of 8x8 tiles
SHARED_CONST uint kGridTilesBinding = 35u;     // TileDepths[] of the grid's tiles
SHARED_CONST uint kLightBinsBinding = 36u;
SHARED_CONST uint kClusterWorkBinding = 37u;       // ClusterWork
SHARED_CONST uint kOccupiedClustersBinding = 38u;  // clusters with a surface in them
SHARED_CONST uint kLightCountsBinding = 39u;       // of each occupied cluster, by chunk

// Clouds.
SHARED_CONST uint kCloudsBinding = 40u;       // CloudConstants
SHARED_CONST uint kLayerLightBinding = 41u;   // optical depths towards the bodies, of the layer
SHARED_CONST uint kVolumeLightBinding = 42u;  // the same, of files' grids
SHARED_CONST uint kCloudNoiseBinding = 43u;
SHARED_CONST uint kCloudWeatherBinding = 44u;
SHARED_CONST uint kCloudShapesBinding = 45u;
SHARED_CONST uint kCloudBillowsBinding = 46u;
SHARED_CONST uint kCloudCellsBinding = 47u;   // of files' grids: bounds of bricks
SHARED_CONST uint kCloudBricksBinding = 48u;  // of files' grids: values
SHARED_CONST uint kCoarseCloudsBinding = 49u;
SHARED_CONST uint kMirroredCloudsBinding = 50u;

// Culling and drawing of quads.
SHARED_CONST uint kQuadsBinding = 51u;              // Quad[]
SHARED_CONST uint kSectionsBinding = 52u;           // Section[]
SHARED_CONST uint kSectionTransformsBinding = 53u;  // SectionTransform[]
SHARED_CONST uint kCullViewsBinding = 54u;          // CullView[]
SHARED_CONST uint kCullMasksBinding = 55u;
SHARED_CONST uint kCullTotalsBinding = 56u;
SHARED_CONST uint kCullStatsBinding = 57u;     // CullStats[]
SHARED_CONST uint kDrawCommandsBinding = 58u;  // DrawCommand[]
SHARED_CONST uint kDrawCountsBinding = 59u;

// Exposure, bloom and averages.
SHARED_CONST uint kHistogramBinding = 60u;
SHARED_CONST uint kFineBloomBinding = 61u;
SHARED_CONST uint kCoarseBloomBinding = 62u;
SHARED_CONST uint kTotalBinding = 63u;  // sum over the parts of a still

// Overlay.
SHARED_CONST uint kOverlayVerticesBinding = 64u;  // OverlayVertex[]
SHARED_CONST uint kOverlayClipsBinding = 65u;
SHARED_CONST uint kFontBinding = 66u;
SHARED_CONST uint kOverlayPicturesBinding = 67u;

SHARED_CONST uint kTargetBinding = 68u;    // the picture
SHARED_CONST uint kIndirectBinding = 69u;  // texels of shared/indirect.h

// Light at fewer pixels than are drawn.
SHARED_CONST uint kSamplesBinding = 70u;  // of light, at the points of a grid
// TileDispatch[kSampleLists], see choose_samples.comp, then pixels: x in bits 0-15, y in bits
// 16-31.
SHARED_CONST uint kListedPixelsBinding = 71u;

SHARED_CONST uint kMediaLightBinding = 72u;  // see find_media_light.comp

// Past walls: LightReach[].
SHARED_CONST uint kLightReachBinding = 73u;

// Of a picture that is drawn smaller than it is shown.
SHARED_CONST uint kSmallPictureBinding = 74u;

SHARED_CONST uint kMadeBloomBinding = 75u;      // the level that a step of bloom makes
SHARED_CONST uint kMarchedCloudsBinding = 76u;  // the coarse image as it is made
SHARED_CONST uint kMeteredBinding = 77u;        // luminance of the pixels that the meter looks at

// Pixels at edges of surfaces: EdgePixel[].
SHARED_CONST uint kEdgePixelsBinding = 78u;

// Pictures mixed with those of earlier frames.
SHARED_CONST uint kFreshPictureBinding = 79u;  // of this frame alone
SHARED_CONST uint kKeptPicturesBinding = 80u;  // of earlier frames, in slots
SHARED_CONST uint kKeptKeysBinding = 81u;      // of what they show, see kept_key()
SHARED_CONST uint kMotionsBinding = 82u;       // texels of Motion[]

// What is hidden.
SHARED_CONST uint kFarDepthsBinding = 83u;     // see kFineDepthEdge
SHARED_CONST uint kSeenSectionsBinding = 84u;  // uint[section]: 1 if the last frame showed it

SHARED_CONST uint kSkyScatteringBinding = 85u;  // SkyScatter[body][row][azimuth]

// Behind the translucent layers, see sum_tail.frag.
SHARED_CONST uint kTailDepthsBinding = 86u;
SHARED_CONST uint kTailLightBinding = 87u;

SHARED_CONST uint kIslandSkiesBinding = 88u;  // texels of each island's sky, see shared/indirect.h

SHARED_CONST uint kTileShaftsBinding = 89u;  // TileShafts[], of 8x8 tiles

SHARED_CONST uint kBentLightBinding = 90u;  // see bend_rays.comp

SHARED_CONST uint kGlassMapsBinding = 91u;  // see sum_glass.frag, list_glass.frag

SHARED_CONST uint kLayerTilesBinding = 92u;  // TileDispatch[] of tiles that show water or glass

SHARED_END
#endif
