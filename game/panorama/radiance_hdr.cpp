#include "game/panorama/radiance_hdr.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "game/scene_file/parse.h"

namespace skerry::game {
namespace {

constexpr std::size_t kMostHeaderBytes = 65536;
using Rgbe = std::array<std::uint8_t, 4>;

/// What is left of a file.
struct Bytes {
  std::string_view rest;

  bool has(std::size_t count) const { return rest.size() >= count; }
  std::uint8_t next() {
    const auto byte = static_cast<std::uint8_t>(rest.front());
    rest.remove_prefix(1);
    return byte;
  }
  Rgbe next_texel() { return {next(), next(), next(), next()}; }
  /// Up to the next line feed, which is passed over; none: there is none.
  std::optional<std::string_view> line() {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view out = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return out;
  }
};

struct Header {
  std::uint32_t columns = 0, rows = 0;
  double exposure = 1.0;  ///< that all values have been multiplied with
};

Error damaged(std::string_view what) {
  return Error{fmt::format("{}; copy it again, or write it again with another program", what)};
}

Result<void> read_variable(std::string_view line, Header& header) {
  constexpr std::string_view kFormat = "FORMAT=", kExposure = "EXPOSURE=";
  if (line.starts_with(kFormat) && !line.substr(kFormat.size()).starts_with("32-bit_rle_rgbe"))
    return Error{fmt::format("its format is {}; convert it to 32-bit_rle_rgbe",
                             quote_text(line.substr(kFormat.size())))};
  if (!line.starts_with(kExposure)) return {};
  std::string_view number = line.substr(kExposure.size());
  while (!number.empty() && (number.front() == ' ' || number.front() == '+'))
    number.remove_prefix(1);
  while (!number.empty() && (number.back() == ' ' || number.back() == '\r'))
    number.remove_suffix(1);
  const Result<double> factor = parse_number(number, "its EXPOSURE", 1e-10, 1e10);
  if (!factor) return factor.error();
  header.exposure *= *factor;
  if (header.exposure >= 1e-10 && header.exposure <= 1e10) return {};
  return damaged("its EXPOSURE lines multiply to more than a picture can mean");
}

Result<void> read_size(std::string_view line, Header& header) {
  const std::vector<std::string> words = split(line, ' ');
  if (words.size() != 4 || words[0] != "-Y" || words[2] != "+X")
    return Error{
        fmt::format("its rows do not run from the top left ({}); write it with '-Y ROWS "
                    "+X COLUMNS'",
                    quote_text(line))};
  constexpr std::int64_t kMost = render::kMostPanoramaColumns;
  const Result<std::int64_t> rows = parse_integer(words[1], "its number of rows", 1, kMost / 2),
                             columns = parse_integer(words[3], "its number of columns", 1, kMost);
  if (!rows) return rows.error();
  if (!columns) return columns.error();
  if (Result<void> fits = render::check_panorama_shape(*columns, *rows); !fits) return fits;
  header.columns = static_cast<std::uint32_t>(*columns);
  header.rows = static_cast<std::uint32_t>(*rows);
  return {};
}

Result<Header> read_header(Bytes& bytes) {
  Header header;
  if (!bytes.rest.starts_with("#?")) return Error{"it is no Radiance picture; give a .hdr file"};
  const std::size_t whole = bytes.rest.size();
  while (const std::optional<std::string_view> line = bytes.line()) {
    if (whole - bytes.rest.size() > kMostHeaderBytes) return damaged("its header does not end");
    if (!line->empty() && *line != "\r") {
      if (Result<void> read = read_variable(*line, header); !read) return read.error();
      continue;
    }
    std::optional<std::string_view> size = bytes.line();
    if (!size) break;
    if (size->ends_with('\r')) size->remove_suffix(1);
    if (Result<void> read = read_size(*size, header); !read) return read.error();
    return header;
  }
  return damaged("it is cut short in its header");
}

/// A row whose four parts come one after another, each in runs of equal bytes or not.
/// @return false: it is cut short or does not fit.
bool read_parts(Bytes& bytes, std::vector<Rgbe>& row) {
  for (std::size_t part = 0; part < 4; ++part)
    for (std::size_t at = 0; at < row.size();) {
      if (!bytes.has(2)) return false;
      std::size_t count = bytes.next();
      const bool equal = count > 128;
      if (equal) count -= 128;
      if (count == 0 || count > row.size() - at || !bytes.has(equal ? 1 : count)) return false;
      const std::uint8_t value = equal ? bytes.next() : std::uint8_t{0};
      for (std::size_t i = 0; i < count; ++i) row[at++][part] = equal ? value : bytes.next();
    }
  return true;
}

/// A row of texels, in which (1, 1, 1, n) repeats the one before n times, several in a row by the
/// bytes of a number.
bool read_texels(Bytes& bytes, std::vector<Rgbe>& row) {
  unsigned shift = 0;
  for (std::size_t at = 0; at < row.size();) {
    if (!bytes.has(4)) return false;
    const Rgbe texel = bytes.next_texel();
    if (texel[0] != 1 || texel[1] != 1 || texel[2] != 1) {
      row[at++] = texel;
      shift = 0;
      continue;
    }
    const std::size_t count = shift < 24 ? std::size_t{texel[3]} << shift : row.size() + 1;
    if (at == 0 || count > row.size() - at) return false;
    for (std::size_t i = 0; i < count; ++i, ++at) row[at] = row[at - 1];
    shift += 8;
  }
  return true;
}

bool read_row(Bytes& bytes, std::vector<Rgbe>& row) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes.rest[i]); };
  const bool in_parts = row.size() >= 8 && row.size() < 32768 && bytes.has(4) && byte(0) == 2 &&
                        byte(1) == 2 && byte(2) < 128;
  if (!in_parts) return read_texels(bytes, row);
  if (std::size_t{byte(2)} * 256 + byte(3) != row.size()) return false;
  bytes.rest.remove_prefix(4);
  return read_parts(bytes, row);
}

/// The middle of what a texel stands for.
glm::vec3 decoded(const Rgbe& texel, double exposure) {
  if (texel[3] == 0) return glm::vec3(0.0f);
  const double unit = std::ldexp(1.0, texel[3] - 136) / exposure;
  return glm::vec3((glm::dvec3(texel[0], texel[1], texel[2]) + 0.5) * unit);
}

}  // namespace

Result<render::Panorama> read_radiance_hdr(std::string_view text) {
  Bytes bytes{text};
  const Result<Header> header = read_header(bytes);
  if (!header) return header.error();
  constexpr std::size_t kLeastRowBytes = 4;
  if (!bytes.has(kLeastRowBytes * header->rows)) return damaged("it is cut short");
  render::PanoramaMaker maker(header->columns, header->rows);
  std::vector<Rgbe> row(header->columns);
  std::vector<glm::vec3> texels(header->columns);
  for (std::uint32_t y = 0; y < header->rows; ++y) {
    if (!read_row(bytes, row))
      return damaged(
          fmt::format("it is cut short or damaged in row {} of {}", y + 1, header->rows));
    for (std::size_t i = 0; i < row.size(); ++i) texels[i] = decoded(row[i], header->exposure);
    maker.add_row(texels);
  }
  return maker.take();
}

}  // namespace skerry::game
