// The screens: plain functions from values to ImGui calls. What a player asks for comes back as
// wishes; nothing here touches a world, a file or the device.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "game/input/actions.h"
#include "game/scene_file/settings.h"
#include "game/ui/knob_costs.h"
#include "game/ui/map_facts.h"
#include "game/ui/pictures.h"
#include "game/ui/screen_stack.h"

namespace skerry::game::ui {

/// A saved world as the list shows it.
struct WorldCard {
  std::string path, name, seed_text;
  std::int64_t played_s = 0;  ///< Unix time
  std::uint64_t bytes = 0;
  int thumbnail = -1;   ///< slot of Pictures; -1: none
  std::string problem;  ///< not empty: why it cannot be played
};

/// A picture that the player took, as the gallery shows it.
struct PictureCard {
  std::string path, name;
  int thumbnail = -1;   ///< slot of Pictures; -1: it is not read yet, or cannot be
  std::string problem;  ///< not empty: why it cannot be entered
};

inline constexpr std::size_t kMaxNameBytes = 64, kMaxSeedBytes = 256;

/// Text that is being typed, ended by a zero.
template <std::size_t kBytes>
using Field = std::array<char, kBytes + 1>;
/// What does not fit is left out.
template <std::size_t kSize>
void set_field(std::array<char, kSize>& field, std::string_view text) {
  field.fill('\0');
  std::copy_n(text.begin(), std::min(text.size(), kSize - 1), field.begin());
}

/// What the screens remember between frames.
struct ScreenState {
  ScreenStack stack;
  bool fresh = true;  ///< the topmost was not shown in the last frame

  std::optional<std::string> chosen_world;  ///< path
  bool asks_to_delete = false;

  Field<kMaxNameBytes> new_name{};
  Field<kMaxSeedBytes> new_seed{};
  bool types_seed = false;  ///< a gamepad's letters go there, not into the name
  bool capitals = false;    ///< of a gamepad's letters

  /// Which binding waits for a key.
  struct Listening {
    Action action;
    bool pad;
  };
  std::optional<Listening> listening;

  /// Why the world that was to be left could not be saved.
  std::optional<std::string> unsaved;

  Field<32> palette_search{};

  std::size_t chosen_picture = 0;  ///< of the gallery

  int map_radius = 1;            ///< index into kMapRadii
  glm::dvec2 map_shift{};        ///< of the map's middle from the player: blocks east and south
  std::size_t chosen_place = 0;  ///< of MapFacts
  std::size_t named_place = 0;   ///< whose name the field holds
  Field<64> place_name{};

  bool calibrating = false;
};

/// Photo mode's knobs; its camera belongs to the one who draws.
struct PhotoSettings {
  int time_of_day_s = 0;
  std::optional<double> exposure_ev;  ///< none: as the eye adapts
  double fov_deg = 70.0;
  bool bare = false;  ///< nothing but the picture, and the camera flies
};

/// What there is to show. Pointers are to what a screen may change at once; nobody else does while
/// it is shown.
struct ScreenFacts {
  const Pictures* pictures = nullptr;
  std::span<const WorldCard> worlds;
  std::span<const PictureCard> gallery;
  std::int64_t now_s = 0;            ///< Unix time
  std::optional<std::string> world;  ///< name and seed of the one being played
  Quality* quality = nullptr;
  bool* quality_auto = nullptr;  ///< whether play chooses the quality
  Settings* settings = nullptr;
  double* fov_deg = nullptr;
  Bindings* bindings = nullptr;
  KnobCosts* costs = nullptr;
  PhotoSettings* photo = nullptr;
  const MapFacts* map = nullptr;                 ///< of the world being played
  double adapted_ev = 0.0;                       ///< what photo mode's exposure begins at
  platform::Key pressed = platform::Key::kNone;  ///< first key that went down in this frame
  bool control = false;     ///< while the key that makes chords was held (control_of)
  bool control_up = false;  ///< that one was released
  bool pad = false;         ///< a gamepad is plugged in
  bool back = false;        ///< Escape, or its like on a gamepad, went down
  std::string_view version;
};

/// What the player asked for in a frame.
struct Wishes {
  std::optional<std::string> play;    ///< path of a world
  std::optional<std::string> remove;  ///< likewise, for good
  struct NewWorld {
    std::string name, seed_text;
  };
  std::optional<NewWorld> create;
  std::optional<world::BlockId> take;  ///< into the hand
  bool preview = false;                ///< the new world's seed has changed
  bool draw_lots = false;              ///< another seed for it
  bool draw_name = false;              ///< another name for it
  bool leave_world = false;            ///< saved, to the title
  bool leave_unsaved = false;          ///< to the title, whatever is lost
  bool quit = false;
  bool photograph = false;
  MapWishes map;
  std::optional<std::string> enter;  ///< path of a picture
  bool settings_changed = false, bindings_changed = false;
};

/// Shows the topmost screen, if any.
void show_screens(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);

/// Whether Escape, or its like on a gamepad, went down. A binding that waits for a gamepad's button
/// takes that one, too.
bool goes_back(const ScreenState& state, const platform::InputFrame& input);
/// Moves the map, by no more than kMostMapShift from the player.
void shift_map(ScreenState& state, glm::dvec2 blocks);
/// Fills in which keys went down and up, as a binding that waits for one wants them.
void take_keys(const ScreenState& state, const platform::InputFrame& input, ScreenFacts& facts);

/// Escape, or its like on a gamepad: closes what is topmost, also from within a text field.
void go_back(ScreenState& state);

/// A seed for who has none in mind, short enough to be told to a friend.
std::string seed_from(std::uint64_t entropy);

/// "3 hours ago", for lists. Times to come are "just now": clocks are set.
std::string ago(std::int64_t seconds);

/// Blocks of the palette that a search finds, in the table's order: all words must occur in the
/// label or in the English one, in any case. No air.
std::vector<world::BlockId> find_blocks(std::string_view search);
/// "stone_mossy" as "Mossy stone", in the player's language.
std::string block_label(world::BlockId block);

// One function a screen.
void show_title(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_worlds(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_new_world(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_settings(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_controls(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_pause(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_palette(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_photo(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_map(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);
void show_gallery(ScreenState& state, const ScreenFacts& facts, Wishes& wishes);

}  // namespace skerry::game::ui
