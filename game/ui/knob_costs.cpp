#include "game/ui/knob_costs.h"

#include <algorithm>

namespace skerry::game::ui {

double KnobCosts::now_ms() const {
  if (frames_.empty()) return 0.0;
  std::vector<double> sorted = frames_;
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() / 2];
}

void KnobCosts::note_frame(double gpu_ms, bool complete) {
  if (frames_.size() == kFrames) frames_.erase(frames_.begin());
  frames_.push_back(gpu_ms);
  if (!complete) left_ = kSkipped + kFrames;
  if (!turned_ || !complete || --left_ != 0) return;
  if (before_ms_) costs_[index(*turned_)] = now_ms() - *before_ms_;
  turned_.reset();
}

void KnobCosts::turned(Knob knob) {
  if (turned_ != knob) {
    before_ms_.reset();
    if (!frames_.empty()) before_ms_ = now_ms();
  }
  turned_ = knob;
  left_ = kSkipped + kFrames;
}

}  // namespace skerry::game::ui
