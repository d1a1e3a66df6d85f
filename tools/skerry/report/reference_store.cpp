#include "tools/skerry/report/reference_store.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "engine/core/log.h"
#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/report/file_lock.h"
#include "tools/skerry/scene/draw_scene.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "entries are little-endian");
static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

constexpr std::string_view kMagic = "SKERREF1";
constexpr std::size_t kDigestDigits = 64;
/// Of the reference renderer's largest picture, which has 2^26 pixels.
constexpr std::uint64_t kMaxEntryBytes = std::uint64_t{1} << 30;

/// What follows kMagic in an entry; then come the pixels, and the SHA-256 of all before it in
/// hexadecimal digits.
struct Header {
  std::uint32_t width, height;
  double ev;
  double mean_error;  ///< NaN: not known
  double seconds;
};
static_assert(sizeof(Header) == 32);

std::string digest_of(std::string_view text) {
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string entry_text(const KeptReference& kept) {
  const Header header{kept.radiance.width, kept.radiance.height, kept.ev,
                      kept.mean_error.value_or(std::numeric_limits<double>::quiet_NaN()),
                      kept.seconds};
  const std::span pixels(kept.radiance.pixels);
  std::string text;
  text.reserve(kMagic.size() + sizeof header + pixels.size_bytes() + kDigestDigits);
  text += kMagic;
  text.append(reinterpret_cast<const char*>(&header), sizeof header);
  text.append(reinterpret_cast<const char*>(pixels.data()), pixels.size_bytes());
  return text + digest_of(text);
}

/// None: the text is not entry_text's.
std::optional<KeptReference> kept_from(std::string_view text) {
  constexpr std::size_t kAround = kMagic.size() + sizeof(Header) + kDigestDigits;
  if (text.size() < kAround || !text.starts_with(kMagic)) return std::nullopt;
  const std::string_view whole = text.substr(0, text.size() - kDigestDigits);
  if (digest_of(whole) != text.substr(whole.size())) return std::nullopt;
  Header header;
  std::memcpy(&header, text.data() + kMagic.size(), sizeof header);
  const std::uint64_t count = std::uint64_t{header.width} * header.height;
  if (count > kMaxEntryBytes || count * sizeof(glm::vec3) != text.size() - kAround)
    return std::nullopt;
  KeptReference kept{{header.width, header.height, {}}, header.ev, {}, header.seconds};
  if (!std::isnan(header.mean_error)) kept.mean_error = header.mean_error;
  kept.radiance.pixels.resize(count);
  std::memcpy(static_cast<void*>(kept.radiance.pixels.data()),
              text.data() + kMagic.size() + sizeof header, count * sizeof(glm::vec3));
  return kept;
}

/// None: there is no whole entry. @param complains about a damaged one.
std::optional<KeptReference> read_entry(const fs::path& file, bool complains) {
  std::error_code code;
  if (!fs::exists(file, code)) return std::nullopt;
  const Result<std::string> text = platform::read_text(file, kMaxEntryBytes);
  std::optional<KeptReference> kept = text ? kept_from(*text) : std::nullopt;
  if (!kept && complains)
    log_warning(fmt::format("the reference {} is damaged and is made again",
                            game::quote_text(file.string())));
  return kept;
}

}  // namespace

ReferenceStore::ReferenceStore(fs::path folder) : folder_(std::move(folder)) {}

fs::path ReferenceStore::entry(const std::string& id) const {
  return folder_ / (id + ".reference");
}

bool ReferenceStore::has(const std::string& id) const {
  std::error_code code;
  return fs::exists(entry(id), code);
}

Result<KeptReference> ReferenceStore::get(const std::string& id, const Make& make) const {
  const fs::path file = entry(id);
  if (std::optional<KeptReference> kept = read_entry(file, false)) return *std::move(kept);
  const auto not_kept = [](const Error& why) {
    log_warning("a reference is computed and not kept: " + why.message);
  };
  if (const Result<void> made = platform::make_dirs(folder_); !made) {
    not_kept(made.error());
    return make();
  }
  const Result<FileLock> lock = FileLock::take(folder_ / (id + ".lock"));
  if (!lock) {
    not_kept(lock.error());
    return make();
  }
  if (std::optional<KeptReference> kept = read_entry(file, true)) return *std::move(kept);
  Result<KeptReference> made = make();
  if (!made) return made;
  if (const Result<void> written = write_text(file, entry_text(*made)); !written)
    not_kept(written.error());
  return made;
}

}  // namespace skerry::tools
