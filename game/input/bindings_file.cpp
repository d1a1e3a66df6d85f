// Bindings as the JSON of controls.json.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/input/actions.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"

namespace skerry::game {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMaxBindingsBytes = 1 << 20;
constexpr std::size_t kMaxProblems = 8;  // a hostile file shall not fill the screen

void complain(ReadBindings& read, std::string problem) {
  if (read.problems.size() < kMaxProblems) read.problems.push_back(std::move(problem));
}

void read_chord(const json& entry, const char* field, bool pad, Action action, Chord& into,
                ReadBindings& read) {
  const auto found = entry.find(field);
  if (found == entry.end()) return;
  const std::optional<Chord> chord =
      found->is_string() ? parse_chord(found->get_ref<const std::string&>()) : std::nullopt;
  const bool fits =
      chord && (chord->key == platform::Key::kNone || platform::is_pad(chord->key) == pad);
  if (fits) {
    into = *chord;
    return;
  }
  complain(read,
           fmt::format("controls.json binds '{}' to {}, which is no {}: it keeps its usual one",
                       action_type(action).name, quote_text(found->dump().substr(0, 40)),
                       pad ? "gamepad button" : "key"));
}

void read_speed(const json& root, const char* field, double& into, ReadBindings& read) {
  const auto found = root.find(field);
  if (found == root.end()) return;
  const double value = found->is_number() ? found->get<double>() : 0.0;
  if (value >= kMinTurnSpeed && value <= kMaxTurnSpeed) {
    into = value;
    return;
  }
  complain(read, fmt::format("controls.json: {} must be a number from {} to {}: it stays at {}",
                             field, kMinTurnSpeed, kMaxTurnSpeed, into));
}

void read_actions(const json& root, ReadBindings& read) {
  const auto actions = root.find("actions");
  if (actions == root.end()) return;
  if (!actions->is_object()) {
    complain(read, "controls.json: 'actions' must be an object of name: keys; the usual keys hold");
    return;
  }
  for (const auto& [name, entry] : actions->items()) {
    const std::optional<Action> action = action_named(name);
    if (!action) {
      complain(read, fmt::format("controls.json has an action {} that this build does not have",
                                 quote_text(name.substr(0, 40))));
      continue;
    }
    if (!entry.is_object()) {
      complain(read,
               fmt::format("controls.json: '{}' must be an object with 'key' and 'pad'", name));
      continue;
    }
    Binding& binding = read.bindings[*action];
    read_chord(entry, "key", false, *action, binding.key, read);
    read_chord(entry, "pad", true, *action, binding.pad, read);
  }
}

}  // namespace

ReadBindings read_bindings(std::string_view json_text) {
  ReadBindings read;
  const Result<json> parsed = parse_json(json_text);
  if (!parsed || !parsed->is_object()) {
    complain(read, parsed ? "controls.json is no JSON object: the usual keys hold"
                          : "controls.json " + parsed.error().message + "; the usual keys hold");
    return read;
  }
  const json& root = *parsed;
  read_actions(root, read);
  read_speed(root, "mouse_speed", read.bindings.mouse_speed, read);
  read_speed(root, "pad_speed", read.bindings.pad_speed, read);
  if (const auto inverted = root.find("inverted"); inverted != root.end()) {
    if (inverted->is_boolean())
      read.bindings.inverted = inverted->get<bool>();
    else
      complain(read, "controls.json: inverted must be true or false");
  }
  return read;
}

std::string print_bindings(const Bindings& bindings) {
  json root;
  for (std::size_t i = 0; i < kActions; ++i) {
    const auto action = static_cast<Action>(i);
    root["actions"][std::string(action_type(action).name)] = {
        {"key", print_chord(bindings[action].key)}, {"pad", print_chord(bindings[action].pad)}};
  }
  root["mouse_speed"] = bindings.mouse_speed;
  root["pad_speed"] = bindings.pad_speed;
  root["inverted"] = bindings.inverted;
  return root.dump(2) + "\n";
}

std::filesystem::path bindings_path() {
  const std::filesystem::path folder = platform::config_dir();
  return folder.empty() ? folder : folder / "controls.json";
}

ReadBindings load_bindings(const std::filesystem::path& path) {
  std::error_code code;
  if (path.empty() || !std::filesystem::exists(path, code)) return {};
  const Result<std::string> text = platform::read_text(path, kMaxBindingsBytes);
  if (text) return read_bindings(*text);
  ReadBindings read;
  complain(read, text.error().message + "; the usual keys hold");
  return read;
}

Result<void> save_bindings(const std::filesystem::path& path, const Bindings& bindings) {
  if (path.empty())
    return Error{
        "cannot save the controls: there is no folder for them; set HOME or XDG_CONFIG_HOME"};
  if (const Result<void> made = platform::make_dirs(path.parent_path()); !made) return made;
  if (!load_bindings(path).problems.empty())
    if (Result<void> kept = keep_as_old(path); !kept) return kept;
  return write_text(path, print_bindings(bindings));
}

}  // namespace skerry::game
