// What `skerry report` measures: tables. A new topic is an entry in topics.cpp.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "tools/skerry/shade/stored_light.h"

namespace skerry::tools {

/// A view that a topic is judged in.
struct ReportScene {
  std::string_view name;     ///< lower-case words joined by _
  std::string_view meaning;  ///< what is seen, in a few words
  std::string_view json;     ///< as a scene file (docs/settings.md), without size and quality
};

/// One setting of a sweep.
struct TopicPoint {
  std::string_view label;
  std::string_view settings;  ///< KEY=VALUE, several apart by spaces; over the scene's
  /// Of CostOf::kSkyTables: render::AtmosphereSettings::degree, which no setting changes.
  std::optional<int> sky_degree = {};
  /// Of CostOf::kStoredLight: what is kept of the light on surfaces, which no setting changes.
  std::optional<LightDetail> light = {};
};

/// What the errors of a topic are measured against.
enum class Judge : std::uint8_t {
  kReference,          ///< the CPU reference
  kLimit,              ///< the last point, the most exact of the sweep
  kLimitAndReference,  ///< the last point; how far each is from the CPU reference is reported, too
  kEqual,              ///< the last point, which every other must equal in each byte
};

/// What a point costs.
enum class CostOf : std::uint8_t {
  kFrame,        ///< GPU time of a whole frame, every shadow map drawn afresh
  kShading,      ///< GPU time of a frame that keeps the shadow maps of the one before
  kUpload,       ///< time from the first write of 8 MiB of chunk meshes until the GPU has them
  kSkyTables,    ///< CPU time of the tables of the atmosphere and of one eye's; no frame is drawn
  kStoredLight,  ///< CPU time of the light that stays on surfaces; no frame is drawn
};

struct Topic {
  std::string_view name;                     ///< lower-case words joined by _; names the files
  std::string_view meaning;                  ///< one line
  std::span<const TopicPoint> points;        ///< from cheap to exact
  std::span<const std::string_view> scenes;  ///< of report_scenes()
  Judge judge = Judge::kReference;
  CostOf cost = CostOf::kFrame;
  /// The settings decide what is loaded, so that each point loads the world for itself.
  bool loads = false;
  std::string_view reference_settings = {};  ///< for the reference alone, over the scene's
  /// Each point is exposed as it meters itself; else all as their judge is.
  bool own_exposures = false;
};

std::span<const ReportScene> report_scenes();
std::span<const Topic> topics();

/// nullptr: there is none of that name.
const ReportScene* find_report_scene(std::string_view name);
const Topic* find_topic(std::string_view name);

}  // namespace skerry::tools
