#include "game/client/session_client.h"

#include <utility>

#include "game/client/island_name.h"
#include "game/words/words.h"

namespace skerry::game {

SessionClient::SessionClient(std::unique_ptr<Session> session)
    : session_(std::move(session)), id_(session_->connect()) {
  session_->send(id_, Join{"", true});
  session_->attend();
  take_in();
}

bool SessionClient::set_block(std::uint64_t island, world::IVec3 voxel, world::BlockId block) {
  session_->send(id_, Edit{island, voxel, block});
  session_->attend();
  take_in();
  return verdict_ == EditVerdict::kDone;
}

void SessionClient::advance(double seconds) {
  session_->advance(seconds);
  take_in();
}

std::vector<Answer> SessionClient::hear() {
  return std::exchange(heard_, {});
}

void SessionClient::note_waiting(const IslandsMoved& moved) {
  for (const world::MovingIsland& move : moved.moves) {
    if (move.waits)
      waiting_.insert(move.island);
    else
      waiting_.erase(move.island);
  }
}

void SessionClient::take_in() {
  for (Answer& answer : session_->receive(id_)) {
    if (auto* joined = std::get_if<Joined>(&answer)) {
      joined_ = std::move(*joined);
    } else if (const auto* time = std::get_if<TimeIs>(&answer)) {
      time_s_ = time->world_time_s;
    } else if (const auto* edited = std::get_if<EditAnswer>(&answer)) {
      verdict_ = edited->verdict;
      if (verdict_ == EditVerdict::kDone) edits_.push_back(*edited);
    } else {
      if (const auto* moved = std::get_if<IslandsMoved>(&answer)) note_waiting(*moved);
      heard_.push_back(std::move(answer));
    }
  }
}

std::optional<std::string> line_of(const Answer& answer) {
  if (const auto* notice = std::get_if<Notice>(&answer)) return notice->text;
  if (const auto* island = std::get_if<IslandIs>(&answer); island && island->blocks > 1)
    return tr_format("{} blocks broke off and drift away: {}, an island of its own", island->blocks,
                     island_name(island->spec.id));
  return std::nullopt;
}

}  // namespace skerry::game
