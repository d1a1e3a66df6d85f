#pragma once
#include "game/edit_history.h"
#include "game/session.h"

namespace skerry::game {

/// Edits as a client asks its session for them.
class SessionEditor : public BlockEditor {
 public:
  /// @param session outlives this.
  explicit SessionEditor(Session& session) : session_(session) {}
  bool set_block(std::uint64_t island, world::IVec3 voxel, world::BlockId block) override {
    return session_.request({island, voxel, block}).verdict == EditVerdict::kDone;
  }

 private:
  Session& session_;
};

}  // namespace skerry::game
