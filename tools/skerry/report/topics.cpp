#include "tools/skerry/report/topics.h"

#include <algorithm>

namespace skerry::tools {
namespace {

constexpr ReportScene kScenes[] = {
    {"day", "a meadow in the morning", R"({"seed": 1, "time": "10:30"})"},
    {"low_sun", "long shadows before sunset",
     R"({"seed": 6, "time": "17:35", "camera": [-60, 145, 279, 90, -8]})"},
    {"water", "a lake in the sun",
     R"({"seed": 5, "time": "11:00", "camera": [52.25, 17.5, 52.75, 225, -25]})"},
    {"tank", "a basin of glass with water in it",
     R"({"seed": 1, "time": "12:30", "camera": [0.3, 120, 12, 180, -8],
         "blocks": [{"block": "stone", "from": [-8, 112, -12], "to": [8, 113, 6]},
                    {"block": "bricks", "from": [-8, 114, -12], "to": [8, 119, -12]},
                    {"block": "glass", "from": [-6, 114, -8], "to": [6, 119, 0]},
                    {"block": "water", "from": [-5, 114, -7], "to": [5, 118, -1]},
                    {"block": "air", "from": [-5, 119, -7], "to": [5, 119, -1]}]})"},
    {"panes", "eight panes of glass one behind another, sixteen surfaces",
     R"({"seed": 1, "time": "12:30", "camera": [0.3, 118, 6, 180, -6],
         "blocks": [{"block": "stone", "from": [-8, 112, -30], "to": [8, 113, 6]},
                    {"block": "bricks", "from": [-8, 114, -30], "to": [8, 121, -30]},
                    {"block": "glass", "from": [-6, 114, 0], "to": [6, 120, 0]},
                    {"block": "glass", "from": [-6, 114, -3], "to": [6, 120, -3]},
                    {"block": "glass", "from": [-6, 114, -6], "to": [6, 120, -6]},
                    {"block": "glass", "from": [-6, 114, -9], "to": [6, 120, -9]},
                    {"block": "glass", "from": [-6, 114, -12], "to": [6, 120, -12]},
                    {"block": "glass", "from": [-6, 114, -15], "to": [6, 120, -15]},
                    {"block": "glass", "from": [-6, 114, -18], "to": [6, 120, -18]},
                    {"block": "glass", "from": [-6, 114, -21], "to": [6, 120, -21]}]})"},
    {"shaded_water", "a lake after sunset, under a bright sky",
     R"({"seed": 5, "time": "18:05", "camera": [52.25, 17.5, 52.75, 225, -12]})"},
    {"lava", "lava on a mountain after sunset",
     R"({"seed": 8, "time": "18:10", "camera": [250.7, 145.85, -146.0, 270, -21.8]})"},
    {"far", "islands to the horizon",
     R"({"seed": 5, "time": "13:00", "camera": [-60, 260, -500, 20, -18]})"},
    {"giant", "an island of 400,000 quads, most of them behind others",
     R"({"seed": 1, "time": "12:00", "camera": [-1817, 29, 696, 292.5, -12],
         "settings": {"world.time": 39}})"},
    {"cave_mouth", "from a cave into the day",
     R"({"seed": 4, "time": "12:00", "camera": [181.29, 30.64, 14.98, 205, 3]})"},
    {"pit", "a shaft in stone, its bottom in the shade",
     R"({"seed": 1, "time": "12:30", "camera": [0.5, 118.5, 5.5, 180, -55],
         "blocks": [{"block": "stone", "from": [-12, 100, -12], "to": [12, 115, 12]},
                    {"block": "sand", "from": [-5, 101, -5], "to": [5, 101, 5]},
                    {"block": "air", "from": [-4, 102, -4], "to": [4, 115, 4]}]})"},
    {"clouds", "a layer of clouds over islands",
     R"({"seed": 1, "time": "09:30", "camera": [0, 120, -60, 20, 14],
         "settings": {"clouds.coverage": 0.6, "clouds.resolution": "full"}})"},
    {"puff", "a small cloud of a file before the sky",
     R"({"seed": 1, "time": "15:00", "camera": [0, 300, -70, 0, 0], "settings": {"world.islands": 0, "clouds.resolution": "full"},
         "clouds": [{"file": "tests/scenes/puff.vdb", "position": [0, 300, 0]}]})"},
    {"high_sun", "a clear sky, sun 50 degrees high",
     R"({"seed": 1, "time": "10:09", "settings": {"world.islands": 0}})"},
    {"evening", "a clear sky, sun 3 degrees high",
     R"({"seed": 1, "time": "17:46", "settings": {"world.islands": 0}})"},
    {"blue_hour", "a clear sky, sun 5 degrees below the horizon",
     R"({"seed": 1, "time": "18:23", "settings": {"world.islands": 0}})"},
    {"torches", "a meadow at night under 1,024 torches",
     R"({"seed": 3, "time": "00:00", "settings": {"sky.moon_phase": 0, "lights.random": 1024}})"},
    {"lamps", "a meadow at night under a tube and a sphere that have a size",
     R"({"seed": 4, "time": "00:00", "camera": [34.53, 8.8, -32.65, 123.8, -12],
         "settings": {"sky.moon_phase": 0, "lights.shadows": "all"},
         "lights": [{"kind": "tube", "position": [39.8, 8.9, -35.6], "color": [0.3, 0.7, 1],
                     "power": 60, "range": 24, "axis": [0.556, 0, 0.831], "size": 1.5},
                    {"kind": "sphere", "position": [42.1, 9.4, -33], "color": [1, 0.5, 0.2],
                     "power": 90, "range": 24, "size": 0.6}]})"},
};

constexpr TopicPoint kShadowSizes[] = {{"256", "shadow.size=256"},
                                       {"512", "shadow.size=512"},
                                       {"1024", "shadow.size=1024"},
                                       {"2048", "shadow.size=2048"},
                                       {"4096", "shadow.size=4096"}};
constexpr TopicPoint kShadowTaps[] = {{"1", "shadow.taps=1"},
                                      {"4", "shadow.taps=4"},
                                      {"8", "shadow.taps=8"},
                                      {"16", "shadow.taps=16"},
                                      {"32", "shadow.taps=32"}};
constexpr TopicPoint kShadowSplits[] = {
    {"0", "shadow.split=0"},     {"0.5", "shadow.split=0.5"},   {"0.75", "shadow.split=0.75"},
    {"0.9", "shadow.split=0.9"}, {"0.95", "shadow.split=0.95"}, {"0.98", "shadow.split=0.98"},
    {"1", "shadow.split=1"}};
constexpr TopicPoint kShadowBlurs[] = {{"0", "shadow.blur=0"},
                                       {"0.05", "shadow.blur=0.05"},
                                       {"0.1", "shadow.blur=0.1"},
                                       {"0.15", "shadow.blur=0.15"},
                                       {"0.3", "shadow.blur=0.3"}};
// The sun's own disc, exactly; and as many samples of a pixel.
constexpr TopicPoint kShadowSamples[] = {
    {"filter", "shadow.samples=1"}, {"4", "shadow.samples=4"}, {"16", "shadow.samples=16"}};
constexpr TopicPoint kSamples[] = {
    {"1", "aa.samples=1"}, {"4", "aa.samples=4"}, {"16", "aa.samples=16"}};
constexpr TopicPoint kAntialiasing[] = {{"off", "aa=off"},
                                        {"edge", "aa=edge"},
                                        {"temporal", "aa=temporal"},
                                        {"4 samples", "aa.samples=4"},
                                        {"16 samples", "aa.samples=16"}};
constexpr TopicPoint kShadowCascades[] = {{"1", "shadow.cascades=1"},
                                          {"2", "shadow.cascades=2"},
                                          {"3", "shadow.cascades=3"},
                                          {"4", "shadow.cascades=4"}};
constexpr TopicPoint kNormals[] = {
    {"oct8", "gbuffer.normal=oct8"},       {"rgb8", "gbuffer.normal=rgb8"},
    {"rgb10a2", "gbuffer.normal=rgb10a2"}, {"oct16", "gbuffer.normal=oct16"},
    {"rgba16f", "gbuffer.normal=rgba16f"}, {"exact", "gbuffer.normal=exact"}};
constexpr TopicPoint kPositions[] = {{"depth, d16", "gbuffer.position=depth gbuffer.depth=d16"},
                                     {"rgba16f", "gbuffer.position=rgba16f"},
                                     {"depth, d32", "gbuffer.position=depth"},
                                     {"rgba32f", "gbuffer.position=rgba32f"}};
constexpr TopicPoint kDistances[] = {{"200", "view.distance=200"},
                                     {"400", "view.distance=400"},
                                     {"1000", "view.distance=1000"},
                                     {"2000", "view.distance=2000"},
                                     {"4000", "view.distance=4000"}};
constexpr TopicPoint kDetails[] = {{"64", "view.detail=64"},   {"128", "view.detail=128"},
                                   {"192", "view.detail=192"}, {"320", "view.detail=320"},
                                   {"512", "view.detail=512"}, {"1024", "view.detail=1024"}};
// 0 draws all of an island at the level of its near end. In pictures as small as a report's,
// view.detail keeps levels farther away than errors of 0.17 pixels and more ask.
constexpr TopicPoint kErrors[] = {{"4", "view.error=4"},       {"1", "view.error=1"},
                                  {"0.25", "view.error=0.25"}, {"0.1", "view.error=0.1"},
                                  {"0.05", "view.error=0.05"}, {"0", "view.error=0"}};
constexpr TopicPoint kOcclusions[] = {{"off", "view.occlusion=off"},
                                      {"auto", "view.occlusion=auto"},
                                      {"always", "view.occlusion=always"}};
constexpr TopicPoint kTextureTaps[] = {{"1", "texture.taps=1"},
                                       {"2", "texture.taps=2"},
                                       {"4", "texture.taps=4"},
                                       {"8", "texture.taps=8"},
                                       {"16", "texture.taps=16"}};
constexpr TopicPoint kShadingRates[] = {{"4, 1", "shading.rate=4 shading.tolerance=1"},
                                        {"4, 0.3", "shading.rate=4 shading.tolerance=0.3"},
                                        {"4, 0.1", "shading.rate=4 shading.tolerance=0.1"},
                                        {"3, 0.3", "shading.rate=3 shading.tolerance=0.3"},
                                        {"2, 1", "shading.rate=2 shading.tolerance=1"},
                                        {"2, 0.3", "shading.rate=2 shading.tolerance=0.3"},
                                        {"1", "shading.rate=1"}};
constexpr TopicPoint kScales[] = {{"0.25", "render.scale=0.25"}, {"0.33", "render.scale=0.33"},
                                  {"0.5", "render.scale=0.5"},   {"0.67", "render.scale=0.67"},
                                  {"0.75", "render.scale=0.75"}, {"1", "render.scale=1"}};
constexpr TopicPoint kIndirect[] = {
    {"off", "indirect=off"}, {"sky", "indirect=sky"}, {"full", "indirect=full"}};
constexpr TopicPoint kAoStrengths[] = {
    {"off", "ao.strength=0"}, {"0.25", "ao.strength=0.25"}, {"0.5", "ao.strength=0.5"}};
constexpr TopicPoint kSkyDegrees[] = {{"0", "", 0}, {"1", "", 1}, {"2", "", 2},
                                      {"3", "", 3}, {"4", "", 4}, {"6", "", 6}};
constexpr TopicPoint kReflections[] = {{"0", "", {}, LightDetail{.bounces = 0}},
                                       {"1", "", {}, LightDetail{.bounces = 1}},
                                       {"2", "", {}, LightDetail{.bounces = 2}},
                                       {"3", "", {}, LightDetail{}}};
constexpr TopicPoint kLightShapes[] = {
    {"means", "", {}, LightDetail{.lobes = false, .degree = 0, .keyed = false}},
    {"lobes, mean", "", {}, LightDetail{.degree = 0, .keyed = false}},
    {"lobes, degree 1", "", {}, LightDetail{.degree = 1, .keyed = false}},
    {"lobes, degree 2", "", {}, LightDetail{.keyed = false}},
    {"lobes, degree 2, sun", "", {}, LightDetail{}}};
constexpr TopicPoint kWaterLayers[] = {{"1", "water.layers=1"},
                                       {"2", "water.layers=2"},
                                       {"3", "water.layers=3"},
                                       {"4", "water.layers=4"}};
constexpr TopicPoint kWaterMirrors[] = {{"sky", "water.mirror=sky"},
                                        {"world", "water.mirror=world"}};
constexpr TopicPoint kLightLists[] = {{"clusters", "lights.oracle=0"},
                                      {"all lights", "lights.oracle=1"}};
constexpr TopicPoint kLightTiles[] = {{"8", "lights.tile=8"},
                                      {"16", "lights.tile=16"},
                                      {"32", "lights.tile=32"},
                                      {"64", "lights.tile=64"}};
constexpr TopicPoint kLightShadows[] = {{"off", "lights.shadows=off"},
                                        {"nearest:1", "lights.shadows=nearest:1"},
                                        {"nearest:2", "lights.shadows=nearest:2"},
                                        {"nearest:4", "lights.shadows=nearest:4"},
                                        {"nearest:8", "lights.shadows=nearest:8"},
                                        {"all", "lights.shadows=all"}};
constexpr TopicPoint kLightSoftness[] = {{"1", "lights.softness=1"},
                                         {"2", "lights.softness=2"},
                                         {"4", "lights.softness=4"},
                                         {"8", "lights.softness=8"},
                                         {"16", "lights.softness=16"}};
constexpr TopicPoint kMeterStrides[] = {{"16", "exposure.stride=16"},
                                        {"8", "exposure.stride=8"},
                                        {"4", "exposure.stride=4"},
                                        {"2", "exposure.stride=2"},
                                        {"1", "exposure.stride=1"}};
constexpr TopicPoint kBloomLevels[] = {{"0", "bloom.intensity=0"},
                                       {"1", "bloom.intensity=0.1 bloom.levels=1"},
                                       {"2", "bloom.intensity=0.1 bloom.levels=2"},
                                       {"4", "bloom.intensity=0.1 bloom.levels=4"},
                                       {"6", "bloom.intensity=0.1 bloom.levels=6"},
                                       {"8", "bloom.intensity=0.1 bloom.levels=8"}};
constexpr TopicPoint kUploadPathPoints[] = {{"update", "upload.path=update"},
                                            {"staging", "upload.path=staging"},
                                            {"mapped", "upload.path=mapped"}};

constexpr TopicPoint kCloudSteps[] = {
    {"8", "clouds.steps=8"},
    {"16", "clouds.steps=16"},
    {"24", "clouds.steps=24"},
    {"48", "clouds.steps=48"},
    {"96", "clouds.steps=96"},
    {"1024, full resolution", "clouds.steps=1024 clouds.resolution=full"}};
constexpr TopicPoint kCloudShadowSteps[] = {{"4", "clouds.shadow_steps=4"},
                                            {"8", "clouds.shadow_steps=8"},
                                            {"16", "clouds.shadow_steps=16"},
                                            {"32", "clouds.shadow_steps=32"},
                                            {"128", "clouds.shadow_steps=128"}};
constexpr TopicPoint kCloudResolutions[] = {{"half", "clouds.resolution=half"},
                                            {"full", "clouds.resolution=full"}};
constexpr TopicPoint kCloudPrecisions[] = {
    {"8", "clouds.precision=8"}, {"16", "clouds.precision=16"}, {"32", "clouds.precision=32"}};

constexpr std::string_view kShadowScenes[] = {"day", "low_sun", "water"};
constexpr std::string_view kLitScenes[] = {"day", "low_sun", "water", "torches"};
constexpr std::string_view kSkyScenes[] = {"day", "low_sun", "cave_mouth"};
constexpr std::string_view kClearSkies[] = {"high_sun", "evening", "blue_hour"};
constexpr std::string_view kShades[] = {"day", "cave_mouth", "pit"};
constexpr std::string_view kEdgeScenes[] = {"day", "low_sun", "far"};
constexpr std::string_view kDay[] = {"day"};
constexpr std::string_view kFar[] = {"far"};
constexpr std::string_view kLargeScenes[] = {"giant", "far"};
constexpr std::string_view kHiding[] = {"giant", "day"};
constexpr std::string_view kGlow[] = {"lava"};
constexpr std::string_view kWater[] = {"water"};
constexpr std::string_view kMirroring[] = {"water", "shaded_water", "tank"};
constexpr std::string_view kLayered[] = {"water", "tank", "panes"};
constexpr std::string_view kTorches[] = {"torches"};
constexpr std::string_view kClouds[] = {"clouds", "puff"};
constexpr std::string_view kPuff[] = {"puff"};
constexpr std::string_view kGallery[] = {"lamps"};

constexpr Topic kTopics[] = {
    {"shadow_size", "texels along the edge of a shadow map", kShadowSizes, kShadowScenes},
    {"shadow_taps", "texels of the shadow map that a pixel compares with", kShadowTaps,
     kShadowScenes, Judge::kReference, CostOf::kShading},
    {"shadow_cascades", "shadow maps a light has", kShadowCascades, kShadowScenes},
    {"shadow_split", "how the maps of a light share the view distance", kShadowSplits,
     kShadowScenes},
    {"shadow_blur", "largest radius of the shadow filter", kShadowBlurs, kShadowScenes,
     Judge::kReference, CostOf::kShading},
    {"shadow_samples", "places on the sun's disc that light comes from", kShadowSamples, kWater},
    {"aa_samples", "samples of a pixel", kSamples, kDay, Judge::kReference, CostOf::kFrame, false,
     "reference.filter=pixel"},
    {"aa", "smooth edges from one sample of a pixel", kAntialiasing, kEdgeScenes, Judge::kLimit,
     CostOf::kShading},
    {"gbuffer_normal", "how normals are kept between drawing and shading", kNormals, kDay,
     Judge::kLimit, CostOf::kShading},
    {"gbuffer_position", "where shading takes positions from", kPositions, kDay, Judge::kLimit,
     CostOf::kShading},
    {"view_distance", "blocks up to which anything is drawn", kDistances, kFar, Judge::kReference,
     CostOf::kFrame, true, "view.distance=4000"},
    {"view_detail", "blocks up to which everything is drawn in full detail", kDetails, kFar,
     Judge::kReference, CostOf::kFrame, true},
    {"view_error", "pixels that far ends of islands may be off by; 0: none are coarser", kErrors,
     kLargeScenes, Judge::kLimit, CostOf::kFrame, true},
    {"view_occlusion", "whether what the last frame's surfaces hide is left out", kOcclusions,
     kHiding, Judge::kEqual, CostOf::kShading},
    {"shading_rate", "pixels that share light where it is alike, and how much it may differ",
     kShadingRates, kLitScenes, Judge::kLimit, CostOf::kShading},
    {"render_scale",
     "edges of the picture that is drawn, as a share of those of the one that is shown", kScales,
     kLitScenes, Judge::kLimit, CostOf::kFrame},
    {"indirect", "light of the sky, and what surfaces reflect to each other", kIndirect, kSkyScenes,
     Judge::kReference, CostOf::kFrame, false, "indirect=full"},
    {"sky_tables", "degree of the harmonics that light scattered by the air is kept in",
     kSkyDegrees, kClearSkies, Judge::kReference, CostOf::kSkyTables},
    {"light_reflections", "times that light is followed from face to face", kReflections, kShades,
     Judge::kReference, CostOf::kStoredLight},
    {"light_directions", "by which directions faces keep the light of sky and reflections",
     kLightShapes, kShades, Judge::kReference, CostOf::kStoredLight},
    {"ao_strength", "how much light a closed corner of blocks takes", kAoStrengths, kShadowScenes,
     Judge::kReference, CostOf::kShading},
    {"texture_taps", "samples along the long side of a slanted texture", kTextureTaps, kDay,
     Judge::kReference, CostOf::kShading},
    {"water_layers", "water and glass surfaces, one behind another, that a pixel shows",
     kWaterLayers, kLayered, Judge::kReference, CostOf::kShading},
    {"water_mirror", "what water and glass mirror besides lights", kWaterMirrors, kMirroring,
     Judge::kReference, CostOf::kShading},
    {"exposure",
     "pixels of which the meter looks at one",
     kMeterStrides,
     kShadowScenes,
     Judge::kLimit,
     CostOf::kShading,
     false,
     {},
     true},
    {"bloom_levels", "levels of the pyramid that spreads bright light", kBloomLevels, kGlow,
     Judge::kReference, CostOf::kShading, false, "bloom.intensity=0.1 bloom.levels=8"},
    {"clouds_steps", "steps of a ray through clouds", kCloudSteps, kClouds,
     Judge::kLimitAndReference, CostOf::kShading},
    {"clouds_shadow_steps", "places along the light's way through clouds", kCloudShadowSteps,
     kClouds, Judge::kLimitAndReference, CostOf::kShading},
    {"clouds_resolution", "whether every pixel has a ray of its own through clouds",
     kCloudResolutions, kClouds, Judge::kLimitAndReference, CostOf::kShading},
    {"clouds_precision", "bits of a density of a file's cloud", kCloudPrecisions, kPuff,
     Judge::kLimitAndReference, CostOf::kShading, true},
    {"lights_oracle", "lights that a pixel asks: those of its cluster, or all", kLightLists,
     kTorches, Judge::kEqual, CostOf::kShading},
    {"lights_tile", "pixels along the tiles that lights are sorted into", kLightTiles, kTorches,
     Judge::kEqual},
    {"lights_shadows", "lights of a pixel that walls are looked for before", kLightShadows,
     kTorches, Judge::kReference, CostOf::kShading},
    {"lights_softness", "ways looked along to a light that has a size", kLightSoftness, kGallery,
     Judge::kReference, CostOf::kShading},
    {"upload_path", "how meshes travel to the GPU", kUploadPathPoints, kDay, Judge::kEqual,
     CostOf::kUpload, true},
};

}  // namespace

std::span<const ReportScene> report_scenes() {
  return kScenes;
}

std::span<const Topic> topics() {
  return kTopics;
}

const ReportScene* find_report_scene(std::string_view name) {
  const auto* found = std::ranges::find(kScenes, name, &ReportScene::name);
  return found == std::end(kScenes) ? nullptr : found;
}

const Topic* find_topic(std::string_view name) {
  const auto* found = std::ranges::find(kTopics, name, &Topic::name);
  return found == std::end(kTopics) ? nullptr : found;
}

}  // namespace skerry::tools
