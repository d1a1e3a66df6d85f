// The eye's adaptation at time steps and targets that no frame has.
#include "engine/render/frame/exposure.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <optional>

#include "game/view/materials.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using render::adapted_ev;

constexpr double kBlack = -20.0, kBlinding = 20.0;  // stops, the ends of what can be set
// A result is rounded a few times at a magnitude of at most 40 (the difference of the ends), where
// a double's half unit in the last place is 2^-48.
const double kRounding = 4.0 * std::ldexp(1.0, -48);

/// From 0 and 1e-12 to 1e6 s, eight steps a decade.
std::vector<double> time_steps() {
  std::vector<double> steps{0.0};
  for (int i = -12 * 8; i <= 6 * 8; ++i) steps.push_back(std::pow(10.0, i / 8.0));
  return steps;
}

Result<Rows> steps() {
  double beyond = 0.0, backwards = 0.0, unmoved = 0.0, short_of_target = 0.0, moved = 0.0;
  for (const auto& [from, to] : {std::pair{kBlack, kBlinding}, std::pair{kBlinding, kBlack}}) {
    double last = from;
    for (const double dt : time_steps()) {
      const double ev = adapted_ev(from, to, dt);
      beyond = std::max({beyond, kBlack - ev, ev - kBlinding});
      moved = std::max(moved, std::abs(ev - from));
      backwards = std::max(backwards, std::abs(last - to) < std::abs(ev - to) ? 1.0 : 0.0);
      last = ev;
    }
    unmoved = std::max(unmoved, std::abs(adapted_ev(from, to, 0.0) - from));
    short_of_target = std::max(short_of_target, std::abs(last - to));
  }
  return Rows{
      {"stops beyond the targets, dt 0 to 1e6 s", 0.0, if_shown(moved > 0.0, beyond)},
      {"longer waits that end farther from the target", 0.0, if_shown(moved > 0.0, backwards)},
      {"stops moved in no time", 0.0, unmoved},
      {"stops left after 1e6 s", 0.0, short_of_target}};
}

/// Frames that are black and blinding by turns. Each must move towards its own target, and the pair
/// must settle: from cycle to cycle the place at the cycle's end moves less and less.
Result<Rows> alternating() {
  double wrong_way = 0.0, beyond = 0.0, growth = 0.0, moved = 0.0;
  for (const double dt : time_steps()) {
    double ev = 0.0, cycle_end = 0.0, last_move = HUGE_VAL;
    for (int frame = 0; frame < 400; ++frame) {
      const double target = frame % 2 == 0 ? kBlack : kBlinding;
      const double next = adapted_ev(ev, target, dt);
      wrong_way += (next - ev) * (target - ev) < 0.0;
      beyond = std::max({beyond, kBlack - next, next - kBlinding});
      ev = next;
      if (frame % 2 == 0) continue;
      const double move = std::abs(ev - cycle_end);
      growth = std::max(growth, move - last_move);
      moved = std::max(moved, move);
      last_move = move;
      cycle_end = ev;
    }
  }
  return Rows{
      {"frames that move away from their target", 0.0, if_shown(moved > 0.0, wrong_way)},
      {"stops beyond the targets, black and blinding by turns", 0.0, if_shown(moved > 0.0, beyond)},
      {"stops a cycle moves the exposure more than the cycle before", 0.0,
       if_shown(moved > 0.0, growth)}};
}

Result<Rows> splitting() {
  // n roundings, each of at most kRounding: what a split of n parts may be off by.
  double most = 0.0, moved = 0.0;
  for (const double whole_s : {1e-3, 0.1, 1.0, 10.0, 1e3}) {
    for (const int parts : {2, 7, 1000, 100000}) {
      for (const auto& [from, to] : {std::pair{kBlack, kBlinding}, std::pair{kBlinding, kBlack}}) {
        double ev = from;
        for (int i = 0; i < parts; ++i) ev = adapted_ev(ev, to, whole_s / parts);
        most = std::max(most, std::abs(ev - adapted_ev(from, to, whole_s)) / parts);
        moved = std::max(moved, std::abs(ev - from));
      }
    }
  }
  return Rows{{"stops a part that splitting a time changes, 2 to 100,000 parts", kRounding,
               if_shown(moved > 0.0, most)}};
}

Result<Rows> nothing_metered() {
  double moved = 0.0;
  for (const double target : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    for (const double dt : time_steps())
      moved = std::max(moved, adapted_ev(-3.25, target, dt) == -3.25 ? 0.0 : 1.0);
  const bool follows = adapted_ev(-3.25, 0.0, 1.0) != -3.25;
  return Rows{{"times a target of NaN or infinity was followed", 0.0, if_shown(follows, moved)}};
}

/// A lamp that blinds, or nothing but black stone.
world::BlockId before_the_eye(bool blinding, int x, int y, int z) {
  if (std::min({x, y, z}) < 16 || std::max({x, y, z}) >= 48) return world::block::kAirBlock;
  if (std::min({x, y, z}) >= 18 && std::max({x, y, z}) < 46) return world::block::kAirBlock;
  return blinding ? world::block::kLamp : world::block::kStone;
}

/// What play does, with frames drawn and metered: a closed room of lamps and one of stone by turns.
/// The pictures' exposures go to the ends of what can be set.
Result<Rows> metered_frames(gpu::Device& device) {
  constexpr VkExtent2D kSize{64, 48};
  std::vector<shared::Material> glaring = game::material_table();
  glaring[world::block::kLamp].emission = glm::packHalf1x16(60000.0f);
  const std::vector<render::IslandPlacement> island{{{}, {1.0, 0.0, 0.0, 0.0}, 200.0}};
  std::unique_ptr<Stage> stages[2];
  for (const bool blinding : {false, true}) {
    auto stage = Stage::create(device, glaring);
    if (!stage) return stage.error();
    const auto blocks = [&](int x, int y, int z) { return before_the_eye(blinding, x, y, z); };
    if (Result<void> added = (*stage)->add(blocks, {0, 0, 0}, {1, 1, 1}); !added)
      return added.error();
    stages[blinding] = *std::move(stage);
  }
  render::FrameInput input;
  input.islands = island;
  input.camera = camera_at({32.0, 32.0, 32.0}, 20.0, 0.0);
  input.sky = sun_towards({0.4, 0.8, -0.5});
  input.meter = true;
  const render::MeterSettings limits;
  double black_metered = 0.0, black_lit = 0.0, differing = 0.0, beyond = 0.0, wrong_way = 0.0,
         unmetered = 0.0;
  std::optional<float> glare;
  for (const double dt : {0.0, 1e-9, 1.0 / 60.0, 1.0, 1e6}) {
    for (double ev : {kBlack, -3.0, kBlinding}) {
      for (int turn = 0; turn < 6; ++turn) {
        const bool blinding = turn % 2 == 1;
        input.exposure_ev = static_cast<float>(ev);
        const auto frame = stages[blinding]->draw(input, {}, kSize);
        if (!frame) return frame.error();
        const std::optional<float> asked = frame->report.metered_ev;
        if (!blinding) {
          black_metered += asked.has_value();
          for (std::size_t i = 0; i < frame->rgba.size(); ++i)
            black_lit += i % 4 != 3 && frame->rgba[i] != 0;
        } else if (!asked) {
          ++unmetered;
        } else {
          if (!glare) glare = asked;
          differing += *glare != *asked;
          beyond =
              std::max({beyond, double{*asked} - limits.max_ev, limits.min_ev - double{*asked}});
        }
        const double next = adapted_ev(ev, asked.value_or(std::nanf("")), dt);
        wrong_way += asked && (next - ev) * (*asked - ev) < 0.0;
        ev = next;
      }
    }
  }
  return Rows{{"black frames that moved the meter, exposures of -20 to 20 stops", 0.0,
               if_shown(glare.has_value(), black_metered)},
              {"channels above 0 in black frames, exposures of -20 to 20 stops", 0.0, black_lit},
              {"blinding frames that were not metered", 0.0, unmetered},
              {"blinding frames metered otherwise at another exposure", 0.0,
               if_shown(glare.has_value(), differing)},
              {"stops metered beyond the limits", 0.0, if_shown(glare.has_value(), beyond)},
              {"metered frames after which the eye moved away", 0.0,
               if_shown(glare.has_value(), wrong_way)}};
}

constexpr Case kExposureCases[] = {{"exposure.steps", steps},
                                   {"exposure.alternating", alternating},
                                   {"exposure.splitting", splitting},
                                   {"exposure.nothing_metered", nothing_metered},
                                   {"exposure.metered_frames", metered_frames}};

}  // namespace

std::span<const Case> exposure_cases() {
  return kExposureCases;
}

}  // namespace skerry::tools::stability
