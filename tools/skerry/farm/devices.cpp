#include "tools/skerry/farm/devices.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/features.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/farm/cpu_share.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

Error no_process() {
  return {fmt::format("cannot start a process: {}; close other programs", std::strerror(errno))};
}

/// Ends with its parent.
[[noreturn]] void leave(int status) {
  std::fflush(nullptr);
  ::_exit(status);
}

pid_t fork_child() {
  std::fflush(nullptr);  // or the child would write it again
  const pid_t process = ::fork();
  if (process == 0) ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  return process;
}

int status_of(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// "0 1 3", or a line of error.
std::string list_text() {
  const Result<std::vector<gpu::DeviceInfo>> list = gpu::Device::list();
  if (!list) return list.error().message;
  const Result<std::vector<std::uint32_t>> alike = devices_alike(*list);
  return alike ? fmt::format("{}", fmt::join(*alike, " ")) : alike.error().message;
}

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> block;
  for (ssize_t got = 0; (got = ::read(descriptor, block.data(), block.size())) != 0;) {
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) break;
    text.append(block.data(), static_cast<std::size_t>(got));
  }
  return text;
}

/// Counters of all processes are one: a pipe that holds each task's number once. Reads of a pipe
/// are whole while its writer writes whole numbers.
std::optional<std::size_t> take_number(int descriptor) {
  std::uint64_t number = 0;
  ssize_t got = 0;
  while ((got = ::read(descriptor, &number, sizeof number)) < 0 && errno == EINTR) {
  }
  if (got != sizeof number) return std::nullopt;
  return number;
}

/// Writes all numbers, unless nobody is left to read them.
void give_numbers(int descriptor, std::size_t tasks) {
  for (std::uint64_t task = 0; task < tasks; ++task)
    while (::write(descriptor, &task, sizeof task) < 0)
      if (errno != EINTR) return;
}

}  // namespace

Result<std::vector<std::uint32_t>> devices_alike(const std::vector<gpu::DeviceInfo>& devices) {
  const Result<std::uint32_t> best = gpu::choose_device(devices, std::nullopt);
  if (!best) return best.error();
  const auto first = std::ranges::find(devices, *best, &gpu::DeviceInfo::index);
  std::vector<std::uint32_t> alike;
  for (const gpu::DeviceInfo& device : devices)
    if (device.missing.empty() && device.name == first->name && device.driver == first->driver)
      alike.push_back(device.index);
  return alike;
}

Result<std::vector<std::uint32_t>> devices_alike_here() {
  int ends[2];
  const pid_t process = ::pipe(ends) == 0 ? fork_child() : -1;
  if (process < 0) return no_process();
  if (process == 0) {
    const std::string text = list_text();
    leave(::write(ends[1], text.data(), text.size()) < 0 ? kFailed : kDone);
  }
  ::close(ends[1]);
  const std::string text = read_all(ends[0]);
  ::close(ends[0]);
  const int status = status_of(process);
  std::vector<std::uint32_t> devices;
  for (const std::string& word : game::split(text, ' ')) {
    const auto index = game::parse_integer(word, "a device", 0, 1023);
    if (!index)
      return Error{text.empty() ? "listing the Vulkan devices failed; update the driver" : text};
    devices.push_back(static_cast<std::uint32_t>(*index));
  }
  if (status != 0) return Error{"listing the Vulkan devices failed; update the driver"};
  return devices;
}

std::optional<Refusal> parse_devices(const std::optional<std::string>& text,
                                     const std::optional<std::string>& device,
                                     std::vector<std::uint32_t>& devices) {
  if (!text) {
    std::optional<std::uint32_t> one;
    if (auto refusal = parse_device(device, one)) return refusal;
    if (one) devices = {*one};
    return std::nullopt;
  }
  if (*text != "all")
    return Refusal{kUsage,
                   {fmt::format("--devices cannot be {}: give all, or one by --device N",
                                game::quote_text(*text))}};
  if (device) return Refusal{kUsage, {"--device and --devices exclude each other: leave out one"}};
  Result<std::vector<std::uint32_t>> found = devices_alike_here();
  if (!found) return Refusal{kNoDevice, found.error()};
  devices = *std::move(found);
  return std::nullopt;
}

int run_on_devices(std::span<const std::uint32_t> devices, std::size_t tasks,
                   const std::function<int(std::uint32_t device, const NextTask&)>& body) {
  int queue[2];
  if (::pipe(queue) != 0) return fail(kFailed, no_process());
  std::vector<pid_t> processes;
  int worst = kDone;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const pid_t process = fork_child();
    if (process == 0) {
      ::close(queue[1]);
      stay_on_cpu_share(i, devices.size());
      leave(body(devices[i], [&] { return take_number(queue[0]); }));
    }
    if (process > 0) processes.push_back(process);
    if (process < 0) worst = fail(kFailed, no_process());
  }
  ::close(queue[0]);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  give_numbers(queue[1], tasks);
  ::close(queue[1]);
  std::signal(SIGPIPE, before);
  for (const pid_t process : processes) {
    const int status = status_of(process);
    if (WIFSIGNALED(status))
      worst = std::max(worst, fail(kFailed, {fmt::format("a process that ran tasks was ended by "
                                                         "signal {}; run again what it has left",
                                                         WTERMSIG(status))}));
    else
      worst = std::max(worst, WEXITSTATUS(status));
  }
  return worst;
}

}  // namespace skerry::tools
