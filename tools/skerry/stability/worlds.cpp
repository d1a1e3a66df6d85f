// Worlds that are empty, full, too finely cut, or whirling.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"
#include "world/voxel/island.h"

namespace skerry::tools::stability {
namespace {

using render::IslandPlacement;
using world::block::kAirBlock;
using world::block::kStone;

constexpr VkExtent2D kWorldsSize{96, 54};

game::SceneOptions scene_of(const std::string& seed) {
  game::SceneOptions scene;
  scene.seed_text = seed;
  scene.size = {kWorldsSize.width, kWorldsSize.height};
  scene.quality = game::Quality::kLow;
  scene.settings = game::settings_of(scene.quality);
  scene.settings.view_distance = 96;
  return scene;
}

render::FrameInput worlds_input_of(std::span<const IslandPlacement> islands) {
  render::FrameInput in;
  in.camera = camera_at({32.5, 32.5, 32.5}, 20.0, -5.0);
  in.islands = islands;
  in.sky = sun_towards({0.3, 0.9, 0.2});
  in.capture = true;
  return in;
}

const std::vector<IslandPlacement>& worlds_island() {
  static const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  return islands;
}

bool any_light(std::span<const glm::vec3> radiance) {
  return std::ranges::any_of(radiance, [](const glm::vec3& c) { return c.x > 0.0f; });
}

Result<Rows> empty(gpu::Device& device) {
  game::SceneOptions scene = scene_of("1");
  scene.settings.world_islands = 0;
  auto drawer = SceneDrawer::create(device, scene);
  if (!drawer) return drawer.error();
  const auto drawn = (*drawer)->draw(true);
  if (!drawn) return drawn.error();
  double passes = 0.0;
  for (const std::string& pass : (*drawer)->view().renderer().graph().pass_names())
    passes += pass.starts_with("draw_") || pass.starts_with("cull_");
  return Rows{
      {"channels not finite, a world without islands", 0.0,
       if_shown(any_light(drawn->radiance->pixels), non_finite_channels(drawn->radiance->pixels))},
      {"passes that draw or cull in a world without islands", 0.0,
       if_shown(any_light(drawn->radiance->pixels), passes)}};
}

/// A world of stone, 27 chunks of it, but for the voxel that holds the eye; without even that; and
/// with a shaft from there to the sky, down which the sun must shine.
Result<Rows> solid(gpu::Device& device) {
  enum class Eye { kInShaft, kInVoxel, kInStone };
  Rows rows;
  bool shines = false;
  for (const Eye eye : {Eye::kInShaft, Eye::kInVoxel, Eye::kInStone}) {
    auto stage = Stage::create(device);
    if (!stage) return stage.error();
    const auto stone = [&](int x, int y, int z) -> world::BlockId {
      const bool outside = std::min({x, y, z}) < -60 || std::max({x, y, z}) >= 124;
      const bool voxel = eye == Eye::kInVoxel && x == 32 && y == 32 && z == 32;
      const bool shaft = eye == Eye::kInShaft && std::abs(x - 32) <= 2 && y >= 32 && z == 32;
      return outside || voxel || shaft ? kAirBlock : kStone;
    };
    if (Result<void> added = (*stage)->add(stone, {-1, -1, -1}, {2, 2, 2}); !added)
      return added.error();
    if (eye == Eye::kInShaft) {
      render::FrameInput in = worlds_input_of(worlds_island());
      in.sky = sun_towards({0.0, 1.0, 0.0});
      in.camera.pitch_deg = -90.0;
      const auto sunlight = sunlight_of(**stage, in, {}, kWorldsSize);
      if (!sunlight) return sunlight.error();
      shines = sunlight->lit > 0.0;
      continue;
    }
    double lit = 0.0, non_finite = 0.0;
    for (const double pitch : {-90.0, -20.0, 45.0, 90.0}) {
      render::FrameInput in = worlds_input_of(worlds_island());
      in.sky = sun_towards({0.0, 1.0, 0.0});
      in.camera.pitch_deg = pitch;
      const auto frame = (*stage)->draw(in, {}, kWorldsSize);
      if (!frame) return frame.error();
      non_finite += non_finite_channels(frame->radiance);
      for (const glm::vec3& p : frame->radiance) lit += p != glm::vec3(0.0f);
    }
    // An eye inside stone sees no face of it; then it must only not break.
    const bool voxel = eye == Eye::kInVoxel;
    if (voxel)
      rows.push_back(
          {"pixels that are not black in a closed voxel at noon", 0.0, if_shown(shines, lit)});
    rows.push_back({voxel ? "channels not finite in a closed voxel of a solid world"
                          : "channels not finite inside solid stone",
                    0.0, if_shown(shines, non_finite)});
  }
  return rows;
}

/// A chunk whose blocks all stand alone: six faces each, and none to merge.
MeshedChunk checkerboard() {
  return mesh_chunk_of(
      [](int x, int y, int z) -> world::BlockId {
        return ((x ^ y ^ z) & 1) != 0 ? kAirBlock : kStone;
      },
      {0, 0, 0});
}

/// Fills the quad arena with them: behind the eye, but for the first.
Result<Rows> full_arena(gpu::Device& device) {
  constexpr std::uint64_t kMostChunks = 64;  // 400 MB of quads, where a device takes more
  constexpr std::uint64_t kMostQuads = std::uint64_t{1} << 29;
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  render::GeometryStore& store = (*stage)->renderer().geometry();
  MeshedChunk chunk = checkerboard();
  const std::uint64_t quads = chunk.quads.size();
  const std::uint64_t room =
      std::min(device.limits().max_storage_range / sizeof(shared::Quad), kMostQuads) / quads;
  const std::uint64_t wanted = std::min(room, kMostChunks);
  std::vector<render::SectionId> added;
  std::string refusal;
  while (added.size() < kMostChunks && refusal.empty()) {
    const auto id = store.add((*stage)->renderer().mesh_uploader(), chunk.section, chunk.quads);
    if (id)
      added.push_back(*id);
    else
      refusal = id.error().message;
    chunk.section.origin = {0, 0, -64 * static_cast<int>(added.size())};
  }
  render::FrameInput in = worlds_input_of(worlds_island());
  in.camera = camera_at({32.5, 80.0, -10.0}, 0.0, -60.0);
  render::RenderSettings settings;
  settings.shadow_enabled = false;
  const auto frame = (*stage)->draw(in, settings, kWorldsSize);
  if (!frame) return frame.error();
  double shown = 0.0;
  for (const std::uint32_t word : frame->words) shown += shared::surface_block(word) == kStone;
  // Room that a removed chunk leaves must be found again once the GPU has finished with it.
  if (!added.empty()) store.remove((*stage)->renderer().mesh_uploader(), added.back());
  for (int i = 0; i < 3; ++i)
    if (const auto again = (*stage)->draw(in, settings, kWorldsSize); !again) return again.error();
  const auto refilled = store.add((*stage)->renderer().mesh_uploader(), chunk.section, chunk.quads);
  const bool unclear = room < kMostChunks && refusal.find("is full") == std::string::npos;
  return Rows{{"checkerboard chunks refused although they fit", 0.0,
               static_cast<double>(wanted) - static_cast<double>(added.size())},
              {"checkerboard chunks taken beyond what the device allows", 0.0,
               static_cast<double>(added.size()) - static_cast<double>(wanted)},
              {"refusals that do not say that the arena is full", 0.0, unclear ? 1.0 : 0.0},
              {"channels not finite with a full arena", 0.0,
               if_shown(shown > 0.0, non_finite_channels(frame->radiance))},
              {"pictures of a full arena that show none of it", 0.0, shown > 0.0 ? 0.0 : 1.0},
              {"chunks refused after one was removed", 0.0, refilled ? 0.0 : 1.0}};
}

/// Islands of one block each, in a grid.
Result<Rows> many_islands(gpu::Device& device) {
  constexpr std::uint32_t kEdge = 32, kCount = kEdge * kEdge;
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  MeshedChunk block = mesh_chunk_of(
      [](int x, int y, int z) -> world::BlockId {
        return x == 0 && y == 0 && z == 0 ? kStone : kAirBlock;
      },
      {0, 0, 0});
  std::vector<IslandPlacement> islands;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const int row = i / kEdge;
    const glm::dvec3 at{3.0 * (i % kEdge), 3.0 * row, 120.0 + i % 7};
    islands.push_back({fixed_at(at), glm::angleAxis(0.1 * i, glm::dvec3(0.0, 1.0, 0.0)), 2.0});
    block.section.island = i;
    const auto added = (*stage)->renderer().geometry().add((*stage)->renderer().mesh_uploader(),
                                                           block.section, block.quads);
    if (!added) return added.error();
  }
  render::FrameInput in = worlds_input_of(islands);
  in.camera = camera_at({48.0, 48.0, 20.0}, 0.0, 0.0);
  render::RenderSettings settings;
  settings.shadow_size = 512;
  const auto frame = (*stage)->draw(in, settings, {480, 320});
  if (!frame) return frame.error();
  std::set<std::uint32_t> seen;
  for (const std::uint32_t word : frame->words)
    if (word != 0) seen.insert(shared::surface_island(word));
  return Rows{{"islands of 1024 that do not show", 0.0,
               static_cast<double>(kCount) - static_cast<double>(seen.size())},
              {"channels not finite with 1024 islands", 0.0,
               if_shown(lit_surfaces(*frame) > 0.0, non_finite_channels(frame->radiance))}};
}

/// An island that turns by more than a turn a frame: each frame stands for itself.
Result<Rows> whirling_island(gpu::Device& device) {
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  const auto block_at = [](int x, int y, int z) -> world::BlockId {
    return y < 20 || (y < 30 && (x ^ z) % 5 == 0) ? kStone : kAirBlock;
  };
  if (Result<void> added = (*stage)->add(block_at, {0, 0, 0}, {1, 1, 1}); !added)
    return added.error();
  world::IslandSpec spec;
  spec.spin_rad_per_s = 1000.0;
  spec.bounding_radius = 120.0;
  double non_finite = 0.0, different = 0.0, kept = 0.0, lit = 0.0;
  std::vector<std::vector<std::uint8_t>> pictures;
  for (const bool again : {false, true}) {
    for (int i = 0; i < 8; ++i) {
      const double time_s = 1e6 + i / 60.0;
      const world::Pose pose = world::pose_at(spec, time_s);
      const std::vector<IslandPlacement> islands{
          {{pose.origin.x, pose.origin.y, pose.origin.z}, pose.rotation, spec.bounding_radius}};
      render::FrameInput in = worlds_input_of(islands);
      in.camera = camera_at({0.5, 60.0, -90.0}, 0.0, -30.0);
      in.time_s = time_s;
      const auto frame = (*stage)->draw(in, {}, kWorldsSize);
      if (!frame) return frame.error();
      non_finite += non_finite_channels(frame->radiance);
      lit += lit_surfaces(*frame);
      if (again)
        different += different_pixels(frame->rgba, pictures[static_cast<std::size_t>(i)]);
      else
        pictures.push_back(frame->rgba);
      // A shadow map kept from another turn of the island would show a wrong shadow.
      const std::vector<std::string> passes = (*stage)->renderer().graph().pass_names();
      kept += std::none_of(passes.begin(), passes.end(),
                           [](const std::string& p) { return p == "draw_shadow_sun_0"; });
    }
  }
  const bool whirls = lit > 0.0 && pictures[0] != pictures[1];
  return Rows{
      {"channels not finite, an island at 1000 rad/s", 0.0, if_shown(whirls, non_finite)},
      {"pixels that differ when its 8 frames are drawn again", 0.0, if_shown(whirls, different)},
      {"frames with a shadow map kept from another turn of it", 0.0, kept}};
}

Result<Rows> seeds(gpu::Device& device) {
  double non_finite = 0.0, without_ground = 0.0, black = 0.0;
  for (const std::string& seed : {std::string("0"), std::string("18446744073709551615"),
                                  std::string("18446744073709551616"), std::string(4096, 'x')}) {
    auto drawer = SceneDrawer::create(device, scene_of(seed));
    if (!drawer) return drawer.error();
    const auto drawn = (*drawer)->draw(true);
    if (!drawn) return drawn.error();
    non_finite += non_finite_channels(drawn->radiance->pixels) + drawn->report.pixels.non_finite;
    without_ground += drawn->report.camera.quads == 0;
    black += !any_light(drawn->radiance->pixels);
  }
  return Rows{{"channels not finite, seeds 0, 2^64-1, 2^64 and 4096 letters", 0.0,
               if_shown(black == 0.0, non_finite)},
              {"of those seeds that show no block at their spawn", 0.0, without_ground}};
}

Result<Rows> world_times(gpu::Device& device) {
  double non_finite = 0.0, empty_worlds = 0.0, black = 0.0;
  for (const double time_s : {1e9, -1e9}) {
    game::SceneOptions scene = scene_of("1");
    scene.settings.world_time_s = time_s;
    auto drawer = SceneDrawer::create(device, scene);
    if (!drawer) return drawer.error();
    const auto drawn = (*drawer)->draw(true);
    if (!drawn) return drawn.error();
    non_finite += non_finite_channels(drawn->radiance->pixels) + drawn->report.pixels.non_finite;
    black += !any_light(drawn->radiance->pixels);
    empty_worlds += (*drawer)->view().renderer().geometry().quads_resident() == 0;
  }
  return Rows{{"channels not finite, world.time +-1e9", 0.0, if_shown(black == 0.0, non_finite)},
              {"of those worlds without a block in reach of the spawn", 0.0, empty_worlds}};
}

constexpr Case kWorldsCases[] = {{"worlds.empty", empty},
                                 {"worlds.solid", solid},
                                 {"worlds.full_arena", full_arena},
                                 {"worlds.many_islands", many_islands},
                                 {"worlds.whirling_island", whirling_island},
                                 {"worlds.seeds", seeds},
                                 {"worlds.world_times", world_times}};

}  // namespace

std::span<const Case> worlds_cases() {
  return kWorldsCases;
}

}  // namespace skerry::tools::stability
