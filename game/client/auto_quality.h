#pragma once
#include <filesystem>
#include <string>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "game/pace/quality_control.h"
#include "game/scene_file/options.h"

namespace skerry::game {

/// Carries quality_control.h's choices to what is drawn, and what was learnt to its file.
class AutoQuality {
 public:
  /// @param costs_path see learnt_costs_path(); empty: nothing is kept.
  AutoQuality(const gpu::DeviceInfo& device, std::filesystem::path costs_path);

  /// Before the first frame, and whenever the choice is to be made anew: sets what was learnt of
  /// this machine at this size, or else what suits most devices of its kind. Errors: the file of
  /// what was learnt is damaged, which is told once; the machine is measured anew.
  Result<void> begin(PictureSize size, SceneOptions& scene, Settings& settings);

  /// Frames a second that are wanted where the player names none.
  double usual_rate(double display_hz) const;

  /// After each frame. Settings that somebody else has changed are pinned. @return whether settings
  /// and the scene's quality have changed. No effect, and false, where the scene's quality is not
  /// chosen. Errors: those of begin(), and of the file of what was learnt.
  Result<bool> note_frame(const FrameFacts& frame, double budget_ms, SceneOptions& scene,
                          Settings& settings);
  /// Adds to `scene.pinned` each key of the front that somebody else has set to what the chosen
  /// point does not have. No effect where the scene's quality is not chosen.
  void pin(const Settings& settings, SceneOptions& scene) const;
  /// Writes what was learnt since the last call. Errors: the file cannot be written.
  Result<void> keep();

  /// For the overlay: what is chosen, the error it costs, what it takes, and why.
  std::string line(double budget_ms) const;

 private:
  void apply(SceneOptions& scene, Settings& settings) const;

  bool on_cpu_;
  std::string device_, driver_, machine_;
  std::filesystem::path costs_path_;
  PictureSize size_{};
  QualityControl control_;
  bool learnt_changed_ = false;
  bool damage_told_ = false;
};

}  // namespace skerry::game
