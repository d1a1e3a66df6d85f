#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "game/player/edit_history.h"
#include "game/session/session.h"

namespace skerry::game {

/// The client's end of a session that runs in this process: asks by messages, keeps the
/// answers, and lets the session's time go on. One thread.
class SessionClient : public BlockEditor {
 public:
  /// Joins as the one player of the world.
  explicit SessionClient(std::unique_ptr<Session> session);

  const Joined& joined() const { return joined_; }
  /// As the session said last.
  double time_s() const { return time_s_; }
  /// Session::world(): what messages say of islands is applied there already.
  std::shared_ptr<world::World> world() const { return session_->world(); }

  /// See world::MovingIsland::waits.
  bool waits(std::uint64_t island) const { return waiting_.contains(island); }

  void send(Request request) { session_->send(id_, std::move(request)); }
  /// Asks for an edit and receives the answer at once, so that this frame's picture can show it.
  bool set_block(std::uint64_t island, world::IVec3 voxel, world::BlockId block) override;
  /// See Session.
  void advance(double seconds);
  void rest() { advance(0.0); }
  void save_next() { session_->save_next(); }
  Result<void> save() { return session_->save(); }

  /// Edits of this client that were done since the last call.
  std::vector<EditAnswer> take_edits() { return std::exchange(edits_, {}); }
  /// Messages since the last call, besides what the members above say.
  std::vector<Answer> hear();

 private:
  void take_in();
  void note_waiting(const IslandsMoved& moved);

  std::unique_ptr<Session> session_;
  ClientId id_;
  Joined joined_;
  double time_s_ = 0.0;
  std::set<std::uint64_t> waiting_;           // islands
  EditVerdict verdict_ = EditVerdict::kDone;  // of the last edit
  std::vector<EditAnswer> edits_;
  std::vector<Answer> heard_;
};

/// What the player is told of an answer. None: nothing.
std::optional<std::string> line_of(const Answer& answer);

}  // namespace skerry::game
