// What a program of process.h does with itself before it touches a file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/result.h"

namespace skerry::world {

/// The words MEMORY_BYTES ANSWER_BYTES CPU_SECONDS read | write FILE of its command line.
struct ConfinedJob {
  std::uint64_t memory_bytes = 0, answer_bytes = 0, cpu_s = 0;
  std::string_view path;  ///< to write; empty: it reads

  bool writes() const { return !path.empty(); }
};

/// Parses a command line, the program's name included; none: it is not such a one.
std::optional<ConfinedJob> parse_job(std::span<char*> words);

/// Limits of this process's memory, processor time and output from here on; it ends when its parent
/// does, and gains no rights.
void confine(const ConfinedJob& job);

/// What a deed of a library returns, a Result; errors in place of what the library throws.
/// @param library as messages name it.
template <class Deed>
auto guarded(const char* library, const Deed& deed) -> decltype(deed()) {
  try {
    return deed();
  } catch (const std::bad_alloc&) {
    return Error{"it needs more memory than is allowed; it is damaged or too large"};
  } catch (const std::exception& error) {
    return Error{std::string(library) + " gave up on it (" + error.what() +
                 "); copy or write it again"};
  }
}

/// Writes all of it to the standard output; false: it could not.
bool write_to_output(std::span<const std::byte> bytes);

/// Forgets what the standard output has taken; false: it cannot.
bool empty_output();

}  // namespace skerry::world
