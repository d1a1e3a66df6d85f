// libFuzzer's way in. The environment variable SKERRY_FUZZ_TARGET names the target.
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/targets.h"

namespace {

const skerry::fuzz::Target* chosen() {
  const char* wanted = std::getenv("SKERRY_FUZZ_TARGET");
  for (const skerry::fuzz::Target& target : skerry::fuzz::targets())
    if (wanted && target.name == wanted) return &target;
  return nullptr;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const skerry::fuzz::Target* const target = chosen();
  if (!target) std::abort();
  target->run({data, size});
  return 0;
}
