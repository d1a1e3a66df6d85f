#include "game/ui/knob_costs.h"

#include <algorithm>

namespace skerry::game::ui {

KnobCosts::Times KnobCosts::now() const {
  if (frames_.empty()) return {};
  std::vector<double> sorted = frames_;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t quarter = sorted.size() / 4;
  return {sorted[sorted.size() / 2], sorted[sorted.size() - 1 - quarter] - sorted[quarter]};
}

void KnobCosts::note_frame(double gpu_ms, bool complete) {
  if (frames_.size() == kFrames) frames_.erase(frames_.begin());
  frames_.push_back(gpu_ms);
  if (!complete) left_ = kSkipped + kFrames;
  if (!turned_ || !complete || --left_ != 0) return;
  if (before_) {
    const Times after = now();
    costs_[index(*turned_)] =
        Cost{after.median_ms - before_->median_ms, std::max(after.spread_ms, before_->spread_ms)};
  }
  turned_.reset();
}

void KnobCosts::turned(Knob knob) {
  if (turned_ != knob) {
    before_.reset();
    if (!frames_.empty()) before_ = now();
  }
  turned_ = knob;
  left_ = kSkipped + kFrames;
}

}  // namespace skerry::game::ui
