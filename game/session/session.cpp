#include "game/session/session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/core/log.h"
#include "game/session/session_state.h"

namespace skerry::game {
namespace {

using world::BlockId;
using world::WorldFile;

constexpr std::int32_t kFarthestVoxel = 1
                                        << 20;  // as far from its middle as an island may be built

bool may_write(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  return ::access(path.c_str(), W_OK) == 0 && ::access(folder.c_str(), W_OK) == 0;
}

/// From a place in the lattice to the nearest point of a voxel.
double distance_to(const world::IVec3& voxel, const glm::dvec3& place) {
  const glm::dvec3 low{voxel.x, voxel.y, voxel.z};
  return glm::distance(place, glm::clamp(place, low, low + 1.0));
}

}  // namespace

Session::State::State(std::shared_ptr<world::World> opened)
    : world(std::move(opened)),
      motion(*world, [this](std::uint64_t island) { return shape_for(island); }),
      saved_at(std::chrono::steady_clock::now()) {
  motion.report_to(&moves);
}

Session::State::~State() {
  leaving = true;
}

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}

Session::~Session() {
  // What cannot be saved now has been reported before, or no client is left to receive it.
  static_cast<void>(save());
  saved_when_interrupted_.reset();
}

Result<std::unique_ptr<Session>> Session::open(const std::filesystem::path& path) {
  const bool writable = may_write(path);
  auto file = WorldFile::open(path, writable ? WorldFile::Mode::kWrite : WorldFile::Mode::kRead);
  if (!file) return file.error();
  world::LoadedWorld loaded = world::load_world(**file);
  auto state = std::make_unique<State>(std::move(loaded.world));
  state->file = *std::move(file);
  state->read_only = !writable;
  state->load(loaded);
  std::unique_ptr<Session> session(new Session(std::move(state)));
  if (writable)
    session->saved_when_interrupted_ = std::make_unique<DoneWhenInterrupted>([&one = *session] {
      const Result<void> saved = one.save();
      if (!saved) log_error(saved.error().message);
      return static_cast<bool>(saved);
    });
  return session;
}

std::unique_ptr<Session> Session::play(std::shared_ptr<world::World> world, double time_s) {
  auto state = std::make_unique<State>(std::move(world));
  state->time_s = time_s;
  state->motion.start(time_s);
  return std::unique_ptr<Session>(new Session(std::move(state)));
}

std::shared_ptr<world::World> Session::world() const {
  return state_->world;
}
ClientId Session::connect() {
  auto client = std::make_shared<Client>();
  for (const std::string& notice : state_->notices) client->answers.put(Notice{notice});
  const std::lock_guard lock(state_->clients_mutex);
  const ClientId id = ++state_->last_client;
  state_->clients.emplace(id, std::move(client));
  return id;
}

void Session::disconnect(ClientId client) {
  const std::lock_guard lock(state_->clients_mutex);
  state_->clients.erase(client);
}

void Session::send(ClientId client, Request request) {
  state_->requests.put({client, std::move(request)});
}

std::vector<Answer> Session::receive(ClientId client) {
  const std::shared_ptr<Client> found = state_->find(client);
  return found ? found->answers.take() : std::vector<Answer>();
}

void Session::attend() {
  const std::lock_guard lock(state_->running);
  state_->handle_sent();
}

void Session::advance(double seconds) {
  State& s = *state_;
  const std::lock_guard lock(s.running);
  s.handle_sent();
  s.time_s += seconds;
  const double more_edits = std::max(0.0, seconds) * kEditsPerSecond;
  for (const std::shared_ptr<Client>& client : s.everyone())
    client->edits_left = std::min(kEditBurst, client->edits_left + more_edits);
  s.take_in_pieces();
  s.motion.advance_to(s.time_s);
  s.tell_moves();
  if (seconds != 0.0)
    for (const std::shared_ptr<Client>& client : s.joined()) client->answers.put(TimeIs{s.time_s});
  s.save_soon();
}

std::shared_ptr<Session::Client> Session::State::find(ClientId client) const {
  const std::lock_guard lock(clients_mutex);
  const auto found = clients.find(client);
  return found == clients.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<Session::Client>> Session::State::everyone() const {
  const std::lock_guard lock(clients_mutex);
  std::vector<std::shared_ptr<Client>> all;
  for (const auto& [id, client] : clients) all.push_back(client);
  return all;
}

/// Session thread, or with `breaking` held.
std::vector<std::shared_ptr<Session::Client>> Session::State::joined() const {
  std::vector<std::shared_ptr<Client>> found = everyone();
  std::erase_if(found, [](const std::shared_ptr<Client>& client) { return !client->joined; });
  return found;
}

void Session::State::tell_all(const std::string& text) {
  for (const std::shared_ptr<Client>& client : everyone()) client->answers.put(Notice{text});
}

void Session::State::handle_sent() {
  for (const auto& [id, request] : requests.take())
    if (const std::shared_ptr<Client> client = find(id)) handle(*client, request);
}

void Session::State::handle(Client& client, const Request& request) {
  struct Handler {
    State& s;
    Client& client;
    void operator()(const Join& join) { s.join(client, join); }
    void operator()(const ChunkWanted& wanted) {
      s.tell_chunk(client, {wanted.island, wanted.chunk});
    }
    void operator()(const Edit& edit) { s.edit(client, edit); }
    void operator()(const PlayerMoved& moved) { s.moved(client, moved.play); }
    void operator()(const Steer& steer) { s.steer(client, steer); }
    void operator()(const KeepJournal& keep) { s.keep(client, keep.journal); }
  };
  if (client.joined || std::holds_alternative<Join>(request))
    std::visit(Handler{*this, client}, request);
}

void Session::State::moved(Client& client, const SavedPlay& play) {
  client.play = play;
  plays.insert_or_assign(client.player, play);
}

void Session::State::steer(const Client& client, const Steer& steer) {
  const auto finite = [](double v) { return std::isfinite(v); };
  if (!finite(steer.thrust.x) || !finite(steer.thrust.y) || !finite(steer.thrust.z) ||
      !finite(steer.turn))
    return;
  // Engines are set by who stands on the island; who fell off may switch them off.
  const bool off = steer.thrust == glm::dvec3{} && steer.turn == 0.0;
  if (off || (client.play && client.play->player.island == steer.island))
    motion.steer(steer.island, steer.thrust, steer.turn);
}

void Session::State::keep(const Client& client, const Journal& journal) {
  if (!fits_file(journal)) return;
  auto changed = std::make_shared<Journals>(*journals);
  changed->insert_or_assign(client.player, journal);
  journals = std::move(changed);
}

/// Why a Join cannot be accepted; empty: it can.
std::string Session::State::refusal_of(const Join& join) const {
  if (join.player.size() > kMaxPlayerBytes)
    return fmt::format("a player's name has at most {} bytes, this one has {}", kMaxPlayerBytes,
                       join.player.size());
  for (const std::shared_ptr<Client>& other : joined())
    if (other->player == join.player)
      return fmt::format("the player '{}' is in this world already", join.player);
  if (!plays.contains(join.player) && plays.size() >= kMaxPlayers)
    return fmt::format("this world keeps the places of {} players and takes no more", kMaxPlayers);
  return {};
}

void Session::State::join(Client& client, const Join& join) {
  if (client.joined) return;
  if (std::string why = refusal_of(join); !why.empty()) {
    client.answers.put(Notice{std::move(why)});
    return;
  }
  client.player = join.player;
  if (const auto saved = plays.find(join.player); saved != plays.end()) client.play = saved->second;
  // Nothing breaks between what is listed here and what is sent from now on.
  const std::lock_guard lock(breaking);
  client.joined = true;
  client.gets_voxels = !join.shares_world;
  Joined answer;
  answer.play = client.play;
  if (const auto kept = journals->find(join.player); kept != journals->end())
    answer.journal = kept->second;
  answer.read_only = read_only;
  if (file) answer.world = file->info();
  if (!file) answer.world.desc = world->desc();
  const std::vector<std::uint64_t> islands = world->changed_islands();
  for (const std::uint64_t id : islands)
    for (const world::IVec3& chunk :
         world->is_added(id) ? world->chunks(id, 0) : world->edited_chunks(id))
      answer.changed.push_back({id, chunk});
  client.answers.put(std::move(answer));
  client.answers.put(TimeIs{time_s});
  for (const std::uint64_t id : islands) introduce(client, id);
  client.answers.put(IslandsMoved{motion.states()});
}

/// Names an island that differs from what the seed makes, once. With `breaking` held.
void Session::State::introduce(Client& client, std::uint64_t island) {
  if (!client.introduced.insert(island).second) return;
  if (const std::optional<world::IslandSpec> spec = world->island(island))
    client.answers.put(IslandIs{*spec, world->is_added(island)});
}

void Session::State::tell_moves() {
  const IslandsMoved answer{std::exchange(moves, {})};
  if (answer.moves.empty()) return;
  const std::lock_guard lock(breaking);
  for (const std::shared_ptr<Client>& client : joined()) {
    for (const world::MovingIsland& move : answer.moves) introduce(*client, move.island);
    client->answers.put(answer);
  }
}

void Session::State::tell_chunk(Client& client, const world::ChunkName& name) {
  const std::lock_guard lock(breaking);
  client.answers.put(ChunkChanges{name.island, name.chunk, changes_of(name)});
}

/// Of an island that no seed made, all its blocks.
world::ChunkEdits Session::State::changes_of(const world::ChunkName& name) {
  if (!world->is_added(name.island)) return world->edits(name.island, name.chunk);
  std::vector<BlockId> blocks(world::kChunkVoxels);
  world->chunk_now(name.island, name.chunk).unpack(blocks);
  world::ChunkEdits all;
  for (std::uint32_t i = 0; i < world::kChunkVoxels; ++i)
    if (blocks[i] != world::kAir) all.push_back({i, blocks[i]});
  return all;
}

EditVerdict Session::State::verdict(const Client& client, const Edit& edit, BlockId& was) {
  const world::IVec3& v = edit.voxel;
  if (edit.block >= world::block::kBuiltInCount) return EditVerdict::kNoSuchBlock;
  if (std::max({std::abs(std::int64_t{v.x}), std::abs(std::int64_t{v.y}),
                std::abs(std::int64_t{v.z})}) >= kFarthestVoxel)
    return EditVerdict::kTooFar;
  const std::optional<world::Pose> pose = world->pose(edit.island, time_s);
  if (!pose) return EditVerdict::kNoSuchIsland;
  if (!client.play) return EditVerdict::kTooFar;
  const glm::dvec3 eye = glm::conjugate(pose->rotation) *
                         world::difference_blocks(client.play->eye.position, pose->origin);
  if (!(distance_to(v, eye) <= kSessionReach)) return EditVerdict::kTooFar;
  const std::optional<BlockId> there = world->block_at(edit.island, v);
  if (!there) return EditVerdict::kUnknown;
  was = *there;
  if (edit.block == world::kAir && was == world::kAir) return EditVerdict::kEmpty;
  if (world::is_solid(was) && world::is_solid(edit.block)) return EditVerdict::kOccupied;
  if (client.edits_left < 1.0) return EditVerdict::kTooFast;
  return EditVerdict::kDone;
}

void Session::State::edit(Client& client, const Edit& edit) {
  EditAnswer answer{edit, EditVerdict::kDone, world::kAir};
  // While voxels go from one island to another, it is undecided which of them holds this one.
  const std::lock_guard lock(breaking);
  answer.verdict = verdict(client, edit, answer.was);
  if (answer.verdict == EditVerdict::kDone) {
    client.edits_left -= 1.0;
    world->set_block(edit.island, edit.voxel, edit.block);
    ++edits_made;
    {
      const std::lock_guard unsaved_lock(unsaved_mutex);
      unsaved.chunks.insert({edit.island, world::chunk_of(edit.voxel)});
    }
    forward(client, edit);
    follow_edit(edit, answer.was);
  }
  client.answers.put(answer);
}

/// Sends an edit to the other clients. With `breaking` held.
void Session::State::forward(const Client& from, const Edit& edit) {
  const auto index = static_cast<std::uint32_t>(world::index_in_chunk(edit.voxel));
  for (const std::shared_ptr<Client>& client : joined()) {
    if (client.get() == &from || !client->gets_voxels) continue;
    introduce(*client, edit.island);
    client->answers.put(
        ChunkChanges{edit.island, world::chunk_of(edit.voxel), {{index, edit.block}}});
  }
}

}  // namespace skerry::game
