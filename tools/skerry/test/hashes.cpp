#include "tools/skerry/test/hashes.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxHashBytes = 8u << 20;

bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_hash(const nlohmann::json& value) {
  if (!value.is_string()) return false;
  const auto& text = value.get_ref<const std::string&>();
  return text.size() == 64 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace

std::string file_name_part(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (is_letter_or_digit(c) || (c == '.' && !out.empty())) {
      out += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out.empty() ? "unknown" : out;
}

std::string cpu_vendor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const bool names_vendor = line.starts_with("vendor_id") || line.starts_with("CPU implementer");
    const std::size_t colon = line.find(": ");
    if (names_vendor && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string driver_key(const gpu::DeviceInfo& device) {
  if (device.type != VK_PHYSICAL_DEVICE_TYPE_CPU) return file_name_part(device.driver);
  // lavapipe's name has the vector width, which its driver text leaves out.
  const std::size_t bits = device.name.find(" bits");
  const std::size_t comma = device.name.rfind(' ', bits == std::string::npos ? 0 : bits - 1);
  const std::string width = bits == std::string::npos || comma == std::string::npos
                                ? std::string()
                                : device.name.substr(comma + 1, bits - comma + 4);
  return file_name_part(device.driver + " " + width + " " + cpu_vendor());
}

fs::path hash_file(const fs::path& scenes, std::string_view driver) {
  return scenes / "hashes" / (std::string(driver) + ".json");
}

Result<Hashes> read_hashes(const fs::path& file, const std::optional<Unpacked>& from_archive) {
  const auto damaged = [&](std::string_view why) {
    return Error{fmt::format(
        "cannot use the approved hashes in {}: {}; {} and run skerry test "
        "--approve",
        known_as(file, from_archive), why,
        from_archive ? "take that member out of the archive (tar --delete)" : "delete the file")};
  };
  std::error_code code;
  if (!fs::exists(file, code)) return Hashes{};
  const Result<std::string> text = platform::read_text(file, kMaxHashBytes);
  if (!text && from_archive)
    return damaged(fmt::format("they are no file of at most {} bytes", kMaxHashBytes));
  if (!text) return text.error();
  const Result<nlohmann::json> parsed = game::parse_json(*text);
  const nlohmann::json from = parsed ? *parsed : nlohmann::json();
  Hashes hashes;
  for (const auto& [scene, hash] : from.items()) {
    if (!from.is_object() || !is_hash(hash)) break;
    hashes[scene] = hash.get<std::string>();
  }
  if (from.is_object() && hashes.size() == from.size()) return hashes;
  return damaged("they are no object of SHA-256 by scene");
}

Result<void> write_hashes(const fs::path& file, const Hashes& hashes) {
  if (const Result<void> made = platform::make_dirs(file.parent_path()); !made) return made;
  // Names of files may hold bytes that are no UTF-8.
  const auto replace = nlohmann::json::error_handler_t::replace;
  return write_text(file, nlohmann::json(hashes).dump(2, ' ', false, replace) + "\n");
}

Result<void> remove_others(const fs::path& scenes, std::string_view driver,
                           const std::string& scene, const std::optional<Unpacked>& from) {
  std::error_code code;
  const fs::path kept = hash_file(scenes, driver);
  for (fs::directory_iterator at(kept.parent_path(), code), end; !code && at != end;
       at.increment(code)) {
    if (at->path() == kept || at->path().extension() != ".json") continue;
    Result<Hashes> hashes = read_hashes(at->path(), from);
    if (!hashes) return hashes.error();
    if (hashes->erase(scene) == 0) continue;
    if (const Result<void> written = write_hashes(at->path(), *hashes); !written) return written;
  }
  return {};
}

}  // namespace skerry::tools
