// Looking through glass that takes a millionth of the light, and through glass that takes all of
// it.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "game/view/materials.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using world::block::kAirBlock;
using world::block::kGlass;
using world::block::kLamp;

constexpr VkExtent2D kMediaSize{96, 54};
constexpr double kEye = 0.5, kLamps = 40.0;  // z of the eye and of the wall of lamps

/// What the media scatter of what they absorb.
constexpr double kScatteringPerAbsorption = 0.3;
constexpr double kExtinctionPerAbsorption = 1.0 + kScatteringPerAbsorption;

void set_medium(shared::Material& material, double absorption) {
  material.absorption = glm::vec3(static_cast<float>(absorption));
  material.scattering = static_cast<float>(kScatteringPerAbsorption * absorption);
}

/// Radiance below which a half's steps would be coarse: what is compared is above.
constexpr double kFaintest = 1.0 / 1024.0;

struct Glass {
  double front, back;  // z; the eye is inside when front is behind it
  int slabs = 1;       // each but one block thick when there are several, with as much air behind

  bool holds(int z) const {
    return z >= front && z < back && (slabs == 1 || (z - static_cast<int>(front)) % 2 == 0);
  }
  /// Blocks of glass along the view axis.
  double depth() const { return slabs == 1 ? back - std::max(front, kEye) : double(slabs); }
};

Result<Frame> look(gpu::Device& device, const Glass& glass, double absorption) {
  std::vector<shared::Material> table = game::material_table();
  set_medium(table[kGlass], absorption);
  table[kLamp].emission = glm::packHalf1x16(1.0f);
  auto stage = Stage::create(device, table);
  if (!stage) return stage.error();
  const auto scene = [&](int, int, int z) -> world::BlockId {
    if (z >= kLamps) return kLamp;
    return glass.holds(z) ? kGlass : kAirBlock;
  };
  if (Result<void> added = (*stage)->add(scene, {-1, -1, -1}, {2, 2, 1}); !added)
    return added.error();
  render::FrameInput in;
  in.camera = camera_at({32.5, 32.5, kEye}, 0.0, 0.0);
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  in.islands = islands;
  in.sky = darkness();  // nothing lights the glass itself: what is left is what came through
  in.camera_medium = glass.front < kEye ? kGlass : 0;
  in.capture = true;
  render::RenderSettings settings;
  if (glass.slabs > 1) settings.water_layers = 1;  // all but the first surface are added up
  return (*stage)->draw(in, settings, kMediaSize);
}

/// The share of light that came through against exp(-tau), tau along each pixel's own ray.
Result<Rows> through(gpu::Device& device, const Glass& glass, const std::string& what) {
  // Glass that takes nothing shows what stands behind it, with the surfaces' own part.
  const auto clear = look(device, glass, 0.0);
  if (!clear) return clear.error();
  const double depth = glass.depth();
  const render::Camera camera = camera_at({}, 0.0, 0.0);
  double off = 0.0, beyond = 0.0, compared = 0.0, darkest = 1.0;
  for (int decade = -6; decade <= 4; ++decade) {
    const double tau_ahead = std::pow(10.0, decade);
    const double absorption = tau_ahead / depth / kExtinctionPerAbsorption;
    const auto frame = look(device, glass, absorption);
    if (!frame) return frame.error();
    for (std::uint32_t i = 0; i < clear->radiance.size(); ++i) {
      const glm::dvec3 ray = ray_of(camera, kMediaSize, i % kMediaSize.width, i / kMediaSize.width);
      const double exact = std::exp(-tau_ahead * glm::length(ray));
      for (int c = 0; c < 3; ++c) {
        const double all = static_cast<double>(clear->radiance[i][c]);
        if (all < kFaintest) continue;
        const double share = static_cast<double>(frame->radiance[i][c]) / all;
        off = std::max(off, std::abs(share - exact));
        beyond += !(share >= 0.0 && share <= 1.0);
        darkest = std::min(darkest, share);
        ++compared;
      }
    }
  }
  // The frame of a pane lets nothing through; most of a picture must not be frames.
  if (compared < 0.5 * 11.0 * 3.0 * static_cast<double>(clear->radiance.size()))
    return Error{"too few pixels show what stands behind the glass"};
  return Rows{{"error of transmittance, optical depth 1e-6 to 1e4, " + what, 1e-3, off},
              {"transmittances below 0 or above 1, " + what, 0.0, if_shown(darkest < 0.5, beyond)}};
}

Result<Rows> inside(gpu::Device& device) {
  return through(device, {-64.0, kLamps}, "eye inside the medium");
}

Result<Rows> slab(gpu::Device& device) {
  return through(device, {8.0, 24.0}, "slab of 16 blocks");
}

Result<Rows> slabs(gpu::Device& device) {
  return through(device, {4.0, 20.0, 8}, "8 slabs behind one peeled surface");
}

/// A thousand panes in the sun: what they add up to stays finite, and no brighter than paper.
Result<Rows> many_panes(gpu::Device& device) {
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  const auto scene = [](int, int y, int z) -> world::BlockId {
    if (y < 0) return kLamp;
    return z >= 4 && z % 2 == 0 ? kGlass : kAirBlock;
  };
  if (Result<void> added = (*stage)->add(scene, {-1, -1, 0}, {1, 1, 32}); !added)
    return added.error();
  render::FrameInput in;
  in.camera = camera_at({0.5, 32.5, 1.5}, 0.0, 0.0);
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 3000.0}};
  in.islands = islands;
  in.sky = sun_towards(glm::normalize(glm::dvec3(0.3, 0.8, -0.5)));
  in.capture = true;
  double non_finite = 0.0, brightest = 0.0;
  for (const int layers : {1, 2, 4}) {
    render::RenderSettings settings;
    settings.water_layers = layers;
    const auto frame = (*stage)->draw(in, settings, kMediaSize);
    if (!frame) return frame.error();
    non_finite += static_cast<double>(non_finite_channels(frame->radiance));
    for (const glm::vec3& texel : frame->radiance) brightest = std::max(brightest, double{texel.y});
  }
  return Rows{{"channels not finite through 1,022 panes", 0.0, non_finite},
              {"brightest green of 1,022 panes in the sun", 1.0, brightest}};
}

/// What the medium about the eye sends to it of a light from straight above, before a wall that
/// this light does not reach: nothing else is there to be seen.
Result<Frame> glow(gpu::Device& device, double absorption, float irradiance) {
  std::vector<shared::Material> table = game::material_table();
  set_medium(table[kGlass], absorption);
  table[kLamp].emission = 0;
  auto stage = Stage::create(device, table);
  if (!stage) return stage.error();
  const auto scene = [](int, int, int z) { return z >= kLamps ? kLamp : kGlass; };
  if (Result<void> added = (*stage)->add(scene, {-1, -1, -1}, {2, 2, 1}); !added)
    return added.error();
  render::FrameInput in;
  in.camera = camera_at({32.5, 32.5, kEye}, 0.0, 0.0);
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  in.islands = islands;
  in.sky = moon_above(irradiance);
  in.camera_medium = kGlass;
  in.capture = true;
  render::RenderSettings settings;
  settings.shadow_enabled = false;
  settings.leave_out.add(render::Feature::kHaze);
  return (*stage)->draw(in, settings, kMediaSize);
}

/// Scattering once, in closed form: share / (4 pi) of what the medium takes from the way. Where it
/// takes a millionth, only an error relative to that millionth tells anything.
Result<Rows> faint_media(gpu::Device& device) {
  constexpr float kIrradiance = 1e4f;  // so that a half holds a millionth of it to all its digits
  const double depth = kLamps - kEye;
  const render::Camera camera = camera_at({}, 0.0, 0.0);
  double off = 0.0;
  for (int decade = -6; decade <= 1; ++decade) {
    const double tau_ahead = std::pow(10.0, decade);
    const auto frame = glow(device, tau_ahead / depth / kExtinctionPerAbsorption, kIrradiance);
    if (!frame) return frame.error();
    for (std::uint32_t i = 0; i < frame->radiance.size(); ++i) {
      const glm::dvec3 ray = ray_of(camera, kMediaSize, i % kMediaSize.width, i / kMediaSize.width);
      const double taken = -std::expm1(-tau_ahead * glm::length(ray));
      const double exact = (1.0 - 1.0 / kExtinctionPerAbsorption) * double{kIrradiance} /
                           (4.0 * std::numbers::pi) * taken;
      for (int c = 0; c < 3; ++c)
        off = std::max(off, std::abs(double{frame->radiance[i][c]} / exact - 1.0));
    }
  }
  // A half's rounding, towards zero with some drivers: 2^-10. Seen on lavapipe: 9.8e-4.
  return Rows{{"relative error of light scattered, optical depth 1e-6 to 10, eye inside it",
               std::ldexp(1.0, -9), off}};
}

/// A floor, from between it and glass that a light from straight above passes.
Result<Frame> lit_floor(gpu::Device& device, const Glass& glass, double absorption) {
  std::vector<shared::Material> table = game::material_table();
  set_medium(table[kGlass], absorption);
  auto stage = Stage::create(device, table);
  if (!stage) return stage.error();
  const auto scene = [&](int, int y, int) -> world::BlockId {
    if (y < 0) return world::block::kStone;
    return glass.holds(y) ? kGlass : kAirBlock;
  };
  if (Result<void> added = (*stage)->add(scene, {0, -1, 0}, {1, 1, 1}); !added)
    return added.error();
  render::FrameInput in;
  in.camera = camera_at({32.5, 4.0, 32.5}, 0.0, -90.0);
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  in.islands = islands;
  in.sky = moon_above(100.0f);
  in.capture = true;
  render::RenderSettings settings;
  settings.leave_out.add(render::Feature::kHaze);
  return (*stage)->draw(in, settings, kMediaSize);
}

/// The share of a light that comes through glass to a floor against exp(-tau).
Result<Rows> lit_through(gpu::Device& device, const Glass& glass, const std::string& what) {
  const auto clear = lit_floor(device, glass, 0.0);
  if (!clear) return clear.error();
  double off = 0.0, darkest = 1.0;
  for (int decade = -6; decade <= 4; ++decade) {
    const double tau = std::pow(10.0, decade), exact = std::exp(-tau);
    const auto frame = lit_floor(device, glass, tau / glass.depth() / kExtinctionPerAbsorption);
    if (!frame) return frame.error();
    for (std::uint32_t i = 0; i < clear->radiance.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double all = static_cast<double>(clear->radiance[i][c]);
        if (all < kFaintest) return Error{"the floor has no light"};
        const double share = static_cast<double>(frame->radiance[i][c]) / all;
        // What is not a number is as far off as can be.
        off = std::isfinite(share) ? std::max(off, std::abs(share - exact)) : 1.0;
        darkest = std::min(darkest, share);
      }
  }
  return Rows{{"error of light that comes through, optical depth 1e-6 to 1e4, " + what, 4e-3,
               if_shown(darkest < 0.5, off)}};
}

Result<Rows> light_through_slab(gpu::Device& device) {
  return lit_through(device, {8.0, 24.0}, "slab of 16 blocks");
}

Result<Rows> light_through_panes(gpu::Device& device) {
  return lit_through(device, {8.0, 63.0, 28}, "28 panes");
}

constexpr Case kMediaCases[] = {{"media.inside", inside},
                                {"media.slab", slab},
                                {"media.slabs", slabs},
                                {"media.panes", many_panes},
                                {"media.faint", faint_media},
                                {"media.light_slab", light_through_slab},
                                {"media.light_panes", light_through_panes}};

}  // namespace

std::span<const Case> media_cases() {
  return kMediaCases;
}

}  // namespace skerry::tools::stability
