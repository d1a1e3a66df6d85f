#include "tools/skerry/farm/devices.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <set>

#include "tests/folder.h"
#include "tests/tools/farm/one_line.h"

namespace skerry::tools {
namespace {

using Indices = std::vector<std::uint32_t>;

std::vector<gpu::DeviceInfo> machine(
    std::initializer_list<std::pair<const char*, VkPhysicalDeviceType>> list) {
  std::vector<gpu::DeviceInfo> devices;
  for (const auto& [name, type] : list) {
    gpu::DeviceInfo device;
    device.index = static_cast<std::uint32_t>(devices.size());
    device.name = name;
    device.driver = "driver 1";
    device.type = type;
    devices.push_back(device);
  }
  return devices;
}

TEST(DevicesAlike, AreThoseOfTheBestOnesNameAndDriver) {
  constexpr auto kCpu = VK_PHYSICAL_DEVICE_TYPE_CPU, kGpu = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  EXPECT_EQ(*devices_alike(machine({{"cpu", kCpu}})), Indices{0});
  auto mixed = machine({{"cpu", kCpu}, {"a", kGpu}, {"b", kGpu}, {"a", kGpu}, {"a", kGpu}});
  EXPECT_EQ(*devices_alike(mixed), (Indices{1, 3, 4}));
  mixed[3].driver = "driver 2";
  EXPECT_EQ(*devices_alike(mixed), (Indices{1, 4}));
  mixed[4].missing = {"a feature"};
  EXPECT_EQ(*devices_alike(mixed), Indices{1});
  mixed[1].missing = mixed[2].missing = mixed[3].missing = {"a feature"};
  EXPECT_EQ(*devices_alike(mixed), Indices{0});
  mixed[0].missing = {"a feature"};
  expect_one_line(devices_alike(mixed), {"no usable Vulkan device"});
  expect_one_line(devices_alike({}), {"no usable Vulkan device"});
}

TEST(DevicesAlike, OfThisMachineAreFoundWithoutLoadingADriverHere) {
  const auto devices = devices_alike_here();
  ASSERT_TRUE(devices) << devices.error().message;
  EXPECT_FALSE(devices->empty());
}

TEST(ParseDevices, TakesAllOrOneByNumber) {
  Indices devices;
  EXPECT_FALSE(parse_devices({}, {}, devices));
  EXPECT_TRUE(devices.empty()) << "the best one";
  EXPECT_FALSE(parse_devices({}, "3", devices));
  EXPECT_EQ(devices, Indices{3});
  EXPECT_EQ(parse_devices("two", {}, devices)->status, 2);
  EXPECT_EQ(parse_devices("all", "3", devices)->status, 2);
}

/// Lines "DEVICE TASK" that processes added to a file.
std::multimap<std::uint32_t, std::size_t> lines_of(const std::filesystem::path& file) {
  std::multimap<std::uint32_t, std::size_t> lines;
  std::ifstream in(file);
  std::uint32_t device = 0;
  for (std::size_t task = 0; in >> device >> task;) lines.emplace(device, task);
  return lines;
}

void add_line(const std::filesystem::path& file, std::uint32_t device, std::size_t task) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT, 0600);
  const std::string line = fmt::format("{} {}\n", device, task);
  EXPECT_EQ(::write(descriptor, line.data(), line.size()), static_cast<ssize_t>(line.size()));
  ::close(descriptor);
}

TEST(RunOnDevices, GivesEachTaskToOneDevice) {
  const Folder folder;
  const Indices devices{1, 4, 6};
  constexpr std::size_t kTasks = 20000;  // more than a pipe holds
  const int status =
      run_on_devices(devices, kTasks, [&](std::uint32_t device, const NextTask& next) {
        while (const auto task = next()) {
          add_line(folder / "lines", device, *task);
          if (*task < 3) ::usleep(20000);  // so that each device gets one
        }
        return device == 4 ? 3 : 0;
      });
  EXPECT_EQ(status, 3) << "the highest";
  const auto lines = lines_of(folder / "lines");
  std::set<std::size_t> tasks;
  for (const auto& [device, task] : lines) tasks.insert(task);
  EXPECT_EQ(lines.size(), kTasks);
  EXPECT_EQ(tasks.size(), kTasks);
  EXPECT_EQ(*tasks.rbegin(), kTasks - 1);
  for (const std::uint32_t device : devices) EXPECT_GT(lines.count(device), 0u) << device;
}

TEST(RunOnDevices, GoesOnWithoutADeviceThatDies) {
  const Folder folder;
  const int status =
      run_on_devices(Indices{0, 1}, 50, [&](std::uint32_t device, const NextTask& next) {
        while (const auto task = next()) {
          if (device == 1) ::kill(::getpid(), SIGKILL);
          add_line(folder / "lines", device, *task);
          ::usleep(1000);
        }
        return 0;
      });
  EXPECT_EQ(status, 1);
  EXPECT_EQ(lines_of(folder / "lines").size(), 49u);
}

TEST(RunOnDevices, EndsWhenAllDie) {
  const auto die = [](std::uint32_t, const NextTask&) -> int {
    ::kill(::getpid(), SIGKILL);
    return 0;
  };
  EXPECT_EQ(run_on_devices(Indices{0, 1}, 100000, die), 1);
}

}  // namespace
}  // namespace skerry::tools
