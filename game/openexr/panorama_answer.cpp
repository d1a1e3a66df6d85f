#include "game/openexr/panorama_answer.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace skerry::game {
namespace {

constexpr std::uint64_t kMagic = 0x314e4150524b53ull;  // "SKRPAN1"

/// Behind it come the texels, or the bytes of a message.
struct Head {
  std::uint64_t magic = kMagic;
  std::uint64_t mended = 0;
  std::uint32_t columns = 0, rows = 0;  ///< 0: there is a message
  std::uint32_t message_bytes = 0;
  std::uint32_t unused = 0;
};
static_assert(sizeof(Head) == 32, "no byte of it may be left to chance");

const Error kNoAnswer{"its reader's answer is damaged; the file likely is, too: copy it again"};

}  // namespace

bool encode_panorama(const render::Panorama& panorama, const world::ByteSink& sink) {
  Head head;
  head.mended = panorama.mended;
  head.columns = panorama.columns;
  head.rows = panorama.rows;
  return sink(std::as_bytes(std::span(&head, 1))) &&
         sink(std::as_bytes(std::span(panorama.texels)));
}

bool encode_refusal(std::string_view why, const world::ByteSink& sink) {
  why = why.substr(0, world::kMostAnswerText);
  Head head;
  head.message_bytes = static_cast<std::uint32_t>(why.size());
  return sink(std::as_bytes(std::span(&head, 1))) && sink(std::as_bytes(std::span(why)));
}

Result<render::Panorama> decode_panorama(std::span<const std::byte> bytes) {
  Head head;
  if (bytes.size() < sizeof head) return kNoAnswer;
  std::memcpy(&head, bytes.data(), sizeof head);
  bytes = bytes.subspan(sizeof head);
  if (head.magic != kMagic) return kNoAnswer;
  if (head.columns == 0) {
    if (head.message_bytes == 0 || head.message_bytes > world::kMostAnswerText ||
        head.message_bytes != bytes.size())
      return kNoAnswer;
    return Error{world::printable({reinterpret_cast<const char*>(bytes.data()), bytes.size()})};
  }
  const std::size_t texels = std::size_t{head.columns} * head.rows;
  if (head.columns > render::kKeptPanoramaColumns || head.rows * std::uint64_t{2} != head.columns ||
      bytes.size() != texels * sizeof(glm::vec3))
    return kNoAnswer;
  render::Panorama out;
  out.columns = head.columns;
  out.rows = head.rows;
  out.mended = head.mended;
  out.texels.resize(texels);
  std::memcpy(out.texels.data(), bytes.data(), bytes.size());
  const auto sound = [](const glm::vec3& texel) {
    const auto fits = [](float v) { return v >= 0.0f && v <= render::kMostPanoramaRadiance; };
    return fits(texel.x) && fits(texel.y) && fits(texel.z);
  };
  if (!std::all_of(out.texels.begin(), out.texels.end(), sound)) return kNoAnswer;
  return out;
}

}  // namespace skerry::game
