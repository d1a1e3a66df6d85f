#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

#include <optional>
#include <regex>

#include "engine/gpu/device/features.h"
#include "engine/gpu/transfer/readback.h"
#include "tests/gpu/test_device.h"

namespace skerry::gpu {
namespace {

DeviceInfo info(std::uint32_t index, VkPhysicalDeviceType type,
                std::vector<std::string> missing = {}) {
  DeviceInfo device;
  device.index = index;
  device.name = "device " + std::to_string(index);
  device.type = type;
  device.missing = std::move(missing);
  return device;
}

constexpr auto kCpu = VK_PHYSICAL_DEVICE_TYPE_CPU;
constexpr auto kDiscrete = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
constexpr auto kIntegrated = VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;

TEST(ChooseDevice, TheBestUsableKindWinsAndTheFirstOfEquals) {
  EXPECT_EQ(*choose_device(
                {info(0, kCpu), info(1, kIntegrated), info(2, kDiscrete), info(3, kDiscrete)}, {}),
            2u);
  EXPECT_EQ(*choose_device({info(0, kCpu), info(1, kDiscrete, {"Vulkan 1.3"})}, {}), 0u);
}

TEST(ChooseDevice, TheUserDecides) {
  EXPECT_EQ(*choose_device({info(0, kCpu), info(1, kDiscrete)}, 0), 0u);
}

TEST(ChooseDevice, FailuresNameWhatIsMissing) {
  const auto text = [](const std::vector<DeviceInfo>& devices,
                       std::optional<std::uint32_t> wanted) {
    const Result<std::uint32_t> chosen = choose_device(devices, wanted);
    return chosen ? std::string("chosen") : chosen.error().message;
  };
  EXPECT_EQ(text({info(0, kCpu)}, 1),
            "there is no Vulkan device 1: this machine has 1; `skerry devices` lists them");
  EXPECT_EQ(text({info(0, kCpu, {"depthClamp", "scalarBlockLayout"})}, 0),
            "Vulkan device 0 (device 0) cannot be used: it lacks depthClamp, scalarBlockLayout; "
            "`skerry devices` lists the others");
  EXPECT_NE(text({info(0, kDiscrete, {"VK_KHR_push_descriptor"})}, {})
                .find("device 0 lacks VK_KHR_push_descriptor"),
            std::string::npos);
}

TEST(DeviceList, ListsTheDeviceThatCreateOpens) {
  const Result<std::vector<DeviceInfo>> list = Device::list();
  ASSERT_TRUE(list) << list.error().message;
  const Result<std::unique_ptr<Device>> device = Device::create({});
  ASSERT_TRUE(device);
  const DeviceInfo& opened = (*device)->info();
  ASSERT_LT(opened.index, list->size());
  EXPECT_EQ((*list)[opened.index].name, opened.name);
  EXPECT_TRUE(opened.missing.empty());
  EXPECT_FALSE(opened.driver.empty());
}

TEST(DeviceList, AnIndexBeyondTheListIsAnError) {
  DeviceOptions options;
  options.index = 1000;
  EXPECT_FALSE(Device::create(options));
}

using DeviceTest = GpuTest;

TEST_F(DeviceTest, TwoDevicesAndAListLiveSideBySide) {
  Buffer mine =
      buffer("mine", 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  {
    const Result<std::unique_ptr<Device>> other = Device::create({});
    ASSERT_TRUE(other);
    ASSERT_TRUE(Device::list());
  }
  device().run_now([&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, mine.handle(), 0, 16, 0x01020304u);
  });
  mine.state = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_IMAGE_LAYOUT_UNDEFINED, true};
  const Result<std::vector<std::byte>> bytes = read_back(device(), mine, 12, 4);
  ASSERT_TRUE(bytes);
  EXPECT_EQ((*bytes)[0], std::byte{4});
}

TEST_F(DeviceTest, TheTimelineCountsSubmits) {
  const std::uint64_t before = device().next_value();
  device().run_now([](VkCommandBuffer) {});
  EXPECT_EQ(device().next_value(), before + 1);
  EXPECT_EQ(device().completed_value(), before);
}

TEST_F(DeviceTest, MemoryIsCountedByNameUntilTheGpuIsDone) {
  constexpr std::uint64_t kBytes = 1 << 20;
  Buffer kept = buffer("kept", kBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  {
    const Buffer gone = buffer("gone", 2 * kBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    ASSERT_EQ(device().memory_use().size(), 2u);
    EXPECT_EQ(device().memory_use()[0].name, "gone");
    EXPECT_EQ(device().memory_use()[0].bytes, gone.allocated_bytes());
  }
  device().collect();
  EXPECT_EQ(device().memory_use().size(), 2u) << "the frame being recorded may still use it";
  device().run_now([](VkCommandBuffer) {});
  ASSERT_EQ(device().memory_use().size(), 1u);
  EXPECT_EQ(device().memory_total(), kept.allocated_bytes());
}

TEST_F(DeviceTest, AssigningOverABufferRetiresTheOldOne) {
  Buffer b = buffer("first", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  b = buffer("second", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  device().run_now([](VkCommandBuffer) {});
  ASSERT_EQ(device().memory_use().size(), 1u);
  EXPECT_EQ(device().memory_use()[0].name, "second");
}

TEST_F(DeviceTest, SizesBeyondTheLimitsAreErrorsWithTheName) {
  const auto failure = [&](std::uint64_t bytes) {
    const Result<Buffer> made = device().create_buffer(
        {"arena", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::kDevice});
    return made ? std::string() : made.error().message;
  };
  EXPECT_NE(failure(0).find("'arena'"), std::string::npos);
  EXPECT_NE(failure(device().limits().max_storage_range + 1).find("'arena'"), std::string::npos);

  ImageDesc desc{.name = "picture",
                 .format = VK_FORMAT_R8G8B8A8_UNORM,
                 .extent = {16, 16},
                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
  EXPECT_TRUE(device().create_image(desc));
  for (const VkExtent2D bad : {VkExtent2D{0, 16}, VkExtent2D{16, 0},
                               VkExtent2D{device().limits().max_image_edge + 1, 16}}) {
    desc.extent = bad;
    const Result<Image> made = device().create_image(desc);
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message.find("'picture'"), std::string::npos);
  }
}

TEST_F(DeviceTest, MoreMemoryThanThereIsIsAnErrorThatSaysTheSize) {
  // A buffer for copies has no binding limit, so only memory says no. 1 PiB is beyond any device.
  const Result<Buffer> made = device().create_buffer(
      {"too much", 1ull << 50, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::kUpload});
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("MiB of device memory for 'too much'"), std::string::npos)
      << made.error().message;
}

TEST_F(DeviceTest, SamplersAreShared) {
  const Result<VkSampler> a = device().sampler({}), b = device().sampler({}),
                          c = device().sampler({.compare = true});
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(*a, *b);
  EXPECT_NE(*a, *c);
}

TEST(Validation, AMissingBarrierIsReportedAndCounted) {
  DeviceOptions options;
  options.validate = true;
  const Result<std::unique_ptr<Device>> made = Device::create(options);
  ASSERT_TRUE(made) << made.error().message;
  Device& device = **made;
  const Buffer b =
      *device.create_buffer({"raced", 64, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::kDevice});
  testing::internal::CaptureStderr();
  device.run_now([&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, b.handle(), 0, 64, 1);
    vkCmdFillBuffer(commands, b.handle(), 0, 64, 2);
  });
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(device.validation_message_count(), 1);
  // SYNC-HAZARD-WRITE-AFTER-WRITE of older layers, a WRITE_AFTER_WRITE hazard of newer ones.
  EXPECT_TRUE(std::regex_search(log, std::regex("WRITE.AFTER.WRITE"))) << log;
  EXPECT_NE(log.find("raced"), std::string::npos) << "objects carry their names: " << log;
}

TEST(DeviceDeathTest, AResourceThatOutlivesItsDeviceIsNamed) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(
      {
        Buffer late;
        const Result<std::unique_ptr<Device>> device = Device::create({});
        late = *(*device)->create_buffer(
            {"late", 64, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::kDevice});
      },
      "the resource 'late' outlives its device");
}

}  // namespace
}  // namespace skerry::gpu
