#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "game/session/session.h"

namespace skerry::game {

/// One client of a session, which others may share.
class Seat {
 public:
  /// Connects; joins if it is told as whom.
  explicit Seat(std::shared_ptr<Session> session, const std::optional<Join>& join = Join{})
      : session_(std::move(session)), id_(session_->connect()) {
    if (!join) return;
    send(*join);
    session_->attend();
    for (Answer& answer : session_->receive(id_)) {
      if (auto* joined = std::get_if<Joined>(&answer)) joined_ = std::move(*joined);
      if (std::holds_alternative<Notice>(answer)) notices_.push_back(std::move(answer));
    }
  }
  ~Seat() { session_->disconnect(id_); }
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;

  const std::optional<Joined>& joined() const { return joined_; }
  const std::shared_ptr<Session>& session() const { return session_; }
  std::shared_ptr<world::World> world() const { return session_->world(); }
  void send(Request request) { session_->send(id_, std::move(request)); }
  /// Notices from before the Join come first.
  std::vector<Answer> receive() {
    std::vector<Answer> all = std::exchange(notices_, {});
    for (Answer& answer : session_->receive(id_)) all.push_back(std::move(answer));
    return all;
  }
  void attend() { session_->attend(); }
  void advance(double seconds) { session_->advance(seconds); }
  void rest() { session_->rest(); }
  void save_next() { session_->save_next(); }
  Result<void> save() { return session_->save(); }

 private:
  std::shared_ptr<Session> session_;
  ClientId id_;
  std::optional<Joined> joined_;
  std::vector<Answer> notices_;
};

}  // namespace skerry::game
