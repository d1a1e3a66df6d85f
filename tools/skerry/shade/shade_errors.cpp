#include "tools/skerry/shade/shade_errors.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "engine/core/jobs.h"
#include "game/view/light_chunk.h"
#include "tools/reference/reference.h"
#include "tools/reference/shade.h"
#include "tools/skerry/shade/stored_light.h"

namespace skerry::tools {
namespace {

constexpr ShadeScene kScenes[] = {
    {"day", R"({"seed": 1, "time": "10:30"})"},
    {"dusk", R"({"seed": 6, "time": "18:05", "camera": [-60, 145, 279, 90, -8]})"},
    {"night", R"({"seed": 4, "time": "00:30", "settings": {"sky.moon_phase": 0.5}})"},
    {"forest", R"({"seed": 4, "time": "11:00", "camera": [-115.4, 108.4, 230.78, 150, -21.8]})"},
    {"cave_mouth", R"({"seed": 4, "time": "12:00", "camera": [181.29, 30.64, 14.98, 205, 3]})"},
    {"pit", R"({"seed": 1, "time": "12:30", "camera": [0.5, 118.5, 5.5, 180, -55],
        "blocks": [{"block": "stone", "from": [-12, 100, -12], "to": [12, 115, 12]},
                   {"block": "sand", "from": [-5, 101, -5], "to": [5, 101, 5]},
                   {"block": "air", "from": [-4, 102, -4], "to": [4, 115, 4]}]})"},
    {"lake", R"({"seed": 5, "time": "11:00", "camera": [52.25, 17.5, 52.75, 225, -25]})"},
    {"under_island", R"({"seed": 7, "time": "12:00", "camera": [-9, -140, -90, 0, 40]})"},
    {"room", R"({"seed": 1, "time": "12:30", "camera": [4.5, 116.7, 4.5, 225, -8],
        "blocks": [{"block": "stone", "from": [-8, 110, -8], "to": [8, 114, 8]},
                   {"block": "planks", "from": [-7, 115, -7], "to": [7, 120, 7]},
                   {"block": "air", "from": [-6, 115, -6], "to": [6, 119, 6]},
                   {"block": "air", "from": [-7, 116, -2], "to": [-7, 118, 2]}]})"},
    {"stained_hall", R"({"seed": 1, "time": "10:00", "camera": [4.5, 116.7, 4.5, 225, -8],
        "blocks": [{"block": "stone", "from": [-8, 110, -8], "to": [8, 114, 8]},
                   {"block": "limestone", "from": [-7, 115, -7], "to": [7, 120, 7]},
                   {"block": "air", "from": [-6, 115, -6], "to": [6, 119, 6]},
                   {"block": "red_glass", "from": [-7, 115, -4], "to": [-7, 119, 4]},
                   {"block": "sky_glass", "from": [-4, 115, -7], "to": [4, 119, -7]}]})"},
    {"lava_cave", R"({"seed": 1, "time": "12:30", "camera": [4.5, 116.7, 4.5, 225, -8],
        "blocks": [{"block": "stone", "from": [-12, 108, -12], "to": [12, 124, 12]},
                   {"block": "air", "from": [-7, 113, -7], "to": [7, 119, 7]},
                   {"block": "lava", "from": [-6, 112, -6], "to": [-2, 112, -2]},
                   {"block": "stone", "from": [-1, 113, -4], "to": [0, 116, 0]}]})"},
    {"mycelium", R"({"seed": 1, "time": "20:00", "camera": [-629, 75, -95, 180, -10],
        "settings": {"sky.moon_phase": 0.25}})"},
    {"turned", R"({"seed": 1, "time": "14:00", "camera": [-150, 160, -150, 45, -30],
        "settings": {"world.time": 40000}})"},
    {"far", R"({"seed": 5, "time": "13:00", "camera": [-60, 260, -500, 20, -18]})"},
};

double luminance_of(glm::dvec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

/// What one pixel shows.
struct JudgedPlace {
  double shown = 0.0, stored = 0.0;  // share of its samples
  std::uint64_t island = 0;          // and so on, of StoredLight::at(): the first stored place
  glm::dvec3 lattice{0.0};
  int direction = 0;
  // Means over stored places, and the variance of `difference` as an estimate.
  glm::dvec3 reference{0.0}, difference{0.0}, variance{0.0};
};

/// Within a block of a weak lamp: irradiance of a point has no bound there, that of a plant has.
bool beside_a_lamp(const reference::Scene& scene, glm::dvec3 place) {
  constexpr double kBeside = 1.0;  // blocks
  return std::ranges::any_of(scene.lights, [&](const reference::Light& light) {
    return light.range <= static_cast<double>(game::kWeakLampRange) &&
           glm::distance(light.position, place) < kBeside;
  });
}

/// Judges what pixels show by as many samples as a reference picture has.
class Judge {
 public:
  Judge(const reference::NamedScene& named, const StoredLight& stored,
        const reference::ReferenceSettings& settings)
      : named_(named),
        stored_(stored),
        settings_(settings),
        tracer_(named.scene.islands),
        shader_(named.scene, tracer_) {}

  JudgedPlace at(std::uint32_t x, std::uint32_t y) const {
    const bool centred = settings_.filter == game::ReferenceFilter::kCentre;
    const std::uint32_t count = std::max(1u, settings_.samples / reference::kBatches);
    constexpr auto kBatches = static_cast<double>(reference::kBatches);
    JudgedPlace out;
    Place place;
    if (centred) place = place_towards(glm::dvec2(x, y) + 0.5);
    std::array<Sum, reference::kBatches> batches;
    Sum all;
    for (std::uint32_t batch = 0; batch < reference::kBatches; ++batch) {
      Sum& sum = batches[batch];
      for (std::uint32_t i = 0; i < count; ++i) {
        reference::Sampler sampler(y * named_.scene.view.width + x, batch, i);
        if (!centred) place = place_towards(glm::dvec2(x, y) + sampler.next());
        out.shown += place.shown ? 1.0 : 0.0;
        if (!place.light) continue;
        if (all.count + sum.count == 0.0) {
          out.island = place.island;
          out.lattice = place.hit.lattice;
          out.direction = place.direction;
        }
        const glm::dvec3 exact =
            shader_.soft_irradiance({place.point, place.normal,
                                     place.direction == StoredLight::kPlant ? &place.hit : nullptr},
                                    double{game::kWeakLampRange}, sampler);
        sum.count += 1.0;
        sum.reference += exact;
        sum.difference += *place.light - exact;
      }
      all.count += sum.count;
      all.reference += sum.reference;
      all.difference += sum.difference;
    }
    out.shown /= kBatches * count;
    out.stored = all.count / (kBatches * count);
    if (all.count == 0.0) return out;
    out.reference = all.reference / all.count;
    out.difference = all.difference / all.count;
    // Of a ratio: batches have different numbers of stored places.
    for (const Sum& sum : batches) {
      const glm::dvec3 off = (sum.difference - sum.count * out.difference) / all.count;
      out.variance += off * off * (kBatches / (kBatches - 1.0));
    }
    return out;
  }

 private:
  struct Place {
    bool shown = false;
    std::optional<glm::dvec3> light;  // that is stored there
    std::uint64_t island = 0;
    reference::Meeting hit;
    int direction = 0;
    glm::dvec3 point{}, normal{};
  };
  struct Sum {
    double count = 0.0;
    glm::dvec3 reference{0.0}, difference{0.0};
  };

  /// @param pixel its middle is at 1/2.
  Place place_towards(glm::dvec2 pixel) const {
    const reference::View& view = named_.scene.view;
    const double across = (2.0 * pixel.x / view.width - 1.0) * view.tan_half_y * view.width /
                          view.height,
                 down = (2.0 * pixel.y / view.height - 1.0) * view.tan_half_y;
    const glm::dvec3 direction =
        glm::normalize(view.forward + view.right * across - view.up * down);
    thread_local reference::Trace trace;
    tracer_.trace(glm::dvec3(0.0), direction, trace);
    Place out;
    if (!trace.hit || beside_a_lamp(named_.scene, direction * trace.hit->t)) return out;
    out.shown = true;
    out.hit = *trace.hit;
    const bool plant = out.hit.face >= StoredLight::kPlant;
    out.island = named_.ids[out.hit.island];
    out.direction = plant ? StoredLight::kPlant : out.hit.face;
    out.light = stored_.at(out.island, out.hit.lattice, out.direction);
    if (!out.light) return out;
    out.normal = tracer_.normal(out.hit.island, out.hit.face);
    constexpr double kOffSurface = 1e-7;  // blocks
    out.point = direction * out.hit.t + (plant ? glm::dvec3(0.0) : out.normal * kOffSurface);
    return out;
  }

  const reference::NamedScene& named_;
  const StoredLight& stored_;
  const reference::ReferenceSettings& settings_;
  reference::Tracer tracer_;
  reference::Shader shader_;
};

ShadeErrors over(std::span<const JudgedPlace> places) {
  ShadeErrors out;
  double count = 0.0;
  glm::dvec3 mean(0.0), difference(0.0), squares(0.0), variance(0.0);
  std::vector<double> off;
  for (const JudgedPlace& place : places) {
    out.places += place.shown;
    out.without += place.shown - place.stored;
    if (place.stored == 0.0) continue;
    count += place.stored;
    mean += place.stored * place.reference;
    difference += place.stored * place.difference;
    squares += place.stored * place.difference * place.difference;
    variance += place.stored * place.variance;
    off.push_back(std::abs(luminance_of(place.difference)));
  }
  if (off.empty()) return out;
  const auto per_channel = [count](glm::dvec3 sum) {
    return (sum.x + sum.y + sum.z) / (3.0 * count);
  };
  out.mean = per_channel(mean);
  if (out.mean == 0.0) return out;
  out.rmse = std::sqrt(std::max(0.0, per_channel(squares) - per_channel(variance))) / out.mean;
  out.bias = per_channel(difference) / out.mean;
  out.standard_error = std::sqrt(per_channel(variance)) / out.mean;
  const auto at = off.begin() + static_cast<std::ptrdiff_t>(off.size() * 99 / 100);
  std::nth_element(off.begin(), at, off.end());
  out.worst = *at / out.mean;
  return out;
}

}  // namespace

std::span<const ShadeScene> shade_scenes() {
  return kScenes;
}

namespace {

/// Of each pixel of the scene's picture.
Result<std::vector<JudgedPlace>> judged_places(const game::SceneOptions& options,
                                               const StoredLight& stored) {
  const reference::ReferenceSettings settings = reference::settings_from(options);
  const Result<reference::NamedScene> named = reference::scene_from(options, settings);
  if (!named) return named.error();
  const Judge judge(*named, stored, settings);
  const reference::View& view = named->scene.view;
  std::vector<JudgedPlace> places(std::size_t{view.width} * view.height);
  Jobs jobs(settings.threads);
  jobs.parallel_for(static_cast<int>(view.height), [&](int row) {
    const auto y = static_cast<std::uint32_t>(row);
    for (std::uint32_t x = 0; x < view.width; ++x)
      places[std::size_t{y} * view.width + x] = judge.at(x, y);
  });
  return places;
}

}  // namespace

Result<ShadeErrors> measure_shade(const game::SceneOptions& options) {
  const Result<StoredLight> stored = StoredLight::find(options);
  if (!stored) return stored.error();
  const Result<std::vector<JudgedPlace>> places = judged_places(options, *stored);
  if (!places) return places.error();
  ShadeErrors out = over(*places);
  out.work_seconds = stored->work_seconds();
  out.bytes = stored->bytes();
  return out;
}

Result<ShadePictures> draw_shade(game::SceneOptions options, std::span<const LightDetail> details) {
  options.settings.reference_filter = game::ReferenceFilter::kCentre;
  ShadePictures out;
  std::vector<JudgedPlace> places;
  for (const LightDetail& detail : details) {
    const Result<StoredLight> stored = StoredLight::find(options, detail);
    if (!stored) return stored.error();
    if (places.empty()) {
      Result<std::vector<JudgedPlace>> judged = judged_places(options, *stored);
      if (!judged) return judged.error();
      places = *std::move(judged);
    }
    out.stored.push_back({options.size.width, options.size.height, {}});
    measure::Picture& picture = out.stored.back();
    for (const JudgedPlace& place : places)
      picture.pixels.emplace_back(
          place.stored > 0.0
              ? stored->at(place.island, place.lattice, place.direction).value_or(glm::dvec3(0.0))
              : glm::dvec3(0.0));
  }
  out.reference = {options.size.width, options.size.height, {}};
  glm::dvec3 variance(0.0);
  double light = 0.0;
  for (const JudgedPlace& place : places) {
    out.reference.pixels.emplace_back(place.reference);
    light += luminance_of(place.reference);
    variance += place.variance;
  }
  if (light > 0.0)
    out.standard_error =
        std::sqrt(luminance_of(variance) * static_cast<double>(places.size())) / light;
  return out;
}

Result<double> shade_work_ms(const game::SceneOptions& options, const LightDetail& detail) {
  const Result<StoredLight> stored = StoredLight::find(options, detail);
  if (!stored) return stored.error();
  return 1e3 * stored->work_seconds();
}

}  // namespace skerry::tools
