#include "tools/skerry/stability/case.h"

namespace skerry::tools::stability {

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const std::span<const Case> group :
       {coordinates_cases(), projection_cases(), shadows_cases(), finite_cases(), light_cases(),
        stored_light_cases(), rays_cases(), media_cases(), cloud_cases(), sky_cases(),
        panorama_cases(), exposure_cases(), physics_cases(), time_cases(), worlds_cases(),
        pace_cases()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace skerry::tools::stability
