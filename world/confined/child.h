// What a program of process.h does with itself before it touches a file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

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

/// Writes all of it to the standard output; false: it could not.
bool write_to_output(std::span<const std::byte> bytes);

/// Forgets what the standard output has taken; false: it cannot.
bool empty_output();

}  // namespace skerry::world
