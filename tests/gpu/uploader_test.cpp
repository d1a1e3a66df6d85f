// Every way of uploading, read back from the device.
#include "engine/gpu/transfer/uploader.h"

#include <algorithm>
#include <random>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/transfer/readback.h"
#include "tests/gpu/test_device.h"

namespace skerry::gpu {
namespace {

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                      VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

std::vector<std::byte> noise(std::size_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 0xffu);
  return bytes;
}

class UploaderTest : public GpuTest, public testing::WithParamInterface<UploadPath> {
 protected:
  Buffer target(std::uint64_t bytes) {
    const bool mapped = GetParam() == UploadPath::kMapped;
    return buffer("target", bytes, kUsage, mapped ? Memory::kMapped : Memory::kDevice);
  }
  std::uint64_t send(Uploader& uploader, std::uint64_t budget = ~0ull) {
    std::uint64_t sent = 0;
    device().run_now([&](VkCommandBuffer commands) { sent = uploader.record(commands, budget); });
    return sent;
  }
  std::vector<std::byte> contents(Buffer& from) {
    Result<std::vector<std::byte>> bytes = read_back(device(), from, 0, from.size_bytes());
    EXPECT_TRUE(bytes);
    return *bytes;
  }
};

TEST_P(UploaderTest, SizesAroundTheUpdateLimitArriveWhole) {
  for (const std::size_t size : {4u, 65532u, 65536u, 65540u, 1u << 20}) {
    // A guard on both sides shows a write that strays.
    constexpr std::size_t kGuard = 64;
    Buffer to = target(size + 2 * kGuard);
    std::vector<std::byte> expected = noise(size + 2 * kGuard, 1);
    Uploader uploader(device(), GetParam());
    uploader.write<std::byte>(to, 0, expected);
    send(uploader);
    const std::vector<std::byte> middle = noise(size, 2);
    std::copy(middle.begin(), middle.end(), expected.begin() + kGuard);
    uploader.write<std::byte>(to, kGuard, middle);
    send(uploader);
    EXPECT_EQ(contents(to), expected) << size << " bytes";
  }
}

TEST_P(UploaderTest, ALaterWriteToTheSamePlaceWins) {
  Buffer to = target(1 << 18);
  std::vector<std::byte> expected(to.size_bytes());
  Uploader uploader(device(), GetParam());
  uploader.write<std::byte>(to, 0, expected);
  std::mt19937 random(3);
  for (std::uint32_t i = 0; i < 200; ++i) {
    const std::vector<std::byte> piece = noise((random() % 2000 + 1) * 4, i);
    const std::uint64_t offset = random() % ((to.size_bytes() - piece.size()) / 4 + 1) * 4;
    const auto place = expected.begin() + static_cast<std::ptrdiff_t>(offset);
    if (i % 5 == 0) {
      const std::byte byte = piece[0];
      uploader.fill(to, offset, piece.size(), static_cast<std::uint32_t>(byte) * 0x01010101u);
      std::fill_n(place, piece.size(), byte);
      continue;
    }
    std::copy(piece.begin(), piece.end(), place);
    uploader.write<std::byte>(to, offset, piece);
  }
  send(uploader);
  EXPECT_EQ(contents(to), expected);
}

TEST_P(UploaderTest, FillsKeepTheirTurnAndCountForNoBytes) {
  Buffer to = target(1 << 20);
  Uploader uploader(device(), GetParam());
  uploader.fill(to, 0, to.size_bytes(), 0x01020304u);
  EXPECT_EQ(uploader.pending_bytes(), 0u);
  uploader.write<std::byte>(to, 8, noise(1000, 1));
  uploader.fill(to, 500, 100, 0u);
  EXPECT_EQ(send(uploader, 16), 1000u) << "what comes in front of a write goes with it";
  send(uploader);
  std::vector<std::byte> expected(to.size_bytes());
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = static_cast<std::byte>(4 - i % 4);
  const std::vector<std::byte> written = noise(1000, 1);
  std::copy(written.begin(), written.end(), expected.begin() + 8);
  std::fill_n(expected.begin() + 500, 100, std::byte{0});
  EXPECT_EQ(contents(to), expected);
}

TEST_P(UploaderTest, ABudgetLeavesWholeWritesForLaterButMakesProgress) {
  Buffer to = target(4096);
  Uploader uploader(device(), GetParam());
  for (std::uint32_t i = 0; i < 4; ++i) uploader.write<std::byte>(to, i * 1000, noise(1000, i));
  EXPECT_EQ(uploader.pending_bytes(), 4000u);
  EXPECT_EQ(send(uploader, 2500), 2000u);
  EXPECT_EQ(send(uploader, 0), 1000u);
  EXPECT_EQ(uploader.pending_bytes(), 1000u);
  EXPECT_EQ(send(uploader), 1000u);
  EXPECT_EQ(send(uploader), 0u);
}

// Twice before a batch; what was sent, what waited and what is written past the old end all arrive,
// and no call but send() submits anything.
TEST_P(UploaderTest, AReplacedBufferKeepsWhatItHasAndWhatWaits) {
  std::vector<std::byte> expected = noise(1 << 16, 1);
  Buffer table = target(expected.size());
  Uploader uploader(device(), GetParam());
  uploader.write<std::byte>(table, 0, expected);
  send(uploader);
  const std::uint64_t submits = device().next_value();
  const auto write = [&](std::size_t offset, std::uint32_t seed) {
    const std::vector<std::byte> bytes = noise(4096, seed);
    uploader.write<std::byte>(table, offset, bytes);
    expected.resize(std::max(expected.size(), offset + bytes.size()));
    std::ranges::copy(bytes, expected.begin() + static_cast<std::ptrdiff_t>(offset));
  };
  write(256, 2);
  uploader.replace(table, target(1 << 17));
  write(1 << 16, 3);
  uploader.replace(table, target(1 << 18));
  write(2048, 4);
  EXPECT_EQ(device().next_value(), submits);
  EXPECT_EQ(send(uploader, 0), 4096u) << "bytes that are copied do not count";
  send(uploader);
  std::vector<std::byte> found = contents(table);
  EXPECT_EQ(found.size(), std::size_t{1} << 18);
  found.resize(expected.size());
  EXPECT_EQ(found, expected);
}

TEST_P(UploaderTest, ABatchWaitsForReadsBeforeAndIsSeenByReadsAfter) {
  Buffer to = target(4096), copy = buffer("copy", 4096, kUsage);
  Uploader uploader(device(), GetParam());
  const std::vector<std::byte> first = noise(4096, 5), second = noise(4096, 6);
  uploader.write<std::byte>(to, 0, first);
  send(uploader);
  // Synchronisation validation reports a missing barrier between the copy and either write.
  uploader.write<std::byte>(to, 0, second);
  FrameGraph graph(&device());
  graph.begin();
  BufferRef from = graph.import(to), out = graph.import(copy);
  graph.add_pass(
      "copy",
      [&](PassBuilder& b) {
        b.read(from, Use::kTransferRead);
        out = b.write(out, Use::kTransferWrite);
      },
      [&](Commands& c) { c.copy(from, out, 0, 0, 4096); });
  graph.compile();
  device().run_now([&](VkCommandBuffer commands) {
    graph.execute(commands, 0);
    uploader.record(commands, ~0ull);
  });
  EXPECT_EQ(contents(copy), first);
  EXPECT_EQ(contents(to), second);
}

TEST_P(UploaderTest, BytesGoTheWayThatWasAskedFor) {
  Buffer to = target(4096);
  Uploader uploader(device(), GetParam());
  uploader.write<std::byte>(to, 0, noise(4096, 1));
  send(uploader);
  const UploadBytes& sent = uploader.sent();
  EXPECT_EQ(sent.by_update, GetParam() == UploadPath::kUpdateBuffer ? 4096u : 0u);
  EXPECT_EQ(sent.by_staging, GetParam() == UploadPath::kStaging ? 4096u : 0u);
  EXPECT_EQ(sent.by_mapping, GetParam() == UploadPath::kMapped ? 4096u : 0u);
}

std::string way_name(const testing::TestParamInfo<UploadPath>& way) {
  constexpr const char* kNames[] = {"UpdateBuffer", "Staging", "Mapped"};
  return kNames[static_cast<int>(way.param)];
}

INSTANTIATE_TEST_SUITE_P(Ways, UploaderTest,
                         testing::Values(UploadPath::kUpdateBuffer, UploadPath::kStaging,
                                         UploadPath::kMapped),
                         way_name);

using MappedUploadTest = GpuTest;

TEST_F(MappedUploadTest, ABufferInFlightIsNotWrittenByTheCpu) {
  Buffer to = buffer("target", 4096, kUsage, Memory::kMapped);
  Uploader uploader(device(), UploadPath::kMapped);
  to.state.last_value = device().next_value();  // as the frame being recorded leaves it
  const std::vector<std::byte> bytes = noise(4096, 7);
  uploader.write<std::byte>(to, 0, bytes);
  device().run_now([&](VkCommandBuffer commands) { uploader.record(commands, ~0ull); });
  EXPECT_EQ(uploader.sent().by_mapping, 0u);
  EXPECT_EQ(uploader.sent().by_update, 4096u);
  EXPECT_EQ(*read_back(device(), to, 0, 4096), bytes);
}

using FillImageTest = GpuTest;

TEST_F(FillImageTest, EveryMipOfEveryLayerGetsItsTexels) {
  ImageDesc desc;
  desc.name = "blocks";
  desc.format = VK_FORMAT_R8G8B8A8_UNORM;
  desc.extent = {8, 4};
  desc.mips = 4;
  desc.layers = 3;
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
               VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  Image to = image(desc);
  const std::size_t texels_a_layer[] = {32, 8, 2, 1};
  const std::vector<std::byte> bytes = noise((32 + 8 + 2 + 1) * 3 * 4, 9);
  Uploader uploader(device(), UploadPath::kUpdateBuffer);
  ASSERT_TRUE(uploader.fill_image(to, bytes));
  EXPECT_EQ(to.state.layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  auto at = bytes.begin();
  for (std::uint32_t mip = 0; mip < 4; ++mip) {
    for (std::uint32_t layer = 0; layer < 3; ++layer) {
      const auto end = at + static_cast<std::ptrdiff_t>(texels_a_layer[mip] * 4);
      EXPECT_EQ(*read_back(device(), to, 4, mip, layer), std::vector<std::byte>(at, end))
          << mip << " " << layer;
      at = end;
    }
  }
}

}  // namespace
}  // namespace skerry::gpu
