// skerry_sounds: synthesises all sounds and writes them as one file, at build time.
#include <cstdio>
#include <span>
#include <vector>

#include "engine/core/output.h"
#include "tools/sounds/sounds.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("skerry_sounds: no output given: usage is skerry_sounds FILE\n", stderr);
    return 2;
  }
  constexpr std::uint64_t kSeed = 1;
  const std::vector<std::uint8_t> bytes =
      skerry::sounds::encode(skerry::sounds::make_sounds(kSeed));
  if (const auto written = skerry::write_file(argv[1], std::as_bytes(std::span(bytes))); !written) {
    std::fprintf(stderr, "skerry_sounds: %s\n", written.error().message.c_str());
    return 1;
  }
  return 0;
}
