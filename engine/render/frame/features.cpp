#include "engine/render/frame/features.h"

namespace skerry::render {

FrameFeatures::FrameFeatures(const FeatureSet& left_out) {
  for (std::size_t i = 0; i < why_.size(); ++i)
    if (left_out.has(static_cast<Feature>(i))) why_[i] = "named in leave.out";
}

void FrameFeatures::set_absent(Feature feature, const char* why) {
  const char*& known = why_[static_cast<std::size_t>(feature)];
  if (!known) known = why;
}

Celestial sky_without(Celestial sky, const FeatureSet& left_out) {
  if (left_out.has(Feature::kSun)) {
    sky.sun_exists = false;
    sky.sun_irradiance = glm::vec3(0.0f);
    sky.sun_casts = false;
  }
  if (left_out.has(Feature::kMoon)) {
    sky.moon_exists = false;
    sky.moon_irradiance = glm::vec3(0.0f);
    sky.moon_casts = false;
    sky.to_moon = {0.0, -1.0, 0.0};  // where it hides no stars
  }
  return sky;
}

}  // namespace skerry::render
