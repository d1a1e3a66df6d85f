#include "engine/platform/image_file.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <new>
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

/// Where a libpng writer puts its bytes, and the message of a failure.
struct Sink {
  std::vector<std::byte> out;
  char message[128] = {};
};

void on_write_error(png_structp png, png_const_charp message) {
  auto* sink = static_cast<Sink*>(png_get_error_ptr(png));
  std::strncpy(sink->message, message, sizeof sink->message - 1);
  png_longjmp(png, 1);
}

void on_write(png_structp png, png_bytep data, std::size_t size) {
  std::vector<std::byte>& out = static_cast<Sink*>(png_get_io_ptr(png))->out;
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  bool room = true;
  try {
    out.insert(out.end(), bytes, bytes + size);
  } catch (const std::bad_alloc&) {
    room = false;  // no jump may leave this block
  }
  if (!room) png_error(png, "out of memory");
}

/// A libpng writer that is destroyed with its scope.
struct Writer {
  explicit Writer(Sink& sink)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, on_write_error, on_warning)),
        info(png ? png_create_info_struct(png) : nullptr) {}
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  png_structp png;
  png_infop info;
};

/// Row by row, so that nothing takes memory but what comes out.
bool encode_rows(png_structp png, png_infop info, Sink& sink, const PixelView& image,
                 std::span<png_text> texts) {
  // Of levels and filters the one that writes rendered pictures in the time of libdeflate's level
  // 3, of which it makes a tenth more bytes.
  constexpr int kLevel = 2;
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, &sink, on_write, nullptr);
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_compression_level(png, kLevel);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, image.width, image.height, 8,
               image.channels == 4 ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, info);
  const std::size_t stride = std::size_t{image.width} * image.channels;
  for (std::uint32_t row = 0; row < image.height; ++row)
    png_write_row(png, image.pixels.data() + row * stride);
  png_write_end(png, info);
  return true;
}

bool is_ascii(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return c == '\n' || (c >= 32 && c < 127); });
}

/// As libpng takes it, which changes none of it.
png_text libpng_text(const PngText& text) {
  SKERRY_ASSERT(!text.key.empty() && text.key.size() < 80 && is_ascii(text.key));
  const bool ascii = is_ascii(text.text);
  png_text out{};
  out.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
  out.key = const_cast<char*>(text.key.c_str());
  out.text = const_cast<char*>(text.text.c_str());
  (ascii ? out.text_length : out.itxt_length) = text.text.size();
  return out;
}

}  // namespace

Result<std::vector<std::byte>> encode_png(const PixelView& image, std::span<const PngText> text) {
  SKERRY_ASSERT(image.channels == 3 || image.channels == 4);
  SKERRY_ASSERT(image.pixels.size() == std::size_t{image.width} * image.height * image.channels);
  if (image.width == 0 || image.height == 0)
    return Error{"cannot make a PNG: the picture has no pixels; ask for at least 1x1"};
  std::vector<png_text> texts;
  for (const PngText& one : text) texts.push_back(libpng_text(one));
  Sink sink;
  const Writer writer(sink);
  if (!writer.info || !encode_rows(writer.png, writer.info, sink, image, texts))
    return Error{fmt::format("cannot make a PNG: {}; free memory or ask for a smaller picture",
                             writer.info ? sink.message : "out of memory")};
  return std::move(sink.out);
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
