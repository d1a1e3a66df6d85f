#include "engine/platform/png_plain.h"

#include <libdeflate.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

namespace skerry::platform {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kChunkFrame = 12;  // bytes of a chunk besides its data
enum Filter : std::uint8_t { kNone, kSub, kUp, kAverage, kPaeth };

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
  return value;
}

/// A pixel's bytes as they lie in memory, so that one operation does all channels.
using Word = std::uint32_t;
constexpr Word word_of(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a) {
  return std::bit_cast<Word>(std::array<std::uint8_t, 4>{r, g, b, a});
}
constexpr Word kLowBits = 0x7f7f7f7f, kHighBits = 0x80808080;

/// Byte by byte, without carries between them.
Word sum_of(Word a, Word b) {
  return ((a & kLowBits) + (b & kLowBits)) ^ ((a ^ b) & kHighBits);
}
Word mean_of(Word a, Word b) {
  return (a & b) + (((a ^ b) >> 1) & kLowBits);
}

using Lanes = std::int16_t __attribute__((vector_size(8)));
using Bytes = std::uint8_t __attribute__((vector_size(4)));

Lanes lanes_of(Word word) {
  return __builtin_convertvector(std::bit_cast<Bytes>(word), Lanes);
}

/// Of left, above and above left the one that is nearest to left + above - above left.
Word paeth_of(Word left, Word above, Word corner) {
  const Lanes a = lanes_of(left), b = lanes_of(above), c = lanes_of(corner);
  const auto magnitude = [](Lanes x) { return x < 0 ? -x : x; };
  const Lanes from_a = magnitude(b - c), from_b = magnitude(a - c),
              from_c = magnitude(a + b - c - c);
  const Lanes of_b_c = from_b <= from_c ? b : c;
  const Lanes nearest = ((from_a <= from_b) & (from_a <= from_c)) ? a : of_b_c;
  return std::bit_cast<Word>(__builtin_convertvector(nearest, Bytes));
}

/// Undoes a filter. @param predicted of the pixels left, above and above left.
/// @param above the row above as it was read; all pixels are 4 bytes, those of RGB opaque.
template <std::size_t kChannels, class Predict>
void undo_filter(const std::uint8_t* from, const std::uint8_t* above, std::size_t width,
                 std::uint8_t* to, const Predict& predicted) {
  constexpr Word kFilled = kChannels == 4 ? 0 : word_of(0, 0, 0, 255);
  Word left = 0, corner = 0;
  for (std::size_t x = 0; x < width; ++x) {
    Word coded = 0, over = 0;
    std::memcpy(&coded, from + x * kChannels, kChannels);
    std::memcpy(&over, above + x * 4, 4);
    over &= ~kFilled;
    left = sum_of(coded, predicted(left, over, corner));
    corner = over;
    const Word shown = left | kFilled;
    std::memcpy(to + x * 4, &shown, 4);
  }
}

/// @return false if there is no filter of this number.
template <std::size_t kChannels>
bool undo_filter(std::uint8_t filter, const std::uint8_t* from, const std::uint8_t* above,
                 std::size_t width, std::uint8_t* to) {
  const auto undo = [&](const auto& predicted) {
    undo_filter<kChannels>(from, above, width, to, predicted);
    return true;
  };
  switch (filter) {
    case kNone:
      return undo([](Word, Word, Word) { return Word{0}; });
    case kSub:
      return undo([](Word left, Word, Word) { return left; });
    case kUp:
      return undo([](Word, Word over, Word) { return over; });
    case kAverage:
      return undo([](Word left, Word over, Word) { return mean_of(left, over); });
    case kPaeth:
      return undo([](Word left, Word over, Word corner) { return paeth_of(left, over, corner); });
    default:
      return false;
  }
}

/// Inflated rows, each behind the number of its filter, into `image.pixels`.
template <std::size_t kChannels>
bool undo_filters(const std::uint8_t* rows, PngImage& image) {
  const std::size_t stride = std::size_t{image.width} * 4;
  const std::vector<std::uint8_t> none(stride);
  image.pixels.resize(stride * image.height);
  const std::uint8_t* above = none.data();
  for (std::uint32_t y = 0; y < image.height; ++y) {
    std::uint8_t* to = image.pixels.data() + y * stride;
    if (!undo_filter<kChannels>(rows[0], rows + 1, above, image.width, to)) return false;
    rows += 1 + std::size_t{image.width} * kChannels;
    above = to;
  }
  return true;
}

struct Chunk {
  std::string_view type, data;
};

/// Takes the next chunk off the front. None: it is cut short, or its checksum is wrong.
std::optional<Chunk> take_chunk(std::string_view& file) {
  if (file.size() < kChunkFrame) return std::nullopt;
  const std::size_t length = big_endian(file);
  if (length > file.size() - kChunkFrame) return std::nullopt;
  const std::string_view checked = file.substr(4, 4 + length);
  if (libdeflate_crc32(0, checked.data(), checked.size()) != big_endian(file.substr(8 + length)))
    return std::nullopt;
  file.remove_prefix(kChunkFrame + length);
  return Chunk{checked.substr(0, 4), checked.substr(4)};
}

/// Takes what is before the next zero byte, and that byte.
std::optional<std::string_view> take_text(std::string_view& data) {
  const std::size_t end = data.find('\0');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view text = data.substr(0, end);
  data.remove_prefix(end + 1);
  return text;
}

/// Takes a chunk of text in. @return false if it is compressed, or not as it should be.
bool take_in_text(const Chunk& chunk, std::vector<PngText>& texts) {
  constexpr std::size_t kMostTexts = 32, kMostBytes = 1 << 16;
  std::string_view data = chunk.data;
  const auto key = take_text(data);
  if (!key || key->empty() || key->size() > 79) return false;
  if (chunk.type == "iTXt") {
    if (data.size() < 2 || data[0] != 0) return false;
    data.remove_prefix(2);
    if (!take_text(data) || !take_text(data)) return false;  // language, translated key
  }
  if (texts.size() >= kMostTexts || data.size() > kMostBytes ||
      data.find('\0') != std::string_view::npos)
    return false;
  texts.push_back({std::string(*key), std::string(data)});
  return true;
}

/// The parts of a file. `deflated` is one chunk's data or points into `joined`.
struct Parts {
  PngImage image;  ///< without pixels
  std::size_t channels = 0;
  std::string_view deflated;
  std::string joined;
};

/// @return whether the first chunk describes a picture of this kind within the limits.
bool take_in_header(const Chunk& chunk, std::size_t file_bytes, Parts& parts) {
  if (chunk.type != "IHDR" || chunk.data.size() != 13) return false;
  const std::uint32_t width = big_endian(chunk.data), height = big_endian(chunk.data.substr(4));
  const std::string_view kind = chunk.data.substr(8);
  if (kind != std::string_view("\x08\x02\0\0\0", 5) &&
      kind != std::string_view("\x08\x06\0\0\0", 5))
    return false;
  if (width == 0 || height == 0 || width > kMaxPngEdge || height > kMaxPngEdge ||
      std::uint64_t{width} * height > kMaxPngPixels)
    return false;
  parts.channels = kind[1] == 2 ? 3 : 4;
  parts.image.width = width;
  parts.image.height = height;
  return std::uint64_t{width} * height * parts.channels <= kMaxDeflateRatio * file_bytes;
}

bool take_apart(std::string_view file, Parts& parts) {
  const std::size_t file_bytes = file.size();
  if (!file.starts_with(kSignature)) return false;
  file.remove_prefix(kSignature.size());
  const auto header = take_chunk(file);
  if (!header || !take_in_header(*header, file_bytes, parts)) return false;
  bool in_pixels = false;
  for (auto chunk = take_chunk(file); chunk; chunk = take_chunk(file)) {
    if (chunk->type == "IEND") return chunk->data.empty() && !parts.deflated.empty();
    const bool pixels = chunk->type == "IDAT";
    if (pixels && !in_pixels && !parts.deflated.empty()) return false;  // they lie apart
    in_pixels = pixels;
    if (pixels && parts.deflated.empty()) {
      parts.deflated = chunk->data;
    } else if (pixels) {
      if (parts.joined.empty()) {
        parts.joined.reserve(file_bytes);
        parts.joined = parts.deflated;
      }
      parts.joined += chunk->data;
      parts.deflated = parts.joined;
    } else if (chunk->type == "tEXt" || chunk->type == "iTXt") {
      if (!take_in_text(*chunk, parts.image.text)) return false;
    } else if ((chunk->type[0] & 0x20) == 0 || chunk->type == "zTXt" || chunk->type == "tRNS") {
      return false;  // needed to show the picture, or to be read
    }
  }
  return false;
}

}  // namespace

std::optional<PngImage> read_plain_png(std::string_view file) {
  Parts parts;
  if (!take_apart(file, parts)) return std::nullopt;
  const std::size_t row = 1 + std::size_t{parts.image.width} * parts.channels;
  const std::size_t bytes = row * parts.image.height;
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflate(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!inflate) return std::nullopt;
  const auto rows = std::make_unique_for_overwrite<std::uint8_t[]>(bytes);
  // As many bytes as the size says, no fewer and no more.
  if (libdeflate_zlib_decompress(inflate.get(), parts.deflated.data(), parts.deflated.size(),
                                 rows.get(), bytes, nullptr) != LIBDEFLATE_SUCCESS)
    return std::nullopt;
  const bool read = parts.channels == 3 ? undo_filters<3>(rows.get(), parts.image)
                                        : undo_filters<4>(rows.get(), parts.image);
  if (!read) return std::nullopt;
  return std::move(parts.image);
}

}  // namespace skerry::platform
