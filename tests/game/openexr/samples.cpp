// The program skerry_exr_samples: writes .exr files as other programs do into a folder.
//   skerry_exr_samples FOLDER
// Texels are those of sample_values.h unless a name says otherwise.
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "tests/game/openexr/sample_values.h"

namespace skerry::game {
namespace {

constexpr int kColumns = kSampleColumns, kRows = kSampleColumns / 2;

/// Floats of all channels, and where they lie in a window.
struct Texels {
  Imath::Box2i window;
  std::vector<std::string> channels;
  std::vector<float> values;

  Texels(const Imath::Box2i& box, std::vector<std::string> names)
      : window(box), channels(std::move(names)) {
    for (std::size_t c = 0; c < channels.size(); ++c)
      for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x)
          values.push_back(sample_value(x, y, static_cast<int>(c) % 3));
  }

  float& at(int x, int y, std::size_t c) {
    const int columns = window.max.x - window.min.x + 1, rows = window.max.y - window.min.y + 1;
    return values[(c * static_cast<std::size_t>(rows) +
                   static_cast<std::size_t>(y - window.min.y)) *
                      static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(x - window.min.x)];
  }

  Imf::FrameBuffer buffer() {
    Imf::FrameBuffer out;
    const std::ptrdiff_t columns = window.max.x - window.min.x + 1;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      float* const origin =
          &at(window.min.x, window.min.y, c) - window.min.x - window.min.y * columns;
      out.insert(channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(origin), sizeof(float),
                                         static_cast<std::size_t>(columns) * sizeof(float)));
    }
    return out;
  }
};

Imath::Box2i window(int columns = kColumns, int rows = kRows) {
  return {{0, 0}, {columns - 1, rows - 1}};
}

Imf::Header header(const Texels& texels, Imf::Compression compression,
                   const Imath::Box2i& display) {
  Imf::Header out(display, texels.window);
  out.compression() = compression;
  for (const std::string& name : texels.channels) out.channels().insert(name, Imf::FLOAT);
  return out;
}

void write(const std::filesystem::path& path, Texels& texels, const Imf::Header& head) {
  Imf::OutputFile file(path.c_str(), head);
  file.setFrameBuffer(texels.buffer());
  file.writePixels(texels.window.max.y - texels.window.min.y + 1);
}

void write_tiled(const std::filesystem::path& path, Texels& texels, Imf::Header head) {
  head.setTileDescription(Imf::TileDescription(24, 20, Imf::MIPMAP_LEVELS));
  Imf::TiledOutputFile file(path.c_str(), head);
  for (int level = 0; level < file.numLevels(); ++level) {
    // Levels of one sample a texel: only the first may be read.
    file.setFrameBuffer(texels.buffer());
    file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  }
}

void write_deep(const std::filesystem::path& path) {
  Imf::Header head(window(), window());
  head.compression() = Imf::ZIPS_COMPRESSION;
  head.setType(Imf::DEEPSCANLINE);
  std::vector<unsigned> counts(std::size_t{kColumns} * kRows, 1u);
  std::vector<float> values(counts.size(), 1.0f);
  std::vector<float*> places;
  for (float& value : values) places.push_back(&value);
  Imf::DeepFrameBuffer buffer;
  buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()),
                                           sizeof(unsigned), sizeof(unsigned) * kColumns));
  for (const char* name : {"R", "G", "B"}) {
    head.channels().insert(name, Imf::FLOAT);
    buffer.insert(name, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(places.data()),
                                       sizeof(float*), sizeof(float*) * kColumns, sizeof(float)));
  }
  Imf::DeepScanLineOutputFile file(path.c_str(), head);
  file.setFrameBuffer(buffer);
  file.writePixels(kRows);
}

void write_parts(const std::filesystem::path& path) {
  Texels depth(window(), {"Z"}), colour(window(), {"R", "G", "B"});
  std::vector<Imf::Header> heads = {header(depth, Imf::ZIP_COMPRESSION, window()),
                                    header(colour, Imf::ZIP_COMPRESSION, window())};
  heads[0].setName("depth");
  heads[1].setName("colour");
  for (Imf::Header& head : heads) head.setType(Imf::SCANLINEIMAGE);
  Imf::MultiPartOutputFile file(path.c_str(), heads.data(), 2);
  Texels* const parts[] = {&depth, &colour};
  for (int i = 0; i < 2; ++i) {
    Imf::OutputPart part(file, i);
    part.setFrameBuffer(parts[i]->buffer());
    part.writePixels(kRows);
  }
}

void write_luminance_chroma(const std::filesystem::path& path) {
  Imf::RgbaOutputFile file(path.c_str(), Imf::Header(kColumns, kRows), Imf::WRITE_YC);
  std::vector<Imf::Rgba> texels(std::size_t{kColumns} * kRows, Imf::Rgba(1.0f, 0.5f, 0.25f));
  file.setFrameBuffer(texels.data(), 1, kColumns);
  file.writePixels(kRows);
}

void run(const std::filesystem::path& folder) {
  const struct {
    const char* name;
    Imf::Compression compression;
  } kinds[] = {{"none", Imf::NO_COMPRESSION},   {"rle", Imf::RLE_COMPRESSION},
               {"zips", Imf::ZIPS_COMPRESSION}, {"zip", Imf::ZIP_COMPRESSION},
               {"piz", Imf::PIZ_COMPRESSION},   {"pxr24", Imf::PXR24_COMPRESSION},
               {"dwaa", Imf::DWAA_COMPRESSION}, {"dwab", Imf::DWAB_COMPRESSION}};
  Texels rgb(window(), {"R", "G", "B"});
  for (const auto& kind : kinds)
    write(folder / (std::string(kind.name) + ".exr"), rgb, header(rgb, kind.compression, window()));

  Imf::Header head = header(rgb, Imf::ZIP_COMPRESSION, window());
  head.lineOrder() = Imf::DECREASING_Y;
  write(folder / "upwards.exr", rgb, head);
  write_tiled(folder / "tiled.exr", rgb, header(rgb, Imf::PIZ_COMPRESSION, window()));

  head = header(rgb, Imf::ZIP_COMPRESSION, window());
  for (const char* name : {"R", "G", "B"}) head.channels()[name].type = Imf::FLOAT;
  Imf::addChromaticities(head, Imf::Chromaticities({0.7347f, 0.2653f}, {0.0f, 1.0f},
                                                   {0.0001f, -0.077f}, {0.32168f, 0.33767f}));
  write(folder / "aces.exr", rgb, head);
  head = header(rgb, Imf::ZIP_COMPRESSION, window());
  Imf::addEnvmap(head, Imf::ENVMAP_CUBE);
  write(folder / "cube.exr", rgb, head);

  Texels grey(window(), {"Y"});
  write(folder / "grey.exr", grey, header(grey, Imf::ZIP_COMPRESSION, window()));
  Texels depth(window(), {"Z"});
  write(folder / "depth.exr", depth, header(depth, Imf::ZIP_COMPRESSION, window()));
  Texels part({{3, 5}, {40, 20}}, {"R", "G", "B"});
  write(folder / "part.exr", part, header(part, Imf::ZIP_COMPRESSION, window()));
  // A display window that begins elsewhere, and data beyond it.
  Texels beyond({{-4, -2}, {kColumns + 3, kRows + 1}}, {"R", "G", "B"});
  write(folder / "beyond.exr", beyond, header(beyond, Imf::ZIP_COMPRESSION, window()));
  Texels wide(window(kColumns * 2, kRows), {"R", "G", "B"});
  write(folder / "wide.exr", wide, header(wide, Imf::ZIP_COMPRESSION, wide.window));
  Texels odd(window(), {"R", "G", "B"});
  odd.at(1, 0, 0) = std::numeric_limits<float>::quiet_NaN();
  odd.at(2, 0, 1) = std::numeric_limits<float>::infinity();
  odd.at(3, 0, 2) = -1.0f;
  write(folder / "odd.exr", odd, header(odd, Imf::ZIP_COMPRESSION, window()));
  Texels huge({{0, 0}, {0, 0}}, {"R", "G", "B"});
  write(folder / "huge.exr", huge, header(huge, Imf::ZIP_COMPRESSION, window(200000, 100000)));
  write_deep(folder / "deep.exr");
  write_parts(folder / "parts.exr");
  write_luminance_chroma(folder / "chroma.exr");
}

}  // namespace
}  // namespace skerry::game

int main(int count, char** words) {
  if (count != 2) return 2;
  skerry::game::run(words[1]);
}
