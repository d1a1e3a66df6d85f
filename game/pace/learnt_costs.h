// What was learnt of a machine, kept beside its compiled shaders.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"

namespace skerry::game {

/// Costs of points of quality_front() on one machine.
struct LearntCosts {
  std::size_t point = 0;                        ///< the one chosen last
  std::vector<std::optional<double>> costs_ms;  ///< by point
};

/// "NAME, DRIVER, WxH".
std::string machine_name(std::string_view device, std::string_view driver, std::uint32_t width,
                         std::uint32_t height);

/// `quality.json` in the user's cache folder; empty if there is none.
std::filesystem::path learnt_costs_path();
/// What a file says of a machine; none: nothing. Points that the front no longer has are left out.
/// Errors: the file cannot be read, or is not as save_learnt_costs writes it.
Result<std::optional<LearntCosts>> load_learnt_costs(const std::filesystem::path& path,
                                                     std::string_view machine);
/// Adds a machine to the file, or replaces what it says of it; of more than kMostMachines the
/// oldest goes. A file that cannot be understood is replaced. Errors: it cannot be written.
inline constexpr std::size_t kMostMachines = 8;
Result<void> save_learnt_costs(const std::filesystem::path& path, std::string_view machine,
                               const LearntCosts& learnt);

}  // namespace skerry::game
