#include "game/input/hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/scene_file/json_text.h"
#include "game/words/words.h"

namespace skerry::game {
namespace {

constexpr std::uint64_t kMaxHintsBytes = 1 << 16;

struct Hint {
  std::string_view name;  ///< in the file
  const char* does;
  Action actions[4];  ///< each of which uses it; the first is repeated where there are fewer
  std::size_t count;
  bool on_foot = false;  ///< true of those who walk alone
};
constexpr Hint kHints[] = {
    {"walk",
     word("walk"),
     {Action::kForward, Action::kLeft, Action::kBack, Action::kRight},
     4,
     true},
    {"jump", word("jump"), {Action::kJump}, 1, true},
    {"dig", word("dig, held"), {Action::kDig}, 1},
    {"place", word("place what is in the hand"), {Action::kPlace}, 1},
    {"palette", word("choose among all blocks"), {Action::kPalette}, 1},
    {"torch", word("torch in the hand"), {Action::kTorch}, 1},
    {"pause", word("pause, settings, controls"), {Action::kPause}, 1},
};
static_assert(std::size(kHints) == Hints::kCount);

std::span<const Action> actions_of(const Hint& hint) {
  return {hint.actions, hint.count};
}

bool waits(const Hint& hint, bool on_foot) {
  return hint.on_foot && !on_foot;
}

/// kCount: none.
std::size_t first_left(const std::bitset<Hints::kCount>& gone, bool on_foot) {
  std::size_t i = 0;
  while (i < gone.size() && (gone[i] || waits(kHints[i], on_foot))) ++i;
  return i;
}

}  // namespace

void Hints::note(const ActionFrame& actions, double seconds, bool on_foot) {
  std::bitset<kCount> gone = used_;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (waits(kHints[i], on_foot)) continue;
    const std::span<const Action> own = actions_of(kHints[i]);
    const bool used =
        std::any_of(own.begin(), own.end(), [&](Action action) { return actions.pressed(action); });
    gone[i] = gone[i] || used;
  }
  if (actions.any()) shown_s_ += seconds;
  const std::size_t first = first_left(gone, on_foot);
  if (first != std::exchange(shown_, first)) shown_s_ = 0.0;
  if (shown_s_ > kLongEnough && first < kCount) gone.set(first);
  changed_ |= gone != used_;
  used_ = gone;
}

std::optional<std::string> Hints::line(const Bindings& bindings, bool pad, bool on_foot) const {
  for (std::size_t i = 0; i < kCount; ++i) {
    if (used_[i] || waits(kHints[i], on_foot)) continue;
    std::string keys;
    for (const Action action : actions_of(kHints[i])) {
      const Chord chord = pad ? bindings[action].pad : bindings[action].key;
      if (chord.key == platform::Key::kNone) continue;
      keys += (keys.empty() ? "" : ", ") + chord_label(chord);
    }
    if (!keys.empty()) return fmt::format("{}: {}", keys, tr(kHints[i].does));
  }
  return std::nullopt;
}

Hints Hints::read(std::string_view json_text) {
  Hints hints;
  const Result<nlohmann::json> parsed = parse_json(json_text);
  if (!parsed || !parsed->is_object() || !parsed->contains("used")) return hints;
  const nlohmann::json& used = (*parsed)["used"];
  for (std::size_t i = 0; i < kCount; ++i)
    hints.used_[i] = used.is_array() &&
                     std::find(used.begin(), used.end(), std::string(kHints[i].name)) != used.end();
  return hints;
}

std::string Hints::print() const {
  nlohmann::json root;
  root["used"] = nlohmann::json::array();
  for (std::size_t i = 0; i < kCount; ++i)
    if (used_[i]) root["used"].push_back(std::string(kHints[i].name));
  return root.dump(2) + "\n";
}

std::filesystem::path hints_path() {
  const std::filesystem::path folder = platform::config_dir();
  return folder.empty() ? folder : folder / "hints.json";
}

Hints load_hints(const std::filesystem::path& path) {
  std::error_code code;
  if (path.empty() || !std::filesystem::exists(path, code)) return {};
  const Result<std::string> text = platform::read_text(path, kMaxHintsBytes);
  return text ? Hints::read(*text) : Hints();
}

Result<void> save_hints(const std::filesystem::path& path, const Hints& hints) {
  if (path.empty())
    return Error{
        "cannot save which hints were used: there is no folder for that; set HOME or "
        "XDG_CONFIG_HOME"};
  if (const Result<void> made = platform::make_dirs(path.parent_path()); !made) return made;
  return write_text(path, hints.print());
}

}  // namespace skerry::game
