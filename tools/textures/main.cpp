// skerry_textures: paints the block textures and writes them as one file, at build time.
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/scene/block_textures.h"
#include "tools/textures/layers.h"
#include "tools/textures/mips.h"

namespace skerry::textures {
namespace {

std::vector<std::uint8_t> encode(const std::vector<Layer>& layers) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint32_t word :
       {render::kBlockTexturesMagic, render::kBlockTexturesVersion,
        static_cast<std::uint32_t>(layers.size()), static_cast<std::uint32_t>(kEdge)}) {
    for (int shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<std::uint8_t>(word >> shift));
  }
  std::vector<std::vector<Mip>> mips;
  for (const Layer& layer : layers) mips.push_back(make_mips(layer.canvas));
  for (std::size_t level = 0; level < mips[0].size(); ++level) {
    for (const auto& of_layer : mips)
      bytes.insert(bytes.end(), of_layer[level].rgba.begin(), of_layer[level].rgba.end());
  }
  return bytes;
}

Result<void> write_file(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  std::filesystem::path unfinished = path;
  unfinished += ".part";
  std::ofstream file(unfinished, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file)
    return Error{"cannot write " + unfinished.string() +
                 ": check that the folder exists and the disk has room"};
  std::error_code error;
  std::filesystem::rename(unfinished, path, error);
  if (error)
    return Error{"cannot rename " + unfinished.string() + ": " + error.message() +
                 "; check that the folder is writable"};
  return {};
}

}  // namespace
}  // namespace skerry::textures

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("skerry_textures: no output given: usage is skerry_textures FILE\n", stderr);
    return 2;
  }
  using namespace skerry::textures;
  if (const auto written = write_file(argv[1], encode(paint_layers())); !written) {
    std::fprintf(stderr, "skerry_textures: %s\n", written.error().message.c_str());
    return 1;
  }
  return 0;
}
