// Clouds along one ray, with all that they are lit by. Shared by all programs that march.
#ifndef SKERRY_CLOUD_RAY_GLSL
#define SKERRY_CLOUD_RAY_GLSL
#include "include/frame/common.glsl"
#include "shared/sky.h"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#ifdef SKERRY_LIGHTS
#include "include/frame/islands.glsl"
#endif
layout(binding = kSkyTableBinding) uniform sampler2D sky_lut;
layout(binding = kCloudWeatherBinding) uniform sampler2D cloud_weather;
layout(binding = kCloudCellsBinding) uniform sampler3D cloud_cells;
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;
layout(binding = kCloudBricksBinding) uniform sampler3D cloud_bricks;
layout(binding = kCloudShapesBinding) uniform sampler2DArray cloud_shapes;
layout(binding = kCloudBillowsBinding) uniform sampler2DArray cloud_billows;

#include "include/sky/sky.glsl"
#include "include/sky/cloud_light.glsl"
#include "include/sky/cloud_layer.glsl"
#include "include/sky/cloud_volumes.glsl"
#include "include/light/visibility.glsl"
#ifdef SKERRY_LIGHTS
#include "include/light/clustered.glsl"
#include "include/light/traced.glsl"
#endif
#include "include/sky/cloud_march.glsl"

const float kSkyDistance = 1e6;  // blocks
#endif
