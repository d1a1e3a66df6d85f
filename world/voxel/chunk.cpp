#include "world/voxel/chunk.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <numeric>

#include "engine/core/check.h"

namespace skerry::world {
namespace {

constexpr int kDirectBits =
    16;  // the words hold ids themselves, so that set() never searches a long palette
constexpr std::size_t kIdCount = std::size_t{1} << kDirectBits;

std::span<const BlockId> identity_palette() {
  static const std::vector<BlockId> ids = [] {
    std::vector<BlockId> all(kIdCount);
    std::iota(all.begin(), all.end(), BlockId{0});
    return all;
  }();
  return ids;
}

/// Smallest allowed index width for this many palette entries.
int bits_for(std::size_t entries) {
  if (entries <= 1) return 0;
  if (entries <= 2) return 1;
  if (entries <= 4) return 2;
  if (entries <= 16) return 4;
  return entries <= 256 ? 8 : kDirectBits;
}

std::uint32_t read(const std::vector<std::uint64_t>& words, int bits, std::size_t index) {
  const std::size_t bit = index * static_cast<std::size_t>(bits);
  return static_cast<std::uint32_t>(words[bit >> 6] >> (bit & 63)) & ((1u << bits) - 1u);
}

void write(std::vector<std::uint64_t>& words, int bits, std::size_t index, std::uint32_t value) {
  const std::size_t bit = index * static_cast<std::size_t>(bits);
  const std::uint64_t mask = ((std::uint64_t{1} << bits) - 1) << (bit & 63);
  std::uint64_t& word = words[bit >> 6];
  word = (word & ~mask) | (static_cast<std::uint64_t>(value) << (bit & 63));
}

std::size_t word_count(int bits) {
  return kChunkVoxels * static_cast<std::size_t>(bits) / 64;
}

}  // namespace

Chunk::Chunk(BlockId fill) : palette_{fill} {}

Chunk Chunk::from_voxels(std::span<const BlockId> voxels) {
  SKERRY_ASSERT(voxels.size() == kChunkVoxels);
  // Runs of one id are the rule, so only a change of id looks at the set.
  static thread_local std::bitset<kIdCount> present;
  static thread_local std::array<std::uint8_t, kIdCount> slot_of;
  Chunk chunk(voxels[0]);
  present.set(voxels[0]);
  slot_of[voxels[0]] = 0;
  for (std::size_t i = 1; i < kChunkVoxels; ++i) {
    const BlockId id = voxels[i];
    if (id == voxels[i - 1] || present.test(id)) continue;
    present.set(id);
    slot_of[id] = static_cast<std::uint8_t>(chunk.palette_.size());
    chunk.palette_.push_back(id);
  }
  for (const BlockId id : chunk.palette_) present.reset(id);
  chunk.bits_ = bits_for(chunk.palette_.size());
  if (chunk.bits_ == 0) return chunk;
  const bool direct = chunk.bits_ == kDirectBits;
  const std::size_t per_word = 64 / static_cast<std::size_t>(chunk.bits_);
  chunk.words_.resize(word_count(chunk.bits_));
  for (std::size_t w = 0; w < chunk.words_.size(); ++w) {
    std::uint64_t word = 0;
    for (std::size_t k = per_word; k-- > 0;) {
      const BlockId id = voxels[w * per_word + k];
      word = (word << chunk.bits_) | (direct ? id : slot_of[id]);
    }
    chunk.words_[w] = word;
  }
  if (direct) std::vector<BlockId>().swap(chunk.palette_);
  return chunk;
}

BlockId Chunk::at(std::size_t index) const {
  if (bits_ == 0) return palette_[0];
  const std::uint32_t value = read(words_, bits_, index);
  return bits_ == kDirectBits ? static_cast<BlockId>(value) : palette_[value];
}

void Chunk::widen() {
  const int bits = bits_for(palette_.size() + 1);
  std::vector<std::uint64_t> words(word_count(bits));
  for (std::size_t i = 0; bits_ != 0 && i < kChunkVoxels; ++i) {
    const std::uint32_t value = read(words_, bits_, i);
    write(words, bits, i, bits == kDirectBits ? palette_[value] : value);
  }
  words_ = std::move(words);
  bits_ = bits;
  if (bits == kDirectBits) std::vector<BlockId>().swap(palette_);
}

void Chunk::set(int x, int y, int z, BlockId id) {
  const std::size_t index = voxel_index(x, y, z);
  if (bits_ == kDirectBits) return write(words_, bits_, index, id);
  const auto found = std::find(palette_.begin(), palette_.end(), id);
  const auto slot = static_cast<std::uint32_t>(found - palette_.begin());
  if (found == palette_.end()) {
    if (palette_.size() == std::size_t{1} << bits_) widen();
    if (bits_ == kDirectBits) return write(words_, bits_, index, id);
    palette_.push_back(id);
  } else if (bits_ == 0) {
    return;
  }
  write(words_, bits_, index, slot);
}

std::span<const BlockId> Chunk::palette() const {
  return bits_ == kDirectBits ? identity_palette() : std::span<const BlockId>(palette_);
}

void Chunk::unpack(std::span<BlockId> out) const {
  SKERRY_ASSERT(out.size() == kChunkVoxels);
  if (bits_ == 0) {
    std::fill(out.begin(), out.end(), palette_[0]);
    return;
  }
  const std::size_t per_word = 64 / static_cast<std::size_t>(bits_);
  const std::uint64_t mask = (std::uint64_t{1} << bits_) - 1;
  const bool direct = bits_ == kDirectBits;
  BlockId* to = out.data();
  for (std::uint64_t word : words_) {
    for (std::size_t k = 0; k < per_word; ++k, word >>= bits_) {
      *to++ = direct ? static_cast<BlockId>(word & mask) : palette_[word & mask];
    }
  }
}

std::size_t Chunk::size_bytes() const {
  return sizeof(*this) + palette_.capacity() * sizeof(BlockId) +
         words_.capacity() * sizeof(std::uint64_t);
}

}  // namespace skerry::world
