#include "engine/platform/input.h"

namespace skerry::platform {

void Input::set_key(Key key, bool down) {
  const std::size_t i = InputFrame::index(key);
  if (down == frame_.down_[i]) return;  // key repeat
  frame_.down_[i] = down;
  (down ? frame_.pressed_ : frame_.released_)[i] = true;
}

void Input::move_pointer(glm::dvec2 place) {
  if (pointer_known_) frame_.mouse_delta += place - pointer_;
  pointer_ = place;
  pointer_known_ = true;
}

void Input::lose_focus() {
  frame_.released_ |= frame_.down_;
  frame_.down_.reset();
  forget_pointer();
}

InputFrame Input::take() {
  const InputFrame taken = frame_;
  frame_ = {};
  frame_.down_ = taken.down_;
  return taken;
}

}  // namespace skerry::platform
