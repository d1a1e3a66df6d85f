// skerry_textures: paints the block textures and writes them as one file, at build time.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <vector>

#include "engine/core/output.h"
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

}  // namespace
}  // namespace skerry::textures

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("skerry_textures: no output given: usage is skerry_textures FILE\n", stderr);
    return 2;
  }
  using namespace skerry::textures;
  const std::vector<std::uint8_t> bytes = encode(paint_layers());
  if (const auto written = skerry::write_file(argv[1], std::as_bytes(std::span(bytes))); !written) {
    std::fprintf(stderr, "skerry_textures: %s\n", written.error().message.c_str());
    return 1;
  }
  return 0;
}
