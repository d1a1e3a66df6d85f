// What screens ask for: worlds begin and end, settings are kept.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <random>

#include "engine/core/log.h"
#include "engine/gpu/transfer/readback.h"
#include "engine/platform/files.h"
#include "engine/platform/image_file.h"
#include "game/client/app.h"
#include "game/client/island_name.h"
#include "game/client/preferences.h"
#include "game/worlds/gallery.h"
#include "game/worlds/open_session.h"
#include "game/worlds/open_world.h"
#include "world/store/world_file.h"

namespace skerry::game {
namespace {

using ui::Screen;

constexpr double kPreviewDelay = 0.5;  // seconds after the last letter of a seed
constexpr const char* kTitleSeed = "skerry";
constexpr std::uint32_t kBackdropView = 300;  // blocks

std::uint64_t entropy() {
  std::random_device source;
  return (std::uint64_t{source()} << 32) | source();
}

Result<std::unique_ptr<Session>> open_file(const std::string& path) {
  SceneOptions options;
  options.world = path;
  return open_session(options);
}

}  // namespace

void App::say(std::string line) {
  log_warning(line);
  messages_.say(std::move(line));
}

Result<void> App::fulfil(const ui::Wishes& wishes) {
  if (wishes.settings_changed) {
    settings_changed_ = true;
    fresh_frames_ = kMeasuringFrames;
    follow_settings();
  }
  bindings_changed_ |= wishes.bindings_changed;
  if (wishes.photograph) world_->want_screenshot();
  if (wishes.take) world_->hotbar().take(*wishes.take);
  if (world_) world_->fulfil(wishes.map);
  if (wishes.draw_name) draw_name();
  if (wishes.draw_lots) draw_lots();
  if (wishes.preview || wishes.draw_lots) preview_due_s_ = kPreviewDelay;
  if (wishes.remove) {
    if (const auto removed = remove_world(*wishes.remove); !removed) say(removed.error().message);
    screens_.chosen_world.reset();
    list_again();
  }
  if (wishes.create) return create_world(*wishes.create);
  if (wishes.play) return play_as_left(*wishes.play, open_file(*wishes.play));
  if (wishes.quit) window_.close();  // run() saves, and opens it again if that fails
  if (wishes.enter) return enter_picture(*wishes.enter);
  if (!wishes.leave_world && !wishes.leave_unsaved) return {};
  if (!wishes.leave_unsaved && !save_world()) return {};
  return to_title();
}

Result<void> App::to_title() {
  leave_world();
  list_again();
  screens_.stack.clear();
  open(Screen::kTitle);
  return set_backdrop(Backdrop::View::kAround, "");
}

void App::list_gallery() {
  gallery_.clear();
  pictures_read_ = 0;
  for (const std::filesystem::path& path : list_pictures(pictures_dir())) {
    if (gallery_.size() == static_cast<std::size_t>(ui::Pictures::kThumbnails)) break;
    gallery_.push_back({path.string(), path.stem().string(), -1, {}});
    gui_.expect(gallery_.back().name);
  }
}

/// One a frame: a large picture takes tens of milliseconds.
void App::read_next_picture() {
  if (pictures_read_ >= gallery_.size()) return;
  ui::PictureCard& card = gallery_[pictures_read_];
  const int slot = static_cast<int>(pictures_read_++);
  const auto image = platform::read_png(card.path);
  if (!image) {
    card.problem = image.error().message;
    return;
  }
  pictures_.set_thumbnail(slot, ui::thumbnail_of(static_cast<int>(image->width),
                                                 static_cast<int>(image->height), image->pixels));
  card.thumbnail = slot;
  if (const auto place = place_of_picture(image->text); !place)
    card.problem = place.error().message;
}

/// Leaves what is played for the place where a picture was taken.
Result<void> App::enter_picture(const std::string& path) {
  const auto image = platform::read_png(path);
  auto there = image ? place_of_picture(image->text) : Result<SceneOptions>(image.error());
  if (!there) {
    say(there.error().message);
    return {};
  }
  if (!save_world()) return {};
  leave_world();
  SceneOptions options = at_place(base_, *there);
  auto session = open_session(options);
  if (!session) {
    say(session.error().message);
    return to_title();
  }
  auto client = std::make_unique<SessionClient>(*std::move(session));
  if (!options.world) client->advance(options.settings.world_time_s - client->time_s());
  options.settings.world_time_s = client->time_s();
  // A saved world has gone on since.
  if (const auto view = island_view_of(image->text); view && options.world && options.camera) {
    world::World& world = *client->world();
    (void)world.islands_near(options.camera->position, 2.0 * world::kMaxIslandDriftBlocks,
                             client->time_s());  // makes the island known
    if (const auto pose = world.pose(view->island, client->time_s()))
      options.camera = seen_in_world(*view, *pose);
  }
  return play(options, std::move(client));
}

Result<void> App::set_backdrop(Backdrop::View view, const std::string& seed_text) {
  SceneOptions options = base_;
  // Of a world that was named on the command line nothing belongs behind the screens.
  options.world.reset();
  options.camera.reset();
  options.settings.world_time_s = 0.0;
  options.seed_text = seed_text.empty() ? kTitleSeed : seed_text;
  options.settings.view_distance = std::min(options.settings.view_distance, kBackdropView);
  backdrop_.reset();  // two at a time would need twice the memory
  auto made = Backdrop::create(device_, options, view);
  if (!made && !seed_text.empty()) {
    say(made.error().message);
    return set_backdrop(Backdrop::View::kAround, "");
  }
  if (!made) return made.error();
  backdrop_ = *std::move(made);
  first_frames_until_s_.reset();
  if (view == Backdrop::View::kAround)  // previews follow what is typed at once
    first_frames_until_s_ = clock_.seconds() + kFirstFrames;
  return {};
}

void App::draw_lots() {
  ui::set_field(screens_.new_seed, ui::seed_from(entropy()));
}

void App::draw_name() {
  std::string name = island_name(entropy());
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  ui::set_field(screens_.new_name, name);
}

/// What the command line names, from where and when it says.
Result<void> App::play_as_asked() {
  auto session = open_session(base_);
  if (!session) return session.error();
  auto client = std::make_unique<SessionClient>(*std::move(session));
  if (client->time_s() != base_.settings.world_time_s)
    client->advance(base_.settings.world_time_s - client->time_s());
  return play(base_, std::move(client));
}

/// A world of the list, from where and when it was left.
Result<void> App::play_as_left(const std::string& path, Result<std::unique_ptr<Session>> session) {
  if (!session) {
    say(session.error().message);
    list_again();
    return {};
  }
  auto client = std::make_unique<SessionClient>(*std::move(session));
  const SavedPlay left = client->joined().play.value_or(SavedPlay{});
  SceneOptions options = base_;
  options.world = path;
  options.seed_text = client->joined().world.seed_text;
  options.camera.reset();
  if (client->joined().play) options.camera = left.eye;
  options.time_of_day_s = static_cast<int>(left.time_of_day_s);
  options.settings.world_time_s = client->time_s();
  return play(options, std::move(client));
}

Result<void> App::play(const SceneOptions& asked, std::unique_ptr<SessionClient> session) {
  backdrop_.reset();
  SceneOptions options = asked;
  begin_quality(options, options.settings);
  auto view = SceneView::create(device_, options, session->world());
  if (!view) return view.error();
  (*view)->renderer().foresee_programs();
  world_path_ = options.world;
  const world::WorldInfo& info = session->joined().world;
  for (const std::string* shown : {&info.name, &info.seed_text, &asked.seed_text})
    gui_.expect(*shown);
  world_ = std::make_unique<PlayLoop>(Machine{window_, device_, *presenter_}, bindings_, options,
                                      std::move(session), *std::move(view));
  costs_ = {};
  first_frames_until_s_ = clock_.seconds() + kFirstFrames;
  world_began_s_ = clock_.seconds();
  screens_.stack.clear();
  return {};
}

/// @return whether there is nothing left to save; else the player is asked what to do.
bool App::save_world() {
  if (!world_) return true;
  const Result<void> saved = world_->save();
  if (saved) return true;
  log_warning(saved.error().message);
  if (screens_.stack.top() != Screen::kPause) {
    screens_.stack.clear();
    open(Screen::kPause);
  }
  screens_.unsaved = saved.error().message;
  return false;
}

void App::leave_world() {
  if (!world_) return;
  keep_picture();
  if (const auto kept = auto_quality_.keep(); !kept) say(kept.error().message);
  world_.reset();
  world_path_.reset();
  costs_ = {};
  window_.set_title("Skerry");
}

/// The last picture, small, beside the world's file: for the list.
void App::keep_picture() {
  if (!world_path_) return;
  gpu::Image& picture = world_->view().renderer().picture();
  const auto pixels = gpu::read_back(device_, picture, 4);
  if (!pixels) return say(pixels.error().message);
  const VkExtent2D size = picture.desc().extent;
  const ui::Rgba small =
      ui::thumbnail_of(static_cast<int>(size.width), static_cast<int>(size.height),
                       {reinterpret_cast<const std::uint8_t*>(pixels->data()), pixels->size()});
  const auto written = platform::write_png(
      picture_of_world(*world_path_), {static_cast<std::uint32_t>(small.width),
                                       static_cast<std::uint32_t>(small.height), 4, small.pixels});
  if (!written) say(written.error().message);
}

/// What the player has set is of every world from now on.
void App::follow_settings() {
  SceneOptions& scene = world_ ? world_->scene() : base_;
  Settings& settings = world_ ? world_->settings() : base_.settings;
  if (!std::exchange(auto_before_, scene.quality_auto) && scene.quality_auto) {
    scene.pinned.clear();
    begin_quality(scene, settings);
  }
  auto_quality_.pin(settings, scene);
  if (!world_) {
    backdrop_->view().settings() = base_.settings;
    return;
  }
  base_.quality = world_->scene().quality;
  base_.quality_auto = world_->scene().quality_auto;
  base_.pinned = world_->scene().pinned;
  base_.fov_deg = world_->scene().fov_deg;
  take_preferences(world_->settings(), base_.settings);
}

void App::keep_settings() {
  if (std::exchange(settings_changed_, false))
    if (const auto saved = save_preferences(preferences_path(), base_); !saved)
      say(saved.error().message);
  if (hints_.take_changed())
    if (const auto saved = save_hints(hints_path(), hints_); !saved) say(saved.error().message);
  if (std::exchange(bindings_changed_, false))
    if (const auto saved = save_bindings(bindings_path(), bindings_); !saved)
      say(saved.error().message);
}

Result<void> App::create_world(const ui::Wishes::NewWorld& wanted) {
  world::WorldInfo info;
  info.name = wanted.name.empty() ? ui::pasted_text("World " + wanted.seed_text, ui::kMaxNameBytes)
                                  : wanted.name;
  info.seed_text = wanted.seed_text;
  info.desc.seed = world::seed_from_text(wanted.seed_text);
  const std::filesystem::path path = new_world_path(info.name);
  return play_as_left(path.string(), create_session(path, info));
}

void App::list_again() {
  cards_.clear();
  int slot = 0;
  for (const WorldEntry& entry : list_worlds(worlds_dir())) {
    ui::WorldCard card{entry.path.string(), entry.name, entry.seed_text, entry.played_s,
                       entry.bytes,         -1,         entry.problem};
    if (slot < ui::Pictures::kThumbnails) {
      const auto image = platform::read_png(picture_of_world(entry.path));
      if (image) {
        pictures_.set_thumbnail(
            slot, ui::thumbnail_of(static_cast<int>(image->width), static_cast<int>(image->height),
                                   image->pixels));
        card.thumbnail = slot++;
      }
    }
    for (const std::string* shown : {&card.name, &card.seed_text, &card.problem})
      gui_.expect(*shown);
    cards_.push_back(std::move(card));
  }
}

}  // namespace skerry::game
