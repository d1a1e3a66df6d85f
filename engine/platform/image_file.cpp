#include "engine/platform/image_file.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "engine/platform/png_plain.h"

namespace skerry::platform {
namespace {

// libpng reports errors by longjmp, which must not pass frames with destructors: every object that
// owns memory lives in the caller of the functions that call setjmp, and those hold plain values
// only.

/// What a libpng call needs to reach: the bytes left, and the message of a failure.
struct Stream {
  std::string_view in;
  char message[128] = {};
};

void on_error(png_structp png, png_const_charp message) {
  auto* stream = static_cast<Stream*>(png_get_error_ptr(png));
  std::strncpy(stream->message, message, sizeof stream->message - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep data, std::size_t size) {
  auto* stream = static_cast<Stream*>(png_get_io_ptr(png));
  if (size > stream->in.size()) png_error(png, "the file ends too early");
  std::memcpy(data, stream->in.data(), size);
  stream->in.remove_prefix(size);
}

/// First half of decoding: header and size, with every format turned into RGBA8.
bool decode_header(png_structp png, png_infop info, Stream& stream) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_read_fn(png, &stream, on_read);
  png_set_user_limits(png, kMaxPngEdge, kMaxPngEdge);
  png_set_chunk_malloc_max(png, 1 << 20);
  png_set_chunk_cache_max(png, 64);
  png_read_info(png, info);
  // A short file cannot hold a large picture, whatever it states: refused before memory is taken.
  const std::uint64_t width = png_get_image_width(png, info);
  const std::uint64_t height = png_get_image_height(png, info);
  const std::uint64_t row_bits = width * png_get_bit_depth(png, info) * png_get_channels(png, info);
  if ((row_bits + 7) / 8 * height > kMaxDeflateRatio * stream.in.size())
    png_error(png, "it is too short for the size it states");
  if (width * height > kMaxPngPixels) png_error(png, "it has more than 2^27 pixels");
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (png_get_rowbytes(png, info) != std::size_t{png_get_image_width(png, info)} * 4) {
    png_error(png, "it has an unsupported pixel format");
  }
  return true;
}

bool decode_rows(png_structp png, png_infop info, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  png_read_end(png, info);
  return true;
}

/// Whether every chunk up to IEND lies within the file. libpng takes memory for the length that a
/// chunk states before it reads any of it (its own limit is only a warning).
bool chunks_fit(std::string_view file) {
  for (std::size_t at = 8; file.size() - at >= 12;) {
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length = length << 8 | static_cast<std::uint8_t>(file[at + i]);
    if (length > file.size() - at - 12) return false;
    if (file.substr(at + 4, 4) == "IEND") return true;
    at += 12 + static_cast<std::size_t>(length);
  }
  return false;
}

/// A libpng reader that is destroyed with its scope.
struct Reader {
  explicit Reader(Stream& stream)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &stream, on_error, on_warning)),
        info(png ? png_create_info_struct(png) : nullptr) {}
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  png_structp png;
  png_infop info;
};

}  // namespace

Result<std::vector<std::byte>> encode_png(const PixelView& image, std::span<const PngText> text) {
  SKERRY_ASSERT(image.channels == 3 || image.channels == 4);
  SKERRY_ASSERT(image.pixels.size() == std::size_t{image.width} * image.height * image.channels);
  if (image.width == 0 || image.height == 0)
    return Error{"cannot make a PNG: the picture has no pixels; ask for at least 1x1"};
  std::optional<std::vector<std::byte>> bytes = encode_plain_png(image, text);
  if (!bytes)
    return Error{"cannot make a PNG: out of memory; free some or ask for a smaller picture"};
  return *std::move(bytes);
}

Result<void> write_png(const std::filesystem::path& path, const PixelView& image,
                       std::span<const PngText> text) {
  const Result<std::vector<std::byte>> bytes = encode_png(image, text);
  if (!bytes) return bytes.error();
  return write_file(path, *bytes);
}

Result<PngImage> read_png(const std::filesystem::path& path) {
  const Result<std::string> file = read_text(path, kMaxPngFileBytes);
  if (!file) return file.error();
  return decode_png(*file, quoted_path(path));
}

Result<PngImage> decode_png(std::string_view file, std::string_view name) {
  if (std::optional<PngImage> image = read_plain_png(file)) return *std::move(image);
  const auto failed = [&](const char* why) {
    return Error{fmt::format("cannot read {}: {}; give an undamaged PNG", name, why)};
  };
  if (file.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, 8) != 0)
    return failed("it is not a PNG");
  if (!chunks_fit(file)) return failed("it is cut short, or a chunk states a wrong length");
  Stream stream;
  stream.in = file;
  Reader reader(stream);
  if (!reader.info) return failed("out of memory");
  if (!decode_header(reader.png, reader.info, stream)) return failed(stream.message);
  PngImage image;
  image.width = png_get_image_width(reader.png, reader.info);
  image.height = png_get_image_height(reader.png, reader.info);
  const std::size_t stride = std::size_t{image.width} * 4;
  image.pixels.resize(stride * image.height);
  std::vector<png_bytep> rows(image.height);
  for (std::uint32_t row = 0; row < image.height; ++row)
    rows[row] = image.pixels.data() + row * stride;
  if (!decode_rows(reader.png, reader.info, rows.data())) return failed(stream.message);
  png_textp texts = nullptr;
  const int count = png_get_text(reader.png, reader.info, &texts, nullptr);
  for (int i = 0; i < count; ++i) image.text.push_back({texts[i].key, texts[i].text});
  return image;
}

}  // namespace skerry::platform
