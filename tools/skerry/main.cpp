#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "engine/platform/heap.h"
#include "tools/skerry/command_line.h"
#include "tools/skerry/scene/scene_device.h"

int main(int count, char** arguments) {
  using namespace skerry::tools;
  skerry::platform::keep_freed_memory();
  // A standard stream that is closed would be the next file that is opened.
  while (true) {
    const int descriptor = ::open("/dev/null", O_RDWR);
    if (descriptor > STDERR_FILENO) ::close(descriptor);
    if (descriptor < 0 || descriptor > STDERR_FILENO) break;
  }
  int status = kFailed;
  try {
    status = run_command_line({arguments + 1, arguments + count});
  } catch (const std::system_error& error) {
    return fail(kFailed, {std::string(error.what()) + "; check the disk and the standard output"});
  } catch (const std::bad_alloc&) {
    return fail(kFailed, {"out of memory; give it a smaller picture, file or view.distance"});
  } catch (const std::exception& error) {
    return fail(kFailed, {std::string("unexpected: ") + error.what() + "; please report it"});
  }
  if (std::fflush(stdout) == 0 || status != kDone) return status;
  return fail(kFailed, {"cannot write to the standard output; check where it leads"});
}
