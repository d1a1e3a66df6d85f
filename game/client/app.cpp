#include "game/client/app.h"

#include <imgui.h>
#include <skerry_version.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>
#include <utility>

#include "engine/core/log.h"
#include "game/client/preferences.h"
#include "game/pace/learnt_costs.h"
#include "game/ui/look.h"
#include "game/words/words.h"

namespace skerry::game {
namespace {

using ui::Screen;

constexpr double kIdleWait = 0.05;  // seconds between looks at a window that shows nothing
constexpr double kScreensShare =
    5.0;  // times what the world behind takes, for the screen before it
constexpr double kBehindScreens = 1.0 / 30.0;  // seconds, the fewest, between frames of the world
                                               // behind a screen
constexpr double kMapSpeed = 1.0;              // radii a second
constexpr double kUnfocusedUntilPause = 0.3;   // seconds
constexpr double kPatience = 0.5;  // seconds without a picture until it is said what is done
constexpr double kPatienceWithPrograms = 1.5;  // the same, of what a start takes without a GPU
constexpr double kLoadingFrame = 1.0 / 30.0;   // seconds

ui::Clipboard clipboard_of(platform::Window& window) {
  return {[&window] { return window.clipboard(); },
          [&window](const std::string& text) { window.set_clipboard(text); }};
}

/// Screens under which the world goes on.
bool world_goes_on(const ui::ScreenStack& stack) {
  return stack.empty() || stack.top() == Screen::kPalette || stack.top() == Screen::kMap;
}

}  // namespace

App::App(platform::Window& window, gpu::Device& device, const SceneOptions& options,
         const std::vector<std::string>& notes)
    : window_(window),
      device_(device),
      base_(options),
      gui_(clipboard_of(window)),
      auto_quality_(device.info(), learnt_costs_path()),
      auto_before_(options.quality_auto) {
  follow_language();  // the first frame may say something before it is drawn
  for (const std::string& note : notes) messages_.say(note);
  ReadBindings read = load_bindings(bindings_path());
  for (std::string& problem : read.problems) say(std::move(problem));
  bindings_ = std::move(read.bindings);
  hints_ = load_hints(hints_path());
}

Result<void> App::start(VkSurfaceKHR surface, bool at_title) {
  const ui::PictureView pictures{ui::Pictures::kWidth, ui::Pictures::kHeight, pictures_.pixels()};
  auto presenter = Presenter::create(device_, surface, {gui_.font(), pictures});
  if (!presenter) return presenter.error();
  presenter_ = *std::move(presenter);
  pictures_shown_ = pictures_.version();
  begin_quality(base_, base_.settings);
  if (!at_title) return play_as_asked();
  list_again();
  open(Screen::kTitle);
  if (const auto shown = show_title_alone(); !shown) return shown;
  return set_backdrop(Backdrop::View::kAround, "");
}

Result<void> App::run() {
  began_s_ = clock_.seconds();
  bool drawn = true;
  for (;;) {
    if (window_.should_close()) {
      keep_settings();
      if (save_world()) break;
      window_.stay_open();
    }
    if (drawn && !still_) wait_until_due();
    const platform::InputFrame input = held_back_.filtered(window_.poll(!drawn   ? kIdleWait
                                                                        : still_ ? still_wait_s()
                                                                                 : 0.0));
    const double before_s = std::exchange(began_s_, clock_.seconds());
    began_thread_s_ = thread_seconds();
    const Result<bool> done = frame(input, began_s_ - before_s);
    if (!done) return done.error();
    drawn = *done;
    choose_quality(drawn);
  }
  leave_world();
  return {};
}

void App::open(Screen screen) {
  screens_.stack.open(screen);
  screens_.fresh = true;
}

Result<bool> App::frame(const platform::InputFrame& input, double seconds) {
  const std::optional<Screen> before = screens_.stack.top();
  const bool listened = screens_.listening.has_value();
  if (world_) world_->note_frame(seconds);
  act(input, std::min(seconds, kLongestFrame));
  const auto layout = [&](VkExtent2D size) { return lay_out(size, input, seconds); };
  if (const auto done = show_new_images(input); !done) return done.error();
  wishes_ = {};
  const Result<bool> drawn = draw(seconds, layout);
  if (!drawn) return drawn;
  if (const auto done = fulfil(wishes_); !done) return done.error();
  sound(std::min(seconds, kLongestFrame));
  // What was held while one thing was shown shall not act on the next, nor what was bound just now.
  if (listened && !screens_.listening) held_back_.hold(input);
  if (screens_.stack.top() == Screen::kGallery) read_next_picture();
  if (screens_.stack.top() == before) return drawn;
  if (screens_.stack.top() == Screen::kGallery) list_gallery();
  if (before == Screen::kGallery && !world_) list_again();  // thumbnails share their slots
  fresh_frames_ = std::max(fresh_frames_, kSettlingFrames);
  held_back_.hold(input);
  keep_settings();
  if (screens_.stack.top() == Screen::kNewWorld) {
    draw_lots();
    preview_due_s_ = 0.0;
  } else if (before == Screen::kNewWorld && backdrop_) {
    preview_due_s_.reset();
    if (const auto done = set_backdrop(Backdrop::View::kAround, ""); !done) return done.error();
  }
  return drawn;
}

/// What is said from now on is in the player's language.
void App::follow_language() {
  const Settings& settings = world_ ? world_->settings() : base_.settings;
  const Language language = settings.ui.language.value_or(system_language_);
  if (std::exchange(language_, language) == language) return;
  speak(language);
  gui_.expect(words_of(language));
}

/// Brings pictures and glyphs to the device that it does not have yet.
Result<void> App::show_new_images(const platform::InputFrame& input) {
  follow_language();
  if (screens_.stack.top() == Screen::kSettings)
    for (const char* name : kLanguageNames) gui_.expect(name);
  gui_.expect(input);
  for (const ui::Messages::Line& message : messages_.lines()) gui_.expect(message.text);
  if (gui_.fit_font())
    if (const auto done = presenter_->set_font(gui_.font()); !done) return done;
  if (pictures_shown_ != pictures_.version()) {
    const ui::PictureView view{ui::Pictures::kWidth, ui::Pictures::kHeight, pictures_.pixels()};
    if (const auto done = presenter_->set_pictures(view); !done) return done.error();
    pictures_shown_ = pictures_.version();
  }
  return {};
}

void App::act(const platform::InputFrame& input, double seconds) {
  const ActionFrame actions(input, bindings_, seconds);
  if (actions.pressed(Action::kFullscreen) && !gui_.typing()) window_.toggle_fullscreen();
  if (world_ && screens_.stack.empty()) hints_.note(actions, seconds, world_->on_foot());
  act_on_screens(input, actions);
  pause_unattended(seconds);
  messages_.pass(seconds);
  const bool flies = screens_.stack.top() == Screen::kPhoto && photo_settings_.bare;
  window_.capture_pointer(world_ && (screens_.stack.empty() || flies) && window_.focused());
  if (!world_) return;
  if (screens_.stack.empty())
    world_->act(input, seconds);
  else if (world_goes_on(screens_.stack))
    world_->act({}, seconds);
  else
    world_->rest(seconds);
  const bool was_photo = std::exchange(in_photo_, screens_.stack.top() == Screen::kPhoto);
  if (in_photo_ && !was_photo) {
    photo_.start_at(*world_->scene().camera);
    photo_settings_ = {world_->day().time_of_day_s(), std::nullopt, world_->scene().fov_deg, false};
  }
  // The key that opened it means nothing in it.
  if (in_photo_)
    fly_photo_camera(input, was_photo ? actions : ActionFrame(), seconds);
  else
    world_->set_photo(std::nullopt);
  if (screens_.stack.top() == Screen::kMap) {
    if (!gui_.typing()) move_map(input, seconds);
    if (const auto picture = world_->take_map(
            ui::kMapRadii[static_cast<std::size_t>(screens_.map_radius)], screens_.map_shift))
      pictures_.set_map(*picture);
    map_ = world_->map_facts();
  } else {
    screens_.map_shift = {};
  }
  for (std::string& line : world_->take_messages()) messages_.say(std::move(line));
  if (!world_->take_settings_changed()) return;
  settings_changed_ = true;
  follow_settings();
}

/// Hands what is heard of this frame to the threads that make sound.
void App::sound(double seconds) {
  SoundFrame frame;
  if (world_) {
    frame = world_->sound_frame(seconds);
    world_->set_sound_line(sound_.status());
  }
  frame.seconds = seconds;
  const Settings& settings = world_ ? world_->settings() : base_.settings;
  const SoundSettings& loud = settings.sound;
  frame.volumes = {loud.master, loud.effects, loud.ambience, loud.interface};
  const bool pressed = gui_.pressed();
  if ((pressed && !pressed_before_) || back_)
    frame.events.push_back({Sound::kClick, SoundMaterial::kStone, std::nullopt, 0.35f});
  pressed_before_ = pressed;
  sound_.frame(std::move(frame));
  for (std::string& line : sound_.take_captions())
    if (loud.captions) messages_.say(std::move(line));
}

void App::act_on_screens(const platform::InputFrame& input, const ActionFrame& actions) {
  back_ = false;
  if (screens_.stack.empty()) {
    screens_.unsaved.reset();
    if (actions.pressed(Action::kPause)) open(Screen::kPause);
    if (actions.pressed(Action::kPalette)) open(Screen::kPalette);
    if (actions.pressed(Action::kPhoto)) open(Screen::kPhoto);
    if (actions.pressed(Action::kMap)) open(Screen::kMap);
    if (actions.pressed(Action::kHideHud)) hud_hidden_ = !hud_hidden_;
    return;
  }
  back_ = ui::goes_back(screens_, input);
  if (!back_) return;
  if (std::exchange(photo_settings_.bare, false)) return;
  ui::go_back(screens_);
}

/// Who works in another window does not play in this one. A change of the window itself may take
/// the focus away for a moment.
void App::pause_unattended(double seconds) {
  attended_ |= window_.focused();
  unfocused_s_ = window_.focused() ? 0.0 : unfocused_s_ + seconds;
  if (!attended_ || unfocused_s_ < kUnfocusedUntilPause) return;
  attended_ = false;
  if (world_ && world_goes_on(screens_.stack)) open(Screen::kPause);
}

/// The keys that walk and the stick that looks move the map; its own key brings it back to the
/// player. The stick that walks goes through the buttons.
void App::move_map(const platform::InputFrame& input, double seconds) {
  Bindings bindings = bindings_;
  for (const Action walks : {Action::kForward, Action::kBack, Action::kLeft, Action::kRight})
    bindings[walks].pad = {};
  const ActionFrame actions(input, bindings, seconds);
  const auto axis = [&](Action plus, Action minus, Action more, Action less) {
    return actions.value(plus) + actions.value(more) - actions.value(minus) - actions.value(less);
  };
  const glm::dvec2 way{axis(Action::kRight, Action::kLeft, Action::kLookRight, Action::kLookLeft),
                       axis(Action::kBack, Action::kForward, Action::kLookDown, Action::kLookUp)};
  const double radius = ui::kMapRadii[static_cast<std::size_t>(screens_.map_radius)];
  ui::shift_map(screens_, way * (kMapSpeed * radius * seconds));
  if (actions.pressed(Action::kMap)) screens_.map_shift = {};
}

void App::fly_photo_camera(const platform::InputFrame& input, const ActionFrame& actions,
                           double seconds) {
  if (actions.pressed(Action::kHideHud) || actions.pressed(Action::kPhoto))
    photo_settings_.bare = !photo_settings_.bare;
  if (actions.pressed(Action::kScreenshot)) world_->want_screenshot();
  if (photo_settings_.bare) {
    const glm::dvec2 moved = window_.pointer_captured() ? input.mouse_delta : glm::dvec2(0.0);
    photo_.advance({&actions, &bindings_, moved, seconds}, photo_settings_.fov_deg);
  }
  world_->set_photo(PhotoView{photo_.place(), photo_settings_.fov_deg,
                              photo_settings_.time_of_day_s, photo_settings_.exposure_ev});
}

/// Whether the world is drawn anew. Behind a screen it stands still, or turns at leisure; then most
/// of the time goes to the screen, which answers at once on the slowest of devices.
bool App::world_is_due(double seconds) {
  since_drawn_s_ += seconds;
  if (world_ && (world_goes_on(screens_.stack) || screens_.stack.top() == Screen::kPhoto))
    return true;
  SceneView& view = world_ ? world_->view() : backdrop_->view();
  const auto& report = view.renderer().report();
  const VkExtent2D drawn = presenter_->extent();
  const platform::FramebufferSize window = window_.framebuffer_size();
  const bool resized = drawn.width != window.width || drawn.height != window.height;
  if (!report || resized || fresh_frames_ > 0 || costs_.measuring()) return true;
  if (world_ && view.complete()) return false;
  return since_drawn_s_ > std::max(kBehindScreens, kScreensShare * report->gpu_ms * 1e-3);
}

Result<bool> App::draw(double seconds, const PlayLoop::Layout& layout) {
  if (backdrop_) backdrop_->advance(std::min(seconds, kLongestFrame));
  if (preview_due_s_ && (*preview_due_s_ -= seconds) <= 0.0) {
    preview_due_s_.reset();
    if (const auto done = set_backdrop(Backdrop::View::kSpawn, screens_.new_seed.data()); !done)
      return done.error();
  }
  still_ = false;
  if (first_frames_until_s_) return draw_first_frames(layout);
  still_ = !world_is_due(seconds);
  if (still_) return show_again(layout);
  since_drawn_s_ = 0.0;
  fresh_frames_ = std::max(0, fresh_frames_ - 1);
  const Result<bool> drawn = world_ ? world_->draw(layout) : draw_backdrop(layout);
  SceneView& view = world_ ? world_->view() : backdrop_->view();
  // Behind a screen nothing else would draw what the settings have become.
  if (view.renderer().lagged()) fresh_frames_ = std::max(fresh_frames_, kSettlingFrames);
  if (const auto& report = view.renderer().report())
    costs_.note_frame(report->gpu_ms, view.complete() && !report->lagged);
  return drawn;
}

/// The first frames of a view, drawn pass by pass until all that belongs to it is there. Where
/// programs are compiled this takes seconds; from then on the player sees how far it is instead of
/// a world that stands still.
Result<bool> App::draw_first_frames(const PlayLoop::Layout& layout) {
  SceneView& view = world_ ? world_->view() : backdrop_->view();
  const Stopwatch watch;
  double next_s = kPatience;  // by the watch
  bool shown = false;
  Result<void> done;
  const auto show_progress = [&](std::uint32_t passed, std::uint32_t all) {
    window_.keep_answering();
    if (!done || watch.seconds() < next_s) return;
    if (!shown) window_.capture_pointer(false);
    done = show_loading(
        {passed, all, shown ? view.streamer().stats().tasks_left : 0, watch.seconds()});
    next_s = watch.seconds() + kLoadingFrame;
    shown = true;
  };
  // What the view's first call of stream() would wait for without a word.
  const auto make_programs = [&] {
    const auto all = static_cast<std::uint32_t>(view.renderer().programs_to_come());
    for (std::uint32_t made = 1; done && view.renderer().make_program(); ++made) {
      window_.keep_answering();
      if (watch.seconds() > kPatienceWithPrograms) show_progress(std::min(made, all), all);
    }
  };
  const auto draw_one = [&](VkExtent2D size) -> Result<void> {
    const int used = view.renderer().pipelines_created();
    const SceneView::Moment now = world_ ? world_->moment() : backdrop_->moment();
    if (!shown) {
      make_programs();
      next_s = watch.seconds() + kPatience;
    }
    if (!done) return done;
    if (auto in = view.stream(now); !in) return in;
    if (shown && !view.complete() && clock_.seconds() < *first_frames_until_s_) {
      // A frame of half of a view would need programs that no later one does.
      std::this_thread::sleep_for(std::chrono::duration<double>(kLoadingFrame));
      show_progress(1, 1);
      return done;
    }
    // Light is there some seconds later, and needs programs of its own.
    if (shown && view.settings().render.indirect != render::Indirect::kOff)
      (void)view.renderer().indirect();
    const Result<std::uint64_t> drawn = view.draw(now, size);
    if (!drawn) return drawn.error();
    const bool more = !view.complete() || view.renderer().pipelines_created() != used;
    if (!more || clock_.seconds() > *first_frames_until_s_) first_frames_until_s_.reset();
    return done;
  };
  view.renderer().step_frames(show_progress);
  Result<void> drawn;
  platform::FramebufferSize px = window_.framebuffer_size();
  do {
    if (px.width == 0 || px.height == 0) break;
    drawn = draw_one({px.width, px.height});
    px = window_.framebuffer_size();
  } while (drawn && shown && first_frames_until_s_ && !window_.should_close());
  view.renderer().step_frames({});
  if (!drawn) return drawn.error();
  if (shown) began_s_ = world_began_s_ = clock_.seconds();
  if (px.width == 0 || px.height == 0) return false;
  return show_again(layout);
}

/// The title before there is a world behind it: that takes longer.
Result<void> App::show_title_alone() {
  if (const auto done = show_new_images({}); !done) return done;
  const platform::FramebufferSize px = window_.framebuffer_size();
  const std::optional<gpu::SwapchainFrame> frame = presenter_->acquire({px.width, px.height});
  if (!frame) return {};
  return presenter_->show_alone(*frame, lay_out(presenter_->extent(), {}, kLoadingFrame));
}

Result<void> App::show_loading(const ui::LoadingFacts& facts) {
  const platform::FramebufferSize px = window_.framebuffer_size();
  const std::optional<gpu::SwapchainFrame> frame = presenter_->acquire({px.width, px.height});
  if (!frame) return {};
  const VkExtent2D size = presenter_->extent();
  const Settings& settings = world_ ? world_->settings() : base_.settings;
  gui_.begin({size.width, size.height, kLoadingFrame, nullptr, settings.ui.scale, true});
  ui::show_loading(facts);
  return presenter_->show_alone(*frame, gui_.end());
}

Result<bool> App::show_again(const PlayLoop::Layout& layout) {
  const platform::FramebufferSize window_px = window_.framebuffer_size();
  const std::optional<gpu::SwapchainFrame> frame =
      presenter_->acquire({window_px.width, window_px.height});
  if (!frame) return false;
  gpu::Image& picture = (world_ ? world_->view() : backdrop_->view()).renderer().picture();
  const Result<void> shown = presenter_->show_again(picture, *frame, layout(picture.desc().extent));
  if (!shown) return shown.error();
  return true;
}

Result<bool> App::draw_backdrop(const PlayLoop::Layout& layout) {
  SceneView& view = backdrop_->view();
  const SceneView::Moment now = backdrop_->moment();
  if (const auto done = view.stream(now); !done) return done.error();
  const platform::FramebufferSize window_px = window_.framebuffer_size();
  const std::optional<gpu::SwapchainFrame> frame =
      presenter_->acquire({window_px.width, window_px.height});
  if (!frame) return false;
  const ui::OverlayTriangles triangles = layout(presenter_->extent());
  Result<void> recorded;
  const auto bring_to_window = [&](VkCommandBuffer commands, gpu::Image& picture) {
    recorded = presenter_->record(commands, picture, *frame, &triangles);
  };
  const Result<std::uint64_t> value =
      view.draw(now, presenter_->extent(), bring_to_window, {&frame->wait, 1}, {&frame->signal, 1});
  if (!value) return value.error();
  presenter_->present(*frame, *value);
  if (!recorded) return recorded.error();
  return true;
}

ui::OverlayTriangles App::lay_out(VkExtent2D size, const platform::InputFrame& input,
                                  double seconds) {
  const bool bare = screens_.stack.top() == Screen::kPhoto && photo_settings_.bare;
  const bool fed = !screens_.stack.empty() && !screens_.listening && !bare;
  const Settings& settings = world_ ? world_->settings() : base_.settings;
  gui_.begin({size.width, size.height, seconds, fed ? &input : nullptr, settings.ui.scale});
  if (!world_ && !backdrop_) ui::cover();
  // The map lies over most of it, and lets it shine through.
  const bool mapped = screens_.stack.top() == Screen::kMap;
  if (world_ && !hud_hidden_ && !mapped && world_goes_on(screens_.stack)) {
    ui::HudFacts facts = world_->hud();
    facts.hint = hints_.line(bindings_, input.pad, world_->on_foot());
    facts.choosing = !screens_.stack.empty();
    ui::show_hud(facts, pictures_);
  }
  if (world_ && screens_.stack.empty()) world_->show_numbers();
  if (!bare) {
    const float foot_px = ui::show_messages(messages_, !screens_.stack.empty());
    // The blocks and the map do not move under the pointer when a message goes.
    ui::keep_foot_clear(world_goes_on(screens_.stack) ? 0.0f : foot_px);
  }
  ui::show_screens(screens_, screen_facts(input), wishes_);
  if (std::string refusal = gui_.take_refusal(); !refusal.empty())
    messages_.say(std::move(refusal));
  return gui_.end();
}

ui::ScreenFacts App::screen_facts(const platform::InputFrame& input) {
  ui::ScreenFacts facts;
  facts.pictures = &pictures_;
  facts.worlds = cards_;
  facts.gallery = gallery_;
  facts.now_s = std::time(nullptr);
  if (world_) facts.world = world_->world_label();
  SceneOptions& scene = world_ ? world_->scene() : base_;
  facts.quality = &scene.quality;
  facts.quality_auto = &scene.quality_auto;
  facts.fov_deg = &scene.fov_deg;
  facts.settings = world_ ? &world_->settings() : &base_.settings;
  facts.bindings = &bindings_;
  facts.costs = &costs_;
  facts.photo = &photo_settings_;
  facts.map = &map_;
  if (world_) facts.adapted_ev = world_->exposure_ev().value_or(0.0);
  ui::take_keys(screens_, input, facts);
  facts.back = back_;
  facts.version = kSkerryVersion;
  return facts;
}

}  // namespace skerry::game
