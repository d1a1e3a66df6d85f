// Specialization constants: one number for one choice, in every program. Shaders declare and passes
// set them by these names. docs/conventions.md.
#ifndef SKERRY_SHARED_CONSTANTS_H
#define SKERRY_SHARED_CONSTANTS_H
#include "types.h"

SHARED_BEGIN
SHARED_CONST uint kTextureTapsConstant = 0u;      // uint: most samples of a texture
SHARED_CONST uint kWaterLayersConstant = 1u;      // uint: translucent layers, 0..4
SHARED_CONST uint kFirstConstant = 2u;            // bool: the first of several
SHARED_CONST uint kTexturedConstant = 3u;         // bool: vertices have texture coordinates
SHARED_CONST uint kNormalCodeConstant = 4u;       // uint: how normals are kept
SHARED_CONST uint kPositionStoredConstant = 5u;   // bool: positions are kept
SHARED_CONST uint kDepth16Constant = 6u;          // bool: depth is kept in 16 bits
SHARED_CONST uint kFirstLayerConstant = 7u;       // bool: nothing lies before the layer
SHARED_CONST uint kBodiesConstant = 8u;           // uint: bits of sun and moon
SHARED_CONST uint kShadowTapsConstant = 9u;       // uint
SHARED_CONST uint kCascadesConstant = 10u;        // uint: of a body
SHARED_CONST uint kHazeConstant = 11u;            // bool
SHARED_CONST uint kLightKindsConstant = 12u;      // uint: bits of the kinds that there are
SHARED_CONST uint kShadowBlurConstant = 13u;      // bool
SHARED_CONST uint kSamplesPerEdgeConstant = 14u;  // uint: of a pixel
SHARED_CONST uint kAoConstant = 15u;              // bool: corners darken
SHARED_CONST uint kOracleConstant = 16u;          // bool: every light may reach every pixel
SHARED_CONST uint kFinestCoverageConstant = 17u;  // bool: coverage by the finest texels
SHARED_CONST uint kChannelConstant = 19u;         // uint: render::DebugView
SHARED_CONST uint kCloudLayerConstant = 20u;      // bool
SHARED_CONST uint kCloudVolumesConstant = 21u;    // uint
SHARED_CONST uint kTranslucentConstant = 22u;     // bool: there is water or glass
SHARED_CONST uint kBehindConstant = 23u;          // bool: behind the nearest water or glass
SHARED_CONST uint kCoarseConstant = 24u;          // bool: there is a coarse image of clouds
SHARED_CONST uint kMirroredCloudsConstant = 25u;  // bool
SHARED_CONST uint kStarsConstant = 27u;           // bool
SHARED_CONST uint kDiscsConstant = 28u;           // bool: of sun and moon
SHARED_CONST uint kToneConstant = 30u;            // uint: render::ToneCurve
SHARED_CONST uint kCalibratedConstant = 31u;      // bool: the display takes other than 0 to 1
SHARED_CONST uint kShadowsConstant = 32u;         // bool: there are shadow maps
SHARED_CONST uint kLitConstant = 33u;             // bool: lamps light it
SHARED_CONST uint kToPictureConstant = 34u;       // bool: pixels may go to the picture at once
SHARED_CONST uint kSkyAloneConstant = 35u;        // bool: there is no geometry
SHARED_CONST uint kBloomConstant = 36u;           // bool
SHARED_CONST uint kAccumulateConstant = 37u;      // bool: adds to the parts before
SHARED_CONST uint kIndirectConstant = 38u;  // uint: kIndirectOff, kIndirectSky or kIndirectFull
SHARED_CONST uint kLightsShadowsConstant = 40u;   // uint: lights whose walls are looked for
SHARED_CONST uint kLightsSoftnessConstant = 41u;  // uint: ways to a light that has a size
SHARED_CONST uint kStepConstant = 42u;            // uint: pixels between points of a grid
SHARED_CONST uint kEveryPixelConstant = 43u;      // bool: all pixels, not a grid's points
SHARED_CONST uint kToleranceConstant = 44u;       // float: how much shared light may differ
SHARED_CONST uint kCloudSkyConstant = 45u;        // bool: the sky lights clouds by itself
SHARED_CONST uint kChooseConstant = 46u;          // bool: an exposure is chosen from the histogram
SHARED_CONST uint kPackConstant = 47u;            // bool: noise that is there is packed
SHARED_CONST uint kCullStepConstant = 49u;        // uint: kCullSections to kCullHidden
SHARED_CONST uint kMarchConstant = 48u;           // bool: clouds are marched, not blended
SHARED_CONST uint kLightStepConstant = 50u;       // uint: kLightDepths to kLightRoom
SHARED_CONST uint kShowConstant = 51u;            // bool: the meter's histogram is drawn
SHARED_CONST uint kFilterConstant = 52u;  // uint: kFilterAverage, kFilterShrink or kFilterSpread
SHARED_CONST uint kToRadianceConstant = 53u;   // bool: pixels may go to an image of radiance
SHARED_CONST uint kMeterStrideConstant = 54u;  // uint: of Metering, where luminance is kept; or 0
SHARED_CONST uint kCountPixelsConstant = 55u;  // bool: counts of PixelStats are wanted
SHARED_CONST uint kRunConstant = 56u;          // uint: pixels of a row that an invocation takes
SHARED_CONST uint kGroupSizeConstant = 57u;    // uint: invocations of a work group
SHARED_CONST uint kStoreConstant = 58u;        // bool: what was found is stored
SHARED_CONST uint kEdgesConstant = 59u;        // bool: pixels at edges are mixed, not those at rest
SHARED_CONST uint kTwoPhasesConstant = 60u;    // bool: what the last frame showed is drawn first
SHARED_CONST uint kPanoramaConstant = 61u;     // bool: the sky's table is a panorama
SHARED_CONST uint kTailConstant = 62u;         // bool: what lies behind the layers is summed up
SHARED_CONST uint kShaftsConstant = 63u;       // bool: tiles know of the ways to their lights
SHARED_CONST uint kMirrorWorldConstant = 64u;  // bool: water and glass mirror voxels
SHARED_CONST uint kSunlessConstant = 65u;      // bool: neither sun nor moon lights any pixel
SHARED_CONST uint kBentConstant = 66u;         // uint: which rays level water bends
SHARED_CONST uint kUnderWaterConstant = 67u;   // bool: surfaces may lie under water
SHARED_CONST uint kGlassConstant = 68u;        // bool: light may come through glass
SHARED_CONST uint kFoamConstant = 69u;         // bool: water has foam along opaque voxels
SHARED_CONST uint kBlendedConstant = 70u;      // bool: some sections are drawn in some pixels alone
SHARED_CONST uint kColumnsConstant = 71u;      // bool: columns of texels, without shared memory
SHARED_CONST uint kListedConstant = 72u;       // bool: tiles are listed
SHARED_CONST uint kSquaresConstant = 73u;      // bool: squares of 4x4 pixels are listed
SHARED_CONST uint kSmoothSkyConstant = 74u;    // bool: tiles of a smooth sky are listed

SHARED_CONST uint kCullSections = 0u;
SHARED_CONST uint kCullScan = 1u;
SHARED_CONST uint kCullEmit = 2u;
SHARED_CONST uint kCullHidden = 3u;

SHARED_CONST uint kFilterAverage = 0u;
SHARED_CONST uint kFilterShrink = 1u;
SHARED_CONST uint kFilterSpread = 2u;

// Steps of sort_lights.comp, in their order.
SHARED_CONST uint kLightDepths = 0u;
SHARED_CONST uint kLightClusters = 1u;
SHARED_CONST uint kLightBins = 2u;
SHARED_CONST uint kLightLists = 3u;
SHARED_CONST uint kLightRoom = 4u;

// Of render::TileKind: tiles of a smooth sky, and of a work group; the first kind of tiles that
// lamps reach; kinds of squares whose light is that of a grid's points, pixels of an edge, and
// invocations of a work group for each kind. Tiles of a smooth sky and squares are each followed
// by the same kind of what keeps radiance.
SHARED_CONST uint kSmoothSkyTiles = 7u;
SHARED_CONST uint kSmoothSkyGroup = 64u;
SHARED_CONST uint kLampTiles = 9u;
SHARED_CONST uint kPlainSquares = 13u;
SHARED_CONST uint kMixedSquares = 15u;
SHARED_CONST uint kTileKinds = 13u;  // that are no squares
SHARED_CONST uint kListKinds = 17u;
SHARED_CONST uint kSquareEdge = 4u;
SHARED_CONST uint kPlainGroup = 64u;  // one a square
SHARED_CONST uint kMixedGroup = 16u;  // one a row of a square

// Rays that level water bends: those of an eye in the air, or in the water.
SHARED_CONST uint kBentIntoWater = 1u;
SHARED_CONST uint kBentIntoAir = 2u;

// Of list_glass.frag: surfaces that it finds, and texels along one of a map of glass.
SHARED_CONST uint kListedGlass = 4u;
SHARED_CONST float kListedTexels = 0.5f;

// How much steeper than linear an enlarged picture passes from one pixel to the next.
SHARED_CONST float kEnlargeSlope = 1.5f;
SHARED_END
#endif
