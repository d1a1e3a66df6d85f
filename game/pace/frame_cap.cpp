#include "game/pace/frame_cap.h"

#include <algorithm>

#include "game/scene_file/settings.h"

namespace skerry::game {

double capped_rate(double cap, double display_hz, bool focused, double unfocused) {
  const double rate = cap == FrameSettings::kDisplayCap ? display_hz : cap;
  if (focused) return rate;
  return rate > 0.0 ? std::min(rate, unfocused) : unfocused;
}

double next_due(double due_s, double now_s, double rate) {
  if (rate <= 0.0) return now_s;
  const double next = due_s + 1.0 / rate;
  return now_s - next > 1.0 / rate ? now_s : next;
}

}  // namespace skerry::game
