#pragma once
#include <span>

#include "tools/skerry/test/pool_options.h"

namespace skerry::tools {

/// What a drawing process says first, once: a device, or why there is none.
struct Greeting {
  std::string error;  ///< empty: a device is open
  bool on_cpu = false;
};
/// And last.
struct Farewell {
  int validation_messages = 0;
};

/// What a drawing process may use.
struct Seat {
  std::optional<std::uint32_t> device;  ///< none: the best
  int threads = 1;                      ///< of the processor, when the device is the CPU
  int host_threads = 1;                 ///< when it is not: fewer processes are started then
};

/// The body of a drawing process: reads indices of scenes from `jobs`, a line each, until that
/// ends, and writes lines of JSON to `results`: a greeting, an outcome a job, a farewell.
void serve(int jobs, int results, std::span<const TestScene> scenes, const PoolOptions& options,
           const Seat& seat);

/// Each a line of JSON and back. @pre of the second: the line came from the first.
std::string line_of(const Greeting& greeting);
std::string line_of(const Outcome& outcome);
std::string line_of(const Farewell& farewell);
Greeting greeting_of(const std::string& line);
Outcome outcome_of(const std::string& line);
Farewell farewell_of(const std::string& line);

}  // namespace skerry::tools
