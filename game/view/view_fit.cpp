#include "game/view/view_fit.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace skerry::game {
namespace {

constexpr double kLeastDetail = 0.25;  // of the view distance's own detail, before distance goes

}  // namespace

ViewFit::Distances ViewFit::of(const Distances& asked) const {
  Distances shown = asked;
  const double least_detail = std::max(kLeast, asked.detail_blocks * kLeastDetail);
  for (int i = 0; i < step_; ++i) {
    if (shown.detail_blocks > least_detail)
      shown.detail_blocks = std::max(least_detail, shown.detail_blocks * kStep);
    else
      shown.view_blocks = std::max(kLeast, shown.view_blocks * kStep);
  }
  shown.detail_blocks = std::min(shown.detail_blocks, asked.detail_blocks);
  shown.view_blocks = std::min(shown.view_blocks, asked.view_blocks);
  return shown;
}

bool ViewFit::lower(const Distances& asked, const world::WorldPos& camera) {
  const Distances before = of(asked);
  ran_out_ = RanOut{step_, camera};
  calm_frames_ = 0;
  ++step_;
  if (of(asked) != before) return true;
  --step_;
  return false;
}

void ViewFit::settled(double used, const Distances& asked, const world::WorldPos& camera) {
  if (step_ == 0) return;
  calm_frames_ = used < kRoomy ? calm_frames_ + 1 : 0;
  if (calm_frames_ < kCalmFrames) return;
  if (ran_out_ && step_ - 1 <= ran_out_->step) {
    const double gone = glm::length(world::difference_blocks(camera, ran_out_->camera));
    if (gone < 0.25 * of(asked).view_blocks) return;
  }
  calm_frames_ = 0;
  --step_;
}

}  // namespace skerry::game
