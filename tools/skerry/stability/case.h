// What a stability case is. Adding one: write a function that gives rows, and name it in the table
// at the end of its group's file.
#pragma once
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"

namespace skerry::tools::stability {

/// One measured quantity. All are written so that less is better: errors, counts of what should not
/// be.
struct Row {
  std::string quantity;   ///< what was measured, with its unit
  double bound = 0.0;     ///< the most that is right, by arithmetic, never by observation
  double observed = 0.0;  ///< NaN: it could not be measured, which never passes
  bool pass() const { return observed <= bound; }
};

using Rows = std::vector<Row>;

/// What a row observed, if what it judges was there (its positive control); else NaN, which never
/// passes. A picture of nothing has no error.
inline double if_shown(bool shown, double observed) {
  return shown ? observed : std::numeric_limits<double>::quiet_NaN();
}

/// An extreme, run with the program's own code. @return at least one row. Errors: it could not be
/// run.
struct Case {
  using OnCpu = Result<Rows> (*)();
  using OnDevice = Result<Rows> (*)(gpu::Device& device);

  std::string_view name;  ///< "group.case", unique
  std::variant<OnCpu, OnDevice> run;
  bool needs_device() const { return std::holds_alternative<OnDevice>(run); }
};

// One table a group; all of them, in this order, are what `skerry stability` runs.
std::span<const Case> coordinates_cases();
std::span<const Case> projection_cases();
std::span<const Case> shadows_cases();
std::span<const Case> finite_cases();
std::span<const Case> light_cases();
std::span<const Case> stored_light_cases();
std::span<const Case> rays_cases();
std::span<const Case> media_cases();
std::span<const Case> cloud_cases();
std::span<const Case> sky_cases();
std::span<const Case> panorama_cases();
std::span<const Case> exposure_cases();
std::span<const Case> physics_cases();
std::span<const Case> time_cases();
std::span<const Case> worlds_cases();
std::span<const Case> pace_cases();

/// Every case of the program.
std::vector<Case> all_cases();

}  // namespace skerry::tools::stability
