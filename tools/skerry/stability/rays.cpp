// Rays to lights, traced through walls: any length, any turn of the island, lights in the walls.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "engine/render/light/lights.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using world::block::kAirBlock;
using world::block::kStone;
using world::block::kWater;

constexpr VkExtent2D kRaysSize{96, 54};
constexpr world::IVec3 kLow{-1, -1, -1}, kHigh{1, 1, 1};  // chunks that are there

/// A room of 9 x 7 x 9 blocks of air within walls of one block, about the origin.
bool in_room(int x, int y, int z) {
  return std::abs(x) <= 4 && std::abs(y) <= 3 && std::abs(z) <= 4;
}
world::BlockId rays_room(int x, int y, int z) {
  const bool shell = std::abs(x) <= 5 && std::abs(y) <= 4 && std::abs(z) <= 5;
  return shell && !in_room(x, y, z) ? kStone : kAirBlock;
}
/// The same without a roof.
world::BlockId court(int x, int y, int z) {
  return y > 3 ? world::BlockId{kAirBlock} : rays_room(x, y, z);
}

/// Both, with water knee-deep on the floor.
world::BlockId pool(int x, int y, int z) {
  return in_room(x, y, z) && y < -2 ? world::BlockId{kWater} : rays_room(x, y, z);
}
world::BlockId open_pool(int x, int y, int z) {
  return in_room(x, y, z) && y < -2 ? world::BlockId{kWater} : court(x, y, z);
}

/// Where a light outside the room is put: before a wall, an edge and a corner, seen from the
/// room's middle (lattice (0.5, 0.5, 0.5)).
const std::array<glm::dvec3, 4> kWays{
    glm::dvec3{0.0, 0.0, 1.0},
    {0.0, 4.0 / std::sqrt(41.0), 5.0 / std::sqrt(41.0)},
    {5.0 / std::sqrt(66.0), 4.0 / std::sqrt(66.0), 5.0 / std::sqrt(66.0)},
    {0.3, 0.9, -0.316227766}};
constexpr glm::dvec3 kMiddle{0.5, 0.5, 0.5};

/// A view from within the room, with one light; the island turned by `turn` about its origin.
class View {
 public:
  static Result<View> create(gpu::Device& device, const BlockAt& blocks) {
    View view;
    auto stage = Stage::create(device);
    if (!stage) return stage.error();
    view.stage_ = *std::move(stage);
    if (Result<void> added = view.stage_->add(blocks, kLow, kHigh); !added) return added.error();
    if (Result<void> added = view.stage_->add_walls(blocks, kLow, kHigh); !added)
      return added.error();
    const auto unlit = view.draw({}, 0.0);
    if (!unlit) return unlit.error();
    view.unlit_ = unlit->radiance;
    return view;
  }

  /// @param place of the light in the lattice [blocks]. @return pixels that are not black, those
  /// that the light has made brighter, which tells it from the night sky and what mirrors that (if
  /// the island is not turned), and whatever is not finite.
  struct Seen {
    double lit = 0.0, brightened = 0.0, non_finite = 0.0;
  };
  Result<Seen> look(const glm::dvec3& place, float range, std::uint32_t kind, double turn) {
    const glm::dquat rotation = turned(turn);
    shared::Light asked{};
    asked.kind = kind;
    asked.position = glm::vec3(rotation * place - rotation * kMiddle);
    asked.range = range;
    asked.intensity = glm::vec3(1e6f);
    asked.axis = {0.0f, 1.0f, 0.0f};
    asked.size = 0.4f;
    asked.cos_inner = 1.0f;
    asked.cos_outer = -1.0f;
    asked.island_count = 1;
    const Result<shared::Light> light = render::checked_light(asked);
    if (!light) return light.error();
    const auto frame = draw({&*light, 1}, turn);
    if (!frame) return frame.error();
    Seen seen;
    seen.non_finite = non_finite_channels(frame->radiance) + frame->report.pixels.non_finite;
    for (std::size_t i = 0; i < frame->radiance.size(); ++i) {
      seen.lit += frame->radiance[i] != glm::vec3(0.0f);
      seen.brightened += frame->radiance[i].x > 2.0f * unlit_[i].x;
    }
    return seen;
  }

 private:
  static glm::dquat turned(double turn) {
    return glm::angleAxis(turn, glm::normalize(glm::dvec3{0.3, 1.0, -0.2}));
  }

  /// @param lights one or none.
  Result<Frame> draw(std::span<const shared::Light> lights, double turn) {
    const glm::dquat rotation = turned(turn);
    const std::vector<render::IslandPlacement> islands{{{}, rotation, 200.0}};
    const std::uint32_t island = 0;
    render::FrameInput in;
    in.camera = camera_at(rotation * kMiddle, 20.0, -10.0, 120.0);
    in.islands = islands;
    in.sky = darkness();
    in.lights = lights;
    in.light_islands = {&island, lights.size()};
    in.capture = true;
    render::RenderSettings settings;
    settings.lights_shadows = render::kEveryLight;
    settings.lights_softness = 4;
    return stage_->draw(in, settings, kRaysSize);
  }

  std::unique_ptr<Stage> stage_;
  std::vector<glm::vec3> unlit_;  // radiance without a light, the island not turned
};

/// Pixels that a light high above lights in the room without a roof: all that a sealed room holds
/// off.
Result<double> lit_from_above(gpu::Device& device, const BlockAt& without_roof) {
  Result<View> open = View::create(device, without_roof);
  if (!open) return open.error();
  const auto seen =
      open->look(kMiddle + glm::dvec3{0.0, 9.0, 0.0}, 40.0f, shared::kLightPoint, 0.0);
  if (!seen) return seen.error();
  return seen->brightened;
}

constexpr std::uint32_t kKinds[] = {shared::kLightPoint, shared::kLightSphere};

/// From a hair outside the wall to a million blocks away.
Result<Rows> lengths(gpu::Device& device) {
  Result<View> sealed = View::create(device, rays_room), open = View::create(device, court);
  if (!sealed) return sealed.error();
  if (!open) return open.error();
  double leaks = 0.0, dark = 0.0, non_finite = 0.0;
  for (const double distance : {9.0, 20.0, 1e2, 1e3, 1e4, 1e5, 1e6})
    for (const std::uint32_t kind : kKinds) {
      const auto range = static_cast<float>(std::min(1e6, distance * 1.5));
      for (const glm::dvec3& way : kWays) {
        const auto seen = sealed->look(kMiddle + way * distance, range, kind, 0.0);
        if (!seen) return seen.error();
        leaks += seen->lit;
        non_finite += seen->non_finite;
      }
      if (distance >= 1e6) continue;  // a light's range ends there
      const auto seen = open->look(kMiddle + glm::dvec3{0.0, distance, 0.0}, range, kind, 0.0);
      if (!seen) return seen.error();
      dark += seen->brightened == 0.0;
      non_finite += seen->non_finite;
    }
  return Rows{
      {"pixels lit in a sealed room, rays of 9 to 1e6 blocks", 0.0, if_shown(dark == 0.0, leaks)},
      {"views into an open court left dark, rays of 9 to 1e5 blocks", 0.0, dark},
      {"channels or pixels not finite, rays of 9 to 1e6 blocks", 0.0,
       if_shown(dark == 0.0, non_finite)}};
}

/// An island that turns by any angle from one frame to the next.
Result<Rows> turns(gpu::Device& device) {
  Result<View> sealed = View::create(device, rays_room);
  if (!sealed) return sealed.error();
  const auto lit = lit_from_above(device, court);
  if (!lit) return lit.error();
  double leaks = 0.0, non_finite = 0.0;
  for (int i = 0; i < 64; ++i) {
    const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));  // the golden angle
    const glm::dvec3 way = kWays[static_cast<std::size_t>(i) % kWays.size()];
    const auto seen = sealed->look(kMiddle + way * 9.0, 40.0f, kKinds[i / 4 % 2], turn);
    if (!seen) return seen.error();
    leaks += seen->lit;
    non_finite += seen->non_finite;
  }
  return Rows{
      {"pixels lit in a sealed room, 64 turns of its island", 0.0, if_shown(*lit > 0.0, leaks)},
      {"channels or pixels not finite, 64 turns of an island", 0.0,
       if_shown(*lit > 0.0, non_finite)}};
}

/// Lights in a wall, on a face, an edge, a corner of voxels, and where the eye is.
Result<Rows> places(gpu::Device& device) {
  Result<View> sealed = View::create(device, rays_room);
  if (!sealed) return sealed.error();
  double non_finite = 0.0, leaks = 0.0, lit = 0.0;
  for (const glm::dvec3& place : {glm::dvec3{5.5, 0.5, 0.5},
                                  {5.0, 0.5, 0.5},
                                  {5.0, 4.0, 0.5},
                                  {5.0, 4.0, 5.0},
                                  kMiddle,
                                  {5.0 - 1e-6, 0.5, 0.5},
                                  {0.5, -3.0, 0.5},
                                  {5.0 - 1e-9, 4.0 - 1e-9, 5.0 - 1e-9}})
    for (const std::uint32_t kind : kKinds) {
      const auto seen = sealed->look(place, 40.0f, kind, 0.0);
      if (!seen) return seen.error();
      non_finite += seen->non_finite;
      lit += seen->lit;
    }
  // Beyond the wall by the least that a float keeps of it.
  for (const glm::dvec3& place :
       {glm::dvec3{6.0 + 1e-5, 0.5, 0.5}, {6.0 + 1e-5, 5.0 + 1e-5, 0.5}}) {
    const auto seen = sealed->look(place, 40.0f, shared::kLightPoint, 0.0);
    if (!seen) return seen.error();
    leaks += seen->lit;
    non_finite += seen->non_finite;
  }
  // Those within the room light it.
  return Rows{{"channels or pixels not finite, lights in walls, on edges, at no distance", 0.0,
               if_shown(lit > 0.0, non_finite)},
              {"pixels lit in a sealed room, lights on the wall's other side", 0.0,
               if_shown(lit > 0.0, leaks)}};
}

/// Water mirrors and scatters light, too: walls hold it off as they do from stone.
Result<Rows> pools(gpu::Device& device) {
  Result<View> sealed = View::create(device, pool), open = View::create(device, open_pool);
  if (!sealed) return sealed.error();
  if (!open) return open.error();
  double leaks = 0.0, dark = 0.0, non_finite = 0.0;
  for (int i = 0; i < 32; ++i) {
    const auto at = static_cast<std::size_t>(i) % kWays.size();
    const auto seen =
        sealed->look(kMiddle + kWays[at] * (7.0 + i), 60.0f, kKinds[i / 4 % 2], 0.4 * i);
    if (!seen) return seen.error();
    leaks += seen->lit;
    const auto above =
        open->look(kMiddle + glm::dvec3{0.0, 5.0 + i, 0.0}, 60.0f, kKinds[i % 2], 0.0);
    if (!above) return above.error();
    dark += above->brightened == 0.0;
    non_finite += seen->non_finite + above->non_finite;
  }
  return Rows{
      {"pixels lit in a sealed room with water in it", 0.0, if_shown(dark == 0.0, leaks)},
      {"views of water in an open court left dark", 0.0, dark},
      {"channels or pixels not finite, lights over water", 0.0, if_shown(dark == 0.0, non_finite)}};
}

constexpr Case kRaysCases[] = {{"rays.lengths", lengths},
                               {"rays.turns", turns},
                               {"rays.places", places},
                               {"rays.pools", pools}};

}  // namespace

std::span<const Case> rays_cases() {
  return kRaysCases;
}

}  // namespace skerry::tools::stability
