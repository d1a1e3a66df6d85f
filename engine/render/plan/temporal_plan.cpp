#include "engine/render/plan/temporal_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <span>

#include "engine/gpu/device/resource_desc.h"
#include "engine/render/frame/frame_choices.h"
#include "engine/render/plan/frame_history.h"
#include "engine/render/plan/frame_tables.h"
#include "engine/render/plan/in_view.h"

namespace skerry::render {
namespace {

/// Of display light by exposure, both as logarithms, in the dark: ACES has 1.26 to 1.5.
constexpr float kSlopeOfTone = 1.4f;
// Between successive frames of a history; up to seven such steps lie between frames that are mixed.
constexpr float kMostExposureStep = 0.5f;  // stops
// Cosine of the angle that sun and moon may move: 0.2 degrees, more than half a minute of the day.
constexpr double kLeastSameSky = 0.999994;

struct View {
  View(const Camera& camera, VkExtent2D pixels)
      : view(view_of(camera, pixels.width, pixels.height)), size(pixels.width, pixels.height) {}
  CameraView view;
  glm::dvec2 size;
};

/// @param rotation, shift from camera-relative world to that of the last frame [blocks].
shared::Motion motion(const View& now, const View& before, const glm::dmat3& rotation,
                      const glm::dvec3& shift) {
  const glm::dvec3 right = glm::dvec3(now.view.right) * static_cast<double>(now.view.tan_half_x);
  const glm::dvec3 up = glm::dvec3(now.view.up) * static_cast<double>(now.view.tan_half_y);
  // Columns of a ray by x, y and 1, and of the way by reverse depth, each before the last camera.
  const std::array<glm::dvec3, 4> columns{rotation * (right * (2.0 / now.size.x)),
                                          rotation * (up * (-2.0 / now.size.y)),
                                          rotation * (glm::dvec3(now.view.forward) - right + up),
                                          shift / static_cast<double>(kNearPlane)};
  const glm::dvec3 forward(before.view.forward);
  const glm::dvec3 row_x =
      0.5 * before.size.x *
      (glm::dvec3(before.view.right) / double{before.view.tan_half_x} + forward);
  const glm::dvec3 row_y =
      0.5 * before.size.y * (forward - glm::dvec3(before.view.up) / double{before.view.tan_half_y});
  const auto row = [&](const glm::dvec3& of) {
    return glm::vec4(glm::dot(of, columns[0]), glm::dot(of, columns[1]), glm::dot(of, columns[2]),
                     glm::dot(of, columns[3]));
  };
  return {row(row_x), row(row_y), row(forward)};
}

/// Of each island and of the sky, to an earlier frame. @param out one each.
void add_motions(const FrameInput& input, const PreviousFrame& then, VkExtent2D size,
                 std::span<shared::Motion> out) {
  const View now(input.camera, size), before(then.camera, size);
  for (std::size_t i = 0; i < input.islands.size(); ++i) {
    if (i >= then.islands->size()) continue;  // it was not there
    const IslandPlacement &here = input.islands[i], &there = (*then.islands)[i];
    const glm::dmat3 rotation =
        glm::mat3_cast(there.rotation) * glm::transpose(glm::mat3_cast(here.rotation));
    const glm::dvec3 shift = blocks_between(there.origin, then.camera.position) -
                             rotation * blocks_between(here.origin, input.camera.position);
    out[i] = motion(now, before, rotation, shift);
  }
  out[input.islands.size()] = motion(now, before, glm::dmat3(1.0), glm::dvec3(0.0));
}

bool same_view(const Camera& a, const Camera& b) {
  return a.position == b.position && a.yaw_deg == b.yaw_deg && a.pitch_deg == b.pitch_deg &&
         a.fov_deg == b.fov_deg;
}

/// Whether nothing that is drawn has moved between the two. What has come or gone is known by its
/// sections, see changed_area().
/// @param drawn islands that have sections. @param view the camera's.
bool is_still(const FrameInput& input, const PreviousFrame& then, const std::vector<bool>& drawn,
              const shared::CullView& view) {
  if (!same_view(input.camera, then.camera)) return false;
  for (std::size_t i = 0; i < input.islands.size(); ++i) {
    if (!drawn[i]) continue;
    const IslandPlacement& here = input.islands[i];
    const IslandPlacement& there = i < then.islands->size() ? (*then.islands)[i] : here;
    if (here.origin == there.origin && here.rotation == there.rotation) continue;
    for (const IslandPlacement* island : {&here, &there})
      if (island_in_view(*island, view, input.camera.position)) return false;
  }
  return true;
}

/// Equal but for what moves while one plays.
bool same_sky(const Celestial& a, const Celestial& b) {
  return glm::dot(a.to_sun, b.to_sun) >= kLeastSameSky &&
         glm::dot(a.to_moon, b.to_moon) >= kLeastSameSky && a.sun_exists == b.sun_exists &&
         a.moon_exists == b.moon_exists;
}

bool is_of_use(const TemporalHistory& last, const TemporalHistory& next, std::uint64_t generation) {
  return last.generation == generation && gpu::same_size(last.drawn, next.drawn) &&
         last.settings == next.settings && same_sky(last.sky, next.sky) &&
         std::abs(last.views[0].exposure_ev - next.views[0].exposure_ev) <= kMostExposureStep;
}

}  // namespace

glm::vec2 temporal_jitter(std::uint32_t frame) {
  const std::uint32_t slot = frame % shared::kMixedFrames;
  return glm::vec2(shared::jitter_x(slot), shared::jitter_y(slot)) / 8.0f;
}

std::optional<TemporalPlan> plan_temporal(const FrameInput& input, const RenderSettings& settings,
                                          const FrameTables& tables, const SceneFacts& facts,
                                          const FrameHistory& history) {
  if (why_not_temporal(input, settings) || !facts.has_geometry()) return std::nullopt;
  TemporalPlan plan;
  const VkExtent2D drawn{tables.constants.size.x, tables.constants.size.y};
  plan.next = {.generation = 0,
               .frames = 1,
               .drawn = drawn,
               .settings = settings,
               .sky = input.sky,
               .views = {{facts.changes->version(), *input.exposure_ev, {}}}};
  const std::size_t movers = input.islands.size() + 1;
  plan.step.sky = static_cast<std::uint32_t>(movers - 1);
  plan.motions.resize(shared::kMixedFrames * movers);
  std::ranges::fill(plan.step.exposure_ratios, 1.0f);
  const std::optional<TemporalHistory>& last = history.temporal;
  if (!last || !history.previous || !is_of_use(*last, plan.next, facts.kept_generation))
    return plan;
  const std::uint32_t frame = last->frames;  // since the history began
  plan.next.frames = frame + 1;
  std::vector<KeptView> views = last->views;
  views[0].seen = *history.previous;
  plan.step.slot = frame % shared::kMixedFrames;
  const std::vector<bool> drawn_islands = islands_with_sections(facts, input.islands.size());
  const shared::CullView view = cull_view_of(view_of(input.camera, drawn.width, drawn.height));
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    const std::uint32_t slot = (frame - 1 - i) % shared::kMixedFrames;
    add_motions(input, views[i].seen, drawn,
                std::span(plan.motions).subspan(slot * movers, movers));
    plan.step.kept |= 1u << slot;
    if (is_still(input, views[i].seen, drawn_islands, view)) plan.step.still |= 1u << slot;
    if (i == 0 && plan.step.still != 0) plan.jitter = temporal_jitter(frame);
    plan.step.exposure_ratios[slot] =
        std::exp2(kSlopeOfTone * (views[i].exposure_ev - *input.exposure_ev));
  }
  plan.step.changed_area = changed_area(facts, tables, views.back().geometry_version);
  if (views.size() == shared::kMixedFrames - 1) views.pop_back();
  plan.next.views.insert(plan.next.views.end(), views.begin(), views.end());
  return plan;
}

void jitter_view(FrameTables& tables, glm::vec2 jitter) {
  shared::FrameConstants& frame = tables.constants;
  frame.sample_in_pixel += jitter;
  // What is sampled to the right of the centre is drawn to the left.
  glm::mat4& clip = tables.matrices[0];
  for (int column = 0; column < 3; ++column) {
    clip[column].x -= jitter.x * frame.pixel_to_ndc.x * clip[column].w;
    clip[column].y -= jitter.y * frame.pixel_to_ndc.y * clip[column].w;
  }
  // Culling sees a pixel more on each side.
  for (int side = 0; side < 4; ++side) {
    const float pixel = side < 2 ? frame.pixel_to_ndc.x * glm::length(frame.ray_right)
                                 : frame.pixel_to_ndc.y * glm::length(frame.ray_up);
    glm::vec4& plane = tables.views[0].planes[side];
    const glm::vec3 wider = glm::normalize(glm::vec3(plane) + pixel * frame.ray_forward);
    plane = glm::vec4(wider, plane.w);
  }
}

}  // namespace skerry::render
