#include "tools/skerry/report/reference_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "engine/core/check.h"
#include "engine/core/log.h"
#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tools/skerry/report/file_lock.h"
#include "tools/skerry/scene/draw_scene.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using reference::ReferenceBatches;

static_assert(sizeof(glm::dvec3) == 3 * sizeof(double));

constexpr std::string_view kPartMagic = "SKERPRT1";
constexpr std::size_t kPartDigestDigits = 64;
/// Eight batches of 2^26 pixels.
constexpr std::uint64_t kMaxPartBytes = std::uint64_t{13} << 30;

/// What follows kPartMagic; then come the means, and the SHA-256 of all before it.
struct PartHeader {
  std::uint32_t width, height, first, count;
  double seconds;
};
static_assert(sizeof(PartHeader) == 24);

std::string part_digest(std::string_view text) {
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string part_text(const ReferenceBatches& part) {
  const PartHeader header{part.width, part.height, part.first, part.count, part.seconds};
  const std::span means(part.means);
  std::string text;
  text.reserve(kPartMagic.size() + sizeof header + means.size_bytes() + kPartDigestDigits);
  text += kPartMagic;
  text.append(reinterpret_cast<const char*>(&header), sizeof header);
  text.append(reinterpret_cast<const char*>(means.data()), means.size_bytes());
  return text + part_digest(text);
}

/// None: the text is not part_text's of these batches.
std::optional<ReferenceBatches> part_from(std::string_view text, const BatchRange& range) {
  constexpr std::size_t kAround = kPartMagic.size() + sizeof(PartHeader) + kPartDigestDigits;
  if (text.size() < kAround || !text.starts_with(kPartMagic)) return std::nullopt;
  const std::string_view whole = text.substr(0, text.size() - kPartDigestDigits);
  if (part_digest(whole) != text.substr(whole.size())) return std::nullopt;
  PartHeader header;
  std::memcpy(&header, text.data() + kPartMagic.size(), sizeof header);
  if (BatchRange{header.first, header.count} != range) return std::nullopt;
  const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
  if (pixels > kMaxPartBytes || pixels * header.count * sizeof(glm::dvec3) != text.size() - kAround)
    return std::nullopt;
  ReferenceBatches part{header.width, header.height, header.first, header.count, {}, 0.0};
  part.seconds = header.seconds;
  part.means.resize(pixels * header.count);
  std::memcpy(static_cast<void*>(part.means.data()),
              text.data() + kPartMagic.size() + sizeof header,
              part.means.size() * sizeof(glm::dvec3));
  return part;
}

class Gathering {
 public:
  using Draw = std::function<Result<ReferenceBatches>(const BatchRange&)>;

  Gathering(const ReferenceStore& store, const std::string& id, std::span<const BatchRange> parts,
            const Draw& draw)
      : store_(store), id_(id), parts_(parts), draw_(draw) {}

  /// Returns when every part, or the whole entry, is there. Errors: of drawing; of files.
  Result<void> gather() const {
    for (const bool waits : {false, true})
      for (const BatchRange& range : parts_)
        if (Result<void> done = provide(range, waits); !done) return done;
    return {};
  }
  /// All parts; those that are missing or damaged are drawn. Errors: of drawing.
  Result<std::vector<ReferenceBatches>> read() const {
    std::vector<ReferenceBatches> all;
    for (const BatchRange& range : parts_) {
      std::optional<ReferenceBatches> part = read_part(range);
      if (!part) {
        Result<ReferenceBatches> drawn = draw_(range);
        if (!drawn) return drawn.error();
        part = *std::move(drawn);
      }
      all.push_back(*std::move(part));
    }
    return all;
  }
  void remove() const {
    std::error_code code;
    for (const BatchRange& range : parts_) fs::remove(file_of(range), code);
  }

 private:
  fs::path file_of(const BatchRange& range) const {
    return store_.folder() / fmt::format("{}.{}-{}.part", id_, range.first, range.count);
  }
  bool is_there(const BatchRange& range) const {
    std::error_code code;
    return store_.has(id_) || fs::exists(file_of(range), code);
  }
  std::optional<ReferenceBatches> read_part(const BatchRange& range) const {
    std::error_code code;
    if (!fs::exists(file_of(range), code)) return std::nullopt;
    const Result<std::string> text = platform::read_text(file_of(range), kMaxPartBytes);
    return text ? part_from(*text, range) : std::nullopt;
  }
  Result<void> provide(const BatchRange& range, bool waits) const {
    if (is_there(range)) return {};
    const fs::path file = file_of(range).string() + ".lock";
    std::optional<FileLock> lock;
    if (waits) {
      Result<FileLock> taken = FileLock::take(file);
      if (!taken) return taken.error();
      lock.emplace(*std::move(taken));
    } else {
      Result<std::optional<FileLock>> taken = FileLock::try_take(file);
      if (!taken) return taken.error();
      if (!*taken) return {};
      lock.emplace(**std::move(taken));
    }
    if (is_there(range)) return {};
    const Result<ReferenceBatches> drawn = draw_(range);
    if (!drawn) return drawn.error();
    return write_text(file_of(range), part_text(*drawn));
  }

  const ReferenceStore& store_;
  const std::string& id_;
  std::span<const BatchRange> parts_;
  const Draw& draw_;
};

}  // namespace

std::vector<BatchRange> split_batches(std::uint32_t batches, std::uint32_t parts) {
  SKERRY_ASSERT(batches >= 1 && parts >= 1);
  parts = std::min(parts, batches);
  std::vector<BatchRange> ranges;
  for (std::uint32_t i = 0; i < parts; ++i) {
    const std::uint32_t first = batches * i / parts;
    ranges.push_back({first, batches * (i + 1) / parts - first});
  }
  return ranges;
}

Result<KeptReference> get_in_parts(
    const ReferenceStore& store, const std::string& id, std::span<const BatchRange> parts,
    const std::function<Result<ReferenceBatches>(const BatchRange&)>& draw,
    const std::function<KeptReference(std::span<const ReferenceBatches>)>& merge) {
  const Gathering gathering(store, id, parts, draw);
  if (!store.has(id)) {
    Result<void> gathered = platform::make_dirs(store.folder());
    if (gathered) gathered = gathering.gather();
    if (!gathered) log_warning("a reference is not shared: " + gathered.error().message);
  }
  Result<KeptReference> kept = store.get(id, [&]() -> Result<KeptReference> {
    const Result<std::vector<ReferenceBatches>> all = gathering.read();
    if (!all) return all.error();
    return merge(*all);
  });
  if (kept) gathering.remove();
  return kept;
}

}  // namespace skerry::tools
