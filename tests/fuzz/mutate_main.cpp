// A short, repeatable run of every fuzz target: the seeds, then so many mutations of each.
//   skerry_fuzz_short SEEDS_FOLDER MUTATIONS
// SEEDS_FOLDER/TARGET holds a target's seeds. Same arguments, same inputs.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string_view>
#include <vector>

#include "tests/fuzz/targets.h"

namespace skerry::fuzz {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> seeds_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files(std::filesystem::directory_iterator(folder), {});
  std::sort(files.begin(), files.end());
  std::vector<Bytes> out;
  for (const std::filesystem::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    out.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return out;
}

/// Not <random>'s distributions: theirs differ from library to library.
std::size_t below(std::mt19937_64& random, std::size_t count) {
  return static_cast<std::size_t>(random() % count);
}

void mutate(Bytes& bytes, const Bytes& other, std::mt19937_64& random) {
  const std::size_t at = below(random, bytes.size() + 1);
  const std::size_t length = std::min(bytes.size() - at, 1 + below(random, 16));
  const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  switch (random() % 5) {
    case 0:
      if (at < bytes.size()) bytes[at] ^= static_cast<std::uint8_t>(1u << below(random, 8));
      break;
    case 1:
      if (at < bytes.size()) bytes[at] = static_cast<std::uint8_t>(random());
      break;
    case 2:
      bytes.erase(first, first + static_cast<std::ptrdiff_t>(length));
      break;
    case 3: {
      const Bytes piece(first, first + static_cast<std::ptrdiff_t>(length));
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(random, bytes.size() + 1)),
                   piece.begin(), piece.end());
      break;
    }
    default:
      bytes.resize(at);
      bytes.insert(bytes.end(),
                   other.begin() + static_cast<std::ptrdiff_t>(below(random, other.size() + 1)),
                   other.end());
  }
}

int run(const std::filesystem::path& folder, std::size_t mutations) {
  for (const Target& target : targets()) {
    const std::vector<Bytes> seeds = seeds_in(folder / target.name);
    if (seeds.empty()) {
      fmt::print(stderr, "skerry_fuzz_short: {} holds no seeds\n", (folder / target.name).string());
      return 2;
    }
    std::mt19937_64 random(1);
    for (const Bytes& seed : seeds) target.run(seed);
    for (std::size_t i = 0; i < mutations; ++i) {
      Bytes bytes = seeds[below(random, seeds.size())];
      for (std::size_t round = 1 + below(random, 4); round > 0; --round)
        mutate(bytes, seeds[below(random, seeds.size())], random);
      target.run(bytes);
    }
    fmt::print("{}: {} inputs\n", target.name, seeds.size() + mutations);
  }
  return 0;
}

}  // namespace
}  // namespace skerry::fuzz

int main(int count, char** arguments) {
  const std::string_view number = count == 3 ? arguments[2] : "";
  std::size_t mutations = 0;
  const auto end = number.data() + number.size();
  if (number.empty() || std::from_chars(number.data(), end, mutations).ptr != end) {
    fmt::print(stderr, "skerry_fuzz_short: use skerry_fuzz_short SEEDS_FOLDER MUTATIONS\n");
    return 2;
  }
  return skerry::fuzz::run(arguments[1], mutations);
}
