#include "engine/render/plan/temporal_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "engine/gpu/device/resource_desc.h"
#include "engine/render/frame/frame_choices.h"
#include "engine/render/plan/frame_history.h"
#include "engine/render/plan/frame_tables.h"
#include "engine/render/plan/in_view.h"
#include "shaders/shared/edges.h"

namespace skerry::render {
namespace {

constexpr std::uint32_t kJitterFrames = 16;
/// Of a pixel: textures are filtered for less, since frames that are mixed filter them, too.
constexpr float kTexelFootprint = 0.5f;
/// Of display light by exposure, both as logarithms, in the dark: ACES has 1.26 to 1.5.
constexpr float kSlopeOfTone = 1.4f;
constexpr float kMostExposureStep = 0.5f;  // stops between two frames that are mixed
// Cosine of the angle that sun and moon may move between two frames that are mixed: 0.2 degrees,
// more than half a minute of the day.
constexpr double kLeastSameSky = 0.999994;

double halton(std::uint32_t index, std::uint32_t base) {
  double out = 0.0, share = 1.0;
  for (; index != 0; index /= base) {
    share /= base;
    out += share * (index % base);
  }
  return out;
}

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

std::vector<shared::Motion> motions(const FrameInput& input, const PreviousFrame& last,
                                    VkExtent2D size) {
  const View now(input.camera, size), before(last.camera, size);
  std::vector<shared::Motion> out;
  for (std::size_t i = 0; i < input.islands.size(); ++i) {
    if (i >= last.islands->size()) {
      out.emplace_back();  // it was not there
      continue;
    }
    const IslandPlacement &here = input.islands[i], &there = (*last.islands)[i];
    const glm::dmat3 rotation =
        glm::mat3_cast(there.rotation) * glm::transpose(glm::mat3_cast(here.rotation));
    const glm::dvec3 shift = blocks_between(there.origin, last.camera.position) -
                             rotation * blocks_between(here.origin, input.camera.position);
    out.push_back(motion(now, before, rotation, shift));
  }
  out.push_back(motion(now, before, glm::dmat3(1.0), glm::dvec3(0.0)));
  return out;
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
         std::abs(last.exposure_ev - next.exposure_ev) <= kMostExposureStep;
}

}  // namespace

glm::vec2 temporal_jitter(std::uint32_t frame) {
  const std::uint32_t index = frame % kJitterFrames;
  const auto centred = [](double at) { return static_cast<float>(at < 0.5 ? at : at - 1.0); };
  return {centred(halton(index, 2)), centred(halton(index, 3))};
}

std::optional<TemporalPlan> plan_temporal(const FrameInput& input, const RenderSettings& settings,
                                          const FrameTables& tables, const SceneFacts& facts,
                                          const FrameHistory& history) {
  if (why_not_temporal(input, settings) || !facts.has_geometry()) return std::nullopt;
  TemporalPlan plan;
  const VkExtent2D drawn{tables.constants.size.x, tables.constants.size.y};
  plan.next = {.generation = 0,
               .geometry_version = facts.changes->version(),
               .frames = 1,
               .drawn = drawn,
               .settings = settings,
               .sky = input.sky,
               .exposure_ev = *input.exposure_ev};
  plan.step.bend =
      shared::kBendOfPlane * tables.constants.pixel_to_ndc.y * glm::length(tables.constants.ray_up);
  plan.step.sky = static_cast<std::uint32_t>(input.islands.size());
  plan.motions.resize(input.islands.size() + 1);
  const std::optional<TemporalHistory>& last = history.temporal;
  if (!last || !history.previous || !is_of_use(*last, plan.next, facts.kept_generation))
    return plan;
  plan.frame = last->frames;
  plan.next.frames = last->frames + 1;
  plan.jitter = temporal_jitter(plan.frame);
  plan.motions = motions(input, *history.previous, drawn);
  plan.step.kept = 1;
  plan.step.last_sample = 0.5f + temporal_jitter(last->frames - 1);
  plan.step.exposure_ratio = std::exp2(kSlopeOfTone * (last->exposure_ev - plan.next.exposure_ev));
  plan.step.changed_area = changed_area(facts, tables, last->geometry_version);
  return plan;
}

void jitter_view(FrameTables& tables, glm::vec2 jitter) {
  shared::FrameConstants& frame = tables.constants;
  frame.sample_in_pixel += jitter;
  frame.texel_footprint *= kTexelFootprint;
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
