#include "game/client/auto_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "game/pace/learnt_costs.h"
#include "game/pace/quality_front.h"
#include "game/scene_file/setting_keys.h"

namespace skerry::game {
namespace {

constexpr double kCpuRate = 30.0;

std::string_view meaning_of(Reason reason) {
  constexpr std::array<std::string_view, 5> kMeanings{"not measured yet", "measuring this machine",
                                                      "the best that fits", "frames came late",
                                                      "there was time to spare"};
  return kMeanings[static_cast<std::size_t>(reason)];
}

std::vector<double> priors() {
  std::vector<double> ms;
  for (const FrontPoint& point : quality_front()) ms.push_back(point.prior_ms);
  return ms;
}

/// Points that are measured first, the one to begin with before the others: of one level, so that
/// nothing has to be loaded in between, and far enough apart to tell what pixels cost.
std::vector<std::size_t> probes(bool on_cpu) {
  const auto medium = [](float scale) { return find_point(Quality::kMedium, scale); };
  if (on_cpu) return {medium(0.33f), medium(0.25f), medium(0.5f)};
  return {medium(1.0f), medium(0.5f)};
}

}  // namespace

AutoQuality::AutoQuality(const gpu::DeviceInfo& device, std::filesystem::path costs_path)
    : on_cpu_(device.type == VK_PHYSICAL_DEVICE_TYPE_CPU),
      device_(device.name),
      driver_(device.driver),
      costs_path_(std::move(costs_path)) {}

double AutoQuality::usual_rate(double display_hz) const {
  return on_cpu_ ? kCpuRate : display_hz;
}

Result<void> AutoQuality::begin(PictureSize size, SceneOptions& scene, Settings& settings) {
  size_ = size;
  machine_ = machine_name(device_, driver_, size.width, size.height);
  Result<std::optional<LearntCosts>> learnt = load_learnt_costs(costs_path_, machine_);
  const std::vector<std::size_t> first = probes(on_cpu_);
  control_ = learnt && *learnt
                 ? begin_control((*learnt)->point, priors(), (*learnt)->costs_ms, first)
                 : begin_control(first.front(), priors(), {}, first);
  learnt_changed_ = false;
  apply(scene, settings);
  if (!learnt && !std::exchange(damage_told_, true)) return learnt.error();
  return {};
}

void AutoQuality::apply(SceneOptions& scene, Settings& settings) const {
  const FrontPoint& point = quality_front()[control_.point];
  scene.quality = point.level;
  apply_front_point(point, scene.pinned, settings);
}

Result<bool> AutoQuality::note_frame(const FrameFacts& frame, double budget_ms, SceneOptions& scene,
                                     Settings& settings) {
  if (!scene.quality_auto) return false;
  pin(settings, scene);
  if (size_ != scene.size) {
    const Result<void> begun = begin(scene.size, scene, settings);
    if (!begun) return begun.error();
    return true;
  }
  const std::size_t before = control_.point;
  const auto costs_before = control_.costs_ms;
  control_ = next_control(std::move(control_), frame, budget_ms);
  learnt_changed_ |= control_.costs_ms != costs_before || control_.point != before;
  if (control_.point == before) return false;
  apply(scene, settings);
  return true;
}

Result<void> AutoQuality::keep() {
  const bool measured = std::any_of(control_.costs_ms.begin(), control_.costs_ms.end(),
                                    [](const auto& cost) { return cost.has_value(); });
  if (!measured || !control_.probes.empty() || !std::exchange(learnt_changed_, false)) return {};
  return save_learnt_costs(costs_path_, machine_, {control_.point, control_.costs_ms});
}

std::string AutoQuality::line(double budget_ms) const {
  const FrontPoint& point = quality_front()[control_.point];
  return fmt::format("auto: {}, error {:.3f} FLIP, {:.1f} of {:.1f} ms: {}", label_of(point),
                     point.error, control_.mean_ms, budget_ms, meaning_of(control_.reason));
}

void AutoQuality::pin(const Settings& settings, SceneOptions& scene) const {
  if (!scene.quality_auto) return;
  Settings chosen = settings;
  apply_front_point(quality_front()[control_.point], scene.pinned, chosen);
  if (chosen == settings) return;
  for (const SettingKey& entry : setting_keys()) {
    const std::string value = entry.print(settings);
    if (!is_chosen_by_front(entry.key) || value == entry.print(chosen)) continue;
    const std::string prefix = std::string(entry.key) + "=";
    std::erase_if(scene.pinned, [&](const std::string& p) { return p.starts_with(prefix); });
    scene.pinned.push_back(prefix + value);
  }
}

}  // namespace skerry::game
