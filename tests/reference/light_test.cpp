#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/reference/made_scenes.h"
#include "tools/reference/brdf.h"
#include "tools/reference/shade.h"

namespace skerry::reference {
namespace {

constexpr double kPi = std::numbers::pi;

/// Mean irradiance on level ground at a point, over a number of samples.
double ground_irradiance(const Scene& scene, glm::dvec3 point, std::uint32_t count) {
  const Tracer tracer(scene.islands);
  const Shader shader(scene, tracer);
  double sum = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(7, 3, i);
    sum += shader.irradiance({point, {0.0, 1.0, 0.0}}, sampler).x;
  }
  return sum / count;
}

TEST(ReferenceLight, ALitPlaneHasLambertsRadianceAtAnyDistanceAndAngle) {
  for (const double height : {0.5, 10.0, 900.0}) {
    for (const double angle : {0.0, 0.4, 1.1, 1.5}) {
      Scene scene =
          seen_from({0.5, height, 0.5}, {0.0, -1.0, 0.01}, {stone_floor()}, 6, 5.0 / height);
      scene.albedo = glm::dvec3(0.8, 0.5, 0.2);
      const glm::dvec3 irradiance(3.0, 2.0, 1.0);
      scene.bodies = {{{std::sin(angle), std::cos(angle), 0.0}, irradiance, 0.0}};
      const glm::dvec3 expected = irradiance * *scene.albedo / kPi * std::cos(angle);
      for (const glm::vec3& seen : render(scene, samples(2)).radiance.pixels)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], 1e-6 * expected[c]);
    }
  }
}

// Beer's law along the way, which is longer the more it slants; clear glass and water take nothing.
TEST(ReferenceLight, OfALampTakesTheColourOfStainedGlass) {
  const auto pane = [](world::BlockId id) {
    return Island{
        world::Volume::from_voxels({-8, 2, -8}, {8, 4, 8}, [id](world::IVec3) { return id; })};
  };
  for (const double aside : {0.0, 2.0, 4.0}) {
    const auto light_under = [&](world::BlockId id) {
      Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.01}, {pane(id)});
      Light lamp;
      lamp.position = {aside, 6.0, 0.0};
      lamp.intensity = {9.0, 8.0, 7.0};
      scene.lights = {lamp};
      const Tracer tracer(scene.islands);
      const Shader shader(scene, tracer);
      Sampler sampler(7, 3, 0);
      return shader.irradiance({{0.013, 0.0, 0.017}, {0.0, 1.0, 0.0}}, sampler);
    };
    const glm::dvec3 open = light_under(world::kAir), red = light_under(world::block::kRedGlass);
    const double way = std::hypot(aside - 0.013, 6.0, 0.017) / 6.0 * 2.0;
    const world::BlockType& type = world::block_types()[world::block::kRedGlass];
    for (int c = 0; c < 3; ++c) {
      const double sigma = static_cast<double>(type.absorption[static_cast<std::size_t>(c)]) +
                           static_cast<double>(type.scattering);
      EXPECT_GT(open[c], 0.0);
      EXPECT_NEAR(red[c], open[c] * std::exp(-sigma * way), 1e-9);
      EXPECT_EQ(light_under(world::block::kGlass)[c], open[c]);
      EXPECT_EQ(light_under(world::block::kWater)[c], open[c]);
    }
  }
}

TEST(ReferenceLight, FlatShadingLeavesTheAngleOut) {
  Scene scene = seen_from({0.5, 5.0, 0.5}, {0.0, -1.0, 0.01}, {stone_floor()});
  scene.bodies = {{{std::sin(1.2), std::cos(1.2), 0.0}, glm::dvec3(kPi), 0.0}};
  scene.flat_shading = true;
  for (const glm::vec3& seen : render(scene, samples(2)).radiance.pixels)
    EXPECT_NEAR(seen.x, 1.0, 1e-6);
}

TEST(ReferenceLight, InAWhiteFurnaceABlockCannotBeTold) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.3, -0.4, 1.0},
                          {single_block(world::block::kStone, {0.9, -1.2, 3.0})}, 16, 0.6);
  scene.islands[0].rotation = glm::mat3_cast(glm::angleAxis(0.7, glm::dvec3(0.0, 1.0, 0.0)));
  scene.environment = glm::dvec3(1.0);
  for (const glm::vec3& seen : render(scene, samples(32)).radiance.pixels)
    EXPECT_NEAR(seen.x, 1.0, 1e-6);
  scene.albedo = glm::dvec3(0.5);
  const ReferencePicture grey = render(scene, samples(32));
  EXPECT_NEAR(std::min_element(grey.radiance.pixels.begin(), grey.radiance.pixels.end(),
                               [](glm::vec3 a, glm::vec3 b) { return a.x < b.x; })
                  ->x,
              0.5, 1e-6);
}

// Two blocks and a floor light each other as much as the furnace does.
TEST(ReferenceLight, InAWhiteFurnaceNothingCanBeToldHoweverOftenLightBounces) {
  Scene scene = seen_from({0.0, 2.0, -4.0}, {0.2, -0.5, 1.0},
                          {stone_floor(), single_block(world::block::kStone, {0.5, 0.5, 0.5}),
                           single_block(world::block::kStone, {2.1, 0.5, 0.7})},
                          8, 0.5);
  scene.environment = glm::dvec3(1.0);
  scene.bounces = 1000;
  for (const glm::vec3& seen : render(scene, samples(8)).radiance.pixels)
    EXPECT_NEAR(seen.x, 1.0, 1e-6);
}

/// Walls one block thick about 6 x 4 x 5 blocks of air.
Island closed_room() {
  return {world::Volume::from_voxels({-1, -1, -1}, {7, 5, 6}, [](world::IVec3 v) {
    const bool air = v.x >= 0 && v.x < 6 && v.y >= 0 && v.y < 4 && v.z >= 0 && v.z < 5;
    return air ? world::kAir : world::BlockId{world::block::kStone};
  })};
}

// All that a lamp sends out falls on the walls, and of what falls on them a share rho falls on them
// again: F = flux + rho F. So walls receive flux / ((1 - rho) area) on average.
TEST(ReferenceLight, AClosedRoomHoldsTheLampsFluxOverOneMinusItsAlbedo) {
  for (const double rho : {0.0, 0.5, 0.8}) {
    Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {closed_room()});
    scene.albedo = glm::dvec3(rho);
    scene.bounces = 1000;
    scene.lights = {{.position = {2.3, 1.9, 2.6}, .intensity = glm::dvec3(1.0)}};
    const Tracer tracer(scene.islands);
    const Shader shader(scene, tracer);
    const glm::dvec3 size(6.0, 4.0, 5.0);
    const double area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    double sum = 0.0;
    constexpr std::uint32_t kCount = 40000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      // A wall as likely as it is large, then a place on it.
      const double lot = even(random) * area / 2.0;
      const int axis = lot < size.y * size.z ? 0 : lot < size.y * size.z + size.z * size.x ? 1 : 2;
      const bool far = even(random) < 0.5;
      glm::dvec3 point(even(random) * size.x, even(random) * size.y, even(random) * size.z);
      glm::dvec3 normal(0.0);
      point[axis] = far ? size[axis] - 1e-7 : 1e-7;
      normal[axis] = far ? -1.0 : 1.0;
      Sampler sampler(5, 9, i);
      sum += shader.irradiance({point, normal}, sampler).x;
    }
    const double expected = 4.0 * kPi / ((1.0 - rho) * area);
    EXPECT_NEAR(sum / kCount, expected, 0.02 * expected) << rho;
  }
}

// A glowing plant is a lamp among its own planes, where a point's light has no bound: it reflects
// what comes from other lamps alone.
TEST(ReferenceLight, APlantReflectsNoLightOfTheLampInItsOwnVoxel) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0},
                          {single_block(world::block::kGlowFern, {0.5, 0.5, 0.5})});
  scene.bounces = 1;
  const auto reflected = [&](glm::dvec3 lamp) {
    scene.lights = {{.position = lamp, .intensity = glm::dvec3(1.0)}};
    const Tracer tracer(scene.islands);
    const Shader shader(scene, tracer);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < 4000; ++i) {
      Sampler sampler(1, 2, i);
      // Lamps of any range are left out but for what is reflected of them.
      sum += shader.soft_irradiance({{-1.0, 0.5, 0.5}, {1.0, 0.0, 0.0}}, 0.0, sampler).x;
    }
    return sum / 4000.0;
  };
  EXPECT_EQ(reflected({0.5, 0.5, 0.5}), 0.0);
  EXPECT_EQ(reflected({0.5, 0.95, 0.5}), 0.0);
  EXPECT_GT(reflected({0.5, 1.05, 0.5}), 0.0);
}

// Seen itself it sends what it emits, and nothing of that lamp's light besides. A torch emits in
// part: its flame lights its stick.
TEST(ReferenceLight, APlantThatIsSeenReflectsNoLightOfTheLampThatItIs) {
  const auto seen = [](world::BlockId plant, std::vector<Light> lights) {
    Scene scene =
        seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {single_block(plant, {1.5, 0.0, 0.0})});
    scene.bounces = 0;
    scene.lights = std::move(lights);
    const Tracer tracer(scene.islands);
    const Shader shader(scene, tracer);
    double sum = 0.0;
    Trace trace;
    for (std::uint32_t i = 0; i < 400; ++i) {
      const glm::dvec3 to(1.5, 0.05 * (i % 20) - 0.475, 0.05 * (i / 20) - 0.475);
      const glm::dvec3 direction = glm::normalize(to);
      tracer.trace(glm::dvec3(0.0), direction, trace);
      Sampler sampler(1, 2, i);
      sum += shader.look(trace, direction, direction, sampler).radiance.x;
    }
    return sum;
  };
  const auto lamp = [](double height) {
    return std::vector<Light>{{.position = {1.5, height, 0.0}, .intensity = glm::dvec3(1.0)}};
  };
  const double emitted = seen(world::block::kGlowFern, {});
  EXPECT_GT(emitted, 0.0);
  EXPECT_EQ(seen(world::block::kGlowFern, lamp(0.0)), emitted);
  EXPECT_GT(seen(world::block::kGlowFern, lamp(1.0)), emitted);
  EXPECT_GT(seen(world::block::kTorch, lamp(0.4)), seen(world::block::kTorch, {}));
}

// Under a sky of radiance 1 an open plane receives pi; at the foot of a wall without end half of
// that comes from the sky, and the wall sends back rho times its own half.
TEST(ReferenceLight, AWallOfAlbedoRhoGivesBackItsHalfOfTheSky) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {stone_floor(3)});
  scene.environment = glm::dvec3(1.0);
  EXPECT_NEAR(ground_irradiance(scene, {0.0, 1e-7, 0.0}, 100), kPi, 1e-9);
  scene.islands = {{world::Volume::from_voxels({0, -1, -400}, {1, 800, 400}, [](world::IVec3) {
    return world::BlockId{world::block::kStone};
  })}};
  // The wall alone: it sees half of the sphere beyond it, all of it sky.
  for (const double rho : {0.0, 0.5}) {
    scene.albedo = glm::dvec3(rho);
    scene.bounces = 1;
    EXPECT_NEAR(ground_irradiance(scene, {-1e-4, 1e-7, 0.0}, 40000), kPi * (0.5 + 0.5 * rho),
                0.02 * kPi)
        << rho;
  }
}

TEST(ReferenceLight, FalloffOfAPointIsTheInverseSquare) {
  for (const double height : {0.1, 1.0, 7.0, 1000.0}) {
    Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {});
    scene.lights = {{.position = {0.0, height, 0.0}, .intensity = glm::dvec3(5.0)}};
    EXPECT_NEAR(ground_irradiance(scene, glm::dvec3(0.0), 1), 5.0 / (height * height),
                1e-12 / (height * height));
    // Sideways by as much: cosine 1/sqrt(2), twice the square of the distance.
    EXPECT_NEAR(ground_irradiance(scene, {height, 0.0, 0.0}, 1),
                5.0 / (2.0 * height * height) * std::sqrt(0.5), 1e-12 / (height * height));
  }
}

TEST(ReferenceLight, ASphereAboveTheGroundLightsItAsAPointInItsMiddle) {
  for (const double radius : {0.01, 0.5, 1.9}) {
    Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {});
    scene.lights = {{.kind = shared::kLightSphere,
                     .position = {0.0, 2.0, 0.0},
                     .intensity = glm::dvec3(5.0),
                     .size = radius}};
    EXPECT_NEAR(ground_irradiance(scene, glm::dvec3(0.0), 4096), 5.0 / 4.0, 2e-3) << radius;
  }
}

TEST(ReferenceLight, ASphereIsItsRadianceTimesItsSolidAngleAtAnyTilt) {
  // E = pi L (r / d)^2 cos, as long as all of it is above the horizon (F. Nicodemus et al. 1977).
  for (const double angle : {0.0, 0.5, 1.0}) {
    for (const double radius : {0.1, 1.0}) {
      Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {});
      const double radiance = 3.0, distance = 4.0;
      scene.lights = {{.kind = shared::kLightSphere,
                       .position = glm::dvec3(std::sin(angle), std::cos(angle), 0.0) * distance,
                       .intensity = glm::dvec3(radiance * kPi * radius * radius),
                       .size = radius}};
      const double expected = kPi * radiance * std::pow(radius / distance, 2.0) * std::cos(angle);
      EXPECT_NEAR(ground_irradiance(scene, glm::dvec3(0.0), 4096), expected, 2e-3 * expected);
    }
  }
}

TEST(ReferenceLight, ATubeIsTheSumOfItsPoints) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {});
  const glm::dvec3 middle(0.7, 2.0, -0.4), axis = glm::normalize(glm::dvec3(1.0, 0.6, 0.2));
  scene.lights = {{.kind = shared::kLightTube,
                   .position = middle,
                   .intensity = glm::dvec3(5.0),
                   .size = 1.5,
                   .axis = axis}};
  double expected = 0.0;
  constexpr int kPoints = 100'000;
  for (int i = 0; i < kPoints; ++i) {
    const glm::dvec3 p = middle + axis * (1.5 * ((2.0 * i + 1.0) / kPoints - 1.0));
    expected += 5.0 / kPoints * p.y / std::pow(glm::length(p), 3.0);
  }
  EXPECT_NEAR(ground_irradiance(scene, glm::dvec3(0.0), 4096), expected, 1e-3 * expected);
}

TEST(ReferenceLight, AWindowEndsALightAtItsRangeAndLeavesTheNearBe) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {});
  for (const std::uint32_t kind : {shared::kLightPoint, shared::kLightSphere, shared::kLightTube}) {
    const auto at = [&](double height) {
      scene.lights = {{.kind = kind,
                       .position = {0.0, height, 0.0},
                       .intensity = glm::dvec3(1.0),
                       .range = 8.0,
                       .axis = {1.0, 0.0, 0.0}}};
      return ground_irradiance(scene, glm::dvec3(0.0), 1);
    };
    EXPECT_EQ(at(8.0), 0.0);
    EXPECT_EQ(at(9.0), 0.0);
    EXPECT_GT(at(7.99), 0.0);
    EXPECT_NEAR(at(4.0), std::pow(1.0 - std::pow(0.5, 4.0), 2.0) / 16.0, 1e-12);
    EXPECT_NEAR(at(0.08), 1.0 / 0.0064, 1e-4);
  }
}

TEST(ReferenceLight, ASpotIsFullInItsInnerConeAndEndsAtTheOuterOne) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {});
  Light spot{.kind = shared::kLightSpot,
             .position = {0.0, 2.0, 0.0},
             .intensity = glm::dvec3(4.0),
             .axis = {0.0, -1.0, 0.0},
             .cos_inner = std::cos(0.3),
             .cos_outer = std::cos(0.6)};
  const auto lit = [&](double angle) {  // over what a point would give there
    const glm::dvec3 place(2.0 * std::tan(angle), 0.0, 0.0);
    scene.lights = {spot};
    const double of_spot = ground_irradiance(scene, place, 1);
    scene.lights[0].kind = shared::kLightPoint;
    return of_spot / ground_irradiance(scene, place, 1);
  };
  EXPECT_EQ(lit(0.0), 1.0);
  EXPECT_EQ(lit(0.29), 1.0);
  EXPECT_EQ(lit(0.61), 0.0);
  const double middle = std::acos(0.5 * (std::cos(0.3) + std::cos(0.6)));
  EXPECT_NEAR(lit(middle), 0.5, 1e-9);
  spot.axis = {0.0, 1.0, 0.0};
  EXPECT_EQ(lit(0.0), 0.0) << "it looks away";
  spot.dual = true;
  EXPECT_EQ(lit(0.0), 1.0);
}

TEST(ReferenceLight, ADirectionalLightIsBlockedWithinItsRangeAlone) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0},
                          {single_block(world::block::kStone, {0.0, 6.0, 0.0})});
  scene.lights = {{.kind = shared::kLightDirectional,
                   .intensity = glm::dvec3(2.0),
                   .range = 5.0,
                   .axis = {0.0, -1.0, 0.0}}};
  EXPECT_EQ(ground_irradiance(scene, glm::dvec3(0.0), 1), 2.0);
  scene.lights[0].range = 6.0;
  EXPECT_EQ(ground_irradiance(scene, glm::dvec3(0.0), 1), 0.0);
}

TEST(ReferenceLight, TheVoxelALightStandsInHidesNothingAndItsNeighbourDoes) {
  for (const world::BlockId id :
       {world::BlockId{world::block::kLava}, world::BlockId{world::block::kTorch}}) {
    const Island blocks{
        world::Volume::from_voxels({0, 0, 0}, {2, 1, 1}, [id](world::IVec3) { return id; }),
        glm::dmat3(1.0),
        {-0.5, 4.0, -0.5}};  // over the ground: one about x = 0, one about x = 1
    Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {blocks});
    scene.lights = {{.position = {0.0, 4.5, 0.0}, .intensity = glm::dvec3(1.0)}};
    EXPECT_NEAR(ground_irradiance(scene, glm::dvec3(0.0), 1), 1.0 / 20.25, 1e-12);
    if (id != world::block::kLava) continue;
    // From the side the way leads through the other block first.
    EXPECT_EQ(ground_irradiance(scene, {9.0, 4.1, 0.0}, 1), 0.0);
    EXPECT_GT(ground_irradiance(scene, {-9.0, 4.1, 0.0}, 1), 0.0);
  }
}

TEST(ReferenceLight, TheGridFindsWhatReachesAPoint) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-60.0, 60.0), reach(0.1, 30.0);
  std::vector<Light> lights(300);
  for (Light& light : lights) {
    light.position = {place(random), place(random), place(random)};
    light.intensity = glm::dvec3(1.0);
    light.range = reach(random);
  }
  lights[7].range = 500.0;
  const LightGrid grid(lights);
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 point(place(random), place(random), place(random));
    std::set<const Light*> found;
    grid.reaching(point, [&](const Light& light) { found.insert(&light); });
    for (const Light& light : lights) {
      if (glm::length(light.position - point) >= light.range) continue;
      EXPECT_TRUE(found.contains(&light));
    }
    EXPECT_LT(found.size(), lights.size() / 2) << "it leaves out what cannot reach";
  }
}

TEST(ReferenceLight, AHiddenPointLightsNothing) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0},
                          {single_block(world::block::kStone, {0.0, 3.0, 0.0})});
  scene.lights = {{.position = {0.0, 6.0, 0.0}, .intensity = glm::dvec3(5.0)}};
  EXPECT_EQ(ground_irradiance(scene, glm::dvec3(0.0), 1), 0.0);
  scene.lights[0].position.y = 2.0;  // before the block
  EXPECT_GT(ground_irradiance(scene, glm::dvec3(0.0), 1), 0.0);
}

TEST(ReferenceLight, ASealedRoomIsExactlyBlackUnderManySuns) {
  const Island room{
      world::Volume::from_voxels(
          {-4, -4, -4}, {5, 5, 5},
          [](world::IVec3 v) {
            const bool wall = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) == 4;
            return world::BlockId{wall ? world::block::kStone : world::block::kAirBlock};
          }),
      glm::mat3_cast(glm::angleAxis(0.3, glm::dvec3(0.0, 1.0, 0.0)))};
  std::mt19937 random(5);
  Scene scene = seen_from({0.2, 0.4, -0.3}, {1.0, 0.2, 0.4}, {room}, 24, 1.5);
  for (int i = 0; i < 100; ++i)
    scene.bodies.push_back({random_direction(random), glm::dvec3(1e6), kBodyRadius});
  // One of each kind right behind the wall.
  const glm::dvec3 behind =
      scene.islands[0].rotation * glm::dvec3(5.3, 0.2, 0.1) + scene.islands[0].origin;
  for (std::uint32_t kind = 0; kind < shared::kLightKindCount; ++kind)
    scene.lights.push_back({.kind = kind,
                            .position = behind,
                            .intensity = glm::dvec3(1e9),
                            .size = 0.2,
                            .axis = glm::normalize(-behind),
                            .cos_inner = 0.9,
                            .cos_outer = 0.5});
  scene.environment = glm::dvec3(1e6);
  scene.haze_per_block = 0.1;
  const ReferencePicture picture = render(scene, samples(4));
  for (const glm::vec3& seen : picture.radiance.pixels) EXPECT_EQ(seen, glm::vec3(0.0f));
}

TEST(ReferenceLight, AHardShadowEndsAtTheAnalyticPlace) {
  // The block spans x 0..1 and ends at y = 3; the sun stands 50 degrees high in -x.
  const double height = glm::radians(50.0);
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0},
                          {single_block(world::block::kStone, {0.5, 2.5, 0.5})});
  scene.bodies = {{{-std::cos(height), std::sin(height), 0.0}, glm::dvec3(1.0), 0.0}};
  const double from = 2.0 / std::tan(height), to = 1.0 + 3.0 / std::tan(height);
  const auto lit = [&](double x) { return ground_irradiance(scene, {x, 0.0, 0.5}, 1) > 0.0; };
  for (const double off : {1e-9, 1e-4, 0.3}) {
    EXPECT_TRUE(lit(from - off));
    EXPECT_FALSE(lit(from + off));
    EXPECT_FALSE(lit(to - off));
    EXPECT_TRUE(lit(to + off));
  }
}

TEST(ReferenceLight, AnAreaSunsPenumbraIsTheVisiblePartOfItsDisc) {
  // A wide slab whose straight edge at x = 0 hides what of the zenith's sun stands at x > 0.
  const Island slab{world::Volume::from_voxels({0, 10, -20}, {20, 11, 20}, [](world::IVec3) {
    return world::BlockId{world::block::kStone};
  })};
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {slab});
  scene.bodies = {{{0.0, 1.0, 0.0}, glm::dvec3(1.0), kBodyRadius}};
  // Under the slab its lower edge hides the disc, beside it the upper one.
  const double under = 10.0 * std::tan(kBodyRadius), beside = 11.0 * std::tan(kBodyRadius);
  for (const double share : {-0.9, -0.5, 0.0, 0.3, 0.8}) {
    // The edge cuts the disc at `share` of its radius: area of the segment beyond.
    const double expected = 0.5 - (share * std::sqrt(1.0 - share * share) + std::asin(share)) / kPi;
    const double x = share * (share < 0.0 ? beside : under);
    EXPECT_NEAR(ground_irradiance(scene, {x, 0.0, 0.0}, 4096), expected, 2e-3) << share;
  }
  EXPECT_NEAR(ground_irradiance(scene, {-1.001 * beside, 0.0, 0.0}, 256), 1.0, 1e-4);
  EXPECT_EQ(ground_irradiance(scene, {1.001 * under, 0.0, 0.0}, 256), 0.0);
}

TEST(ReferenceLight, HazeOfAnUnshadowedRayHasItsClosedForm) {
  for (const double height : {1.0, 30.0, 5000.0}) {
    Scene scene = seen_from({0.0, height, 0.0}, {0.0, -1.0, 0.0}, {stone_floor()}, 1, 1e-6);
    scene.albedo = glm::dvec3(0.0);
    scene.environment = glm::dvec3(2.0);
    scene.bodies = {{{0.0, 1.0, 0.0}, glm::dvec3(1.0), kBodyRadius}};
    scene.haze_per_block = 0.002;
    const double expected = 2.0 * (1.0 - std::exp(-0.002 * height));
    EXPECT_NEAR(render(scene, samples(4)).radiance.pixels[0].x, expected, 1e-6 * expected);
  }
}

TEST(ReferenceLight, HazeIsLitOnlyWhereTheSunReachesIt) {
  // A roof over x 10..30 of a way of 60 blocks along +x.
  const Island roof{world::Volume::from_voxels(
      {10, 5, -9}, {30, 6, 9}, [](world::IVec3) { return world::BlockId{world::block::kStone}; })};
  const Island wall{world::Volume::from_voxels(
      {60, -9, -9}, {61, 9, 9}, [](world::IVec3) { return world::BlockId{world::block::kStone}; })};
  Scene scene = seen_from({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {roof, wall}, 1, 1e-6);
  scene.albedo = glm::dvec3(0.0);
  scene.environment = glm::dvec3(1.0);
  scene.bodies = {{{0.0, 1.0, 0.0}, glm::dvec3(1.0), 0.0}};
  scene.haze_per_block = 0.03;
  const auto clear = [](double blocks) { return std::exp(-0.03 * blocks); };
  const double expected = 1.0 - clear(10.0) + clear(30.0) - clear(60.0);
  EXPECT_NEAR(render(scene, samples(4096)).radiance.pixels[0].x, expected, 1e-3);
}

TEST(ReferenceLight, WaterTakesFresnelsAndBeersShareOfAWayThatSnellBends) {
  // Two blocks of water over lamps, looked down at from so far that there are no ripples.
  const Island pool{world::Volume::from_voxels({-9, -3, -9}, {9, 0, 9}, [](world::IVec3 v) {
    return world::BlockId{v.y == -3 ? world::block::kLamp : world::block::kWater};
  })};
  const world::BlockType& water = world::block_types()[world::block::kWater];
  const world::BlockType& lamp = world::block_types()[world::block::kLamp];
  for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * kPi / 180.0, cosine = std::cos(angle);
    const glm::dvec3 direction(std::sin(angle), -cosine, 0.0);
    const Scene scene =
        seen_from(glm::dvec3(0.5, 0.0, 0.5) - 600.0 * direction, direction, {pool}, 1, 1e-6);
    const glm::vec3 seen = render(scene, samples(1)).radiance.pixels[0];
    const double way = 2.0 / std::cos(std::asin(std::sin(angle) / 1.333));
    const double upright = std::pow(0.333 / 2.333, 2.0);
    const double reflected = upright + (1.0 - upright) * std::pow(1.0 - cosine, 5.0);
    for (int c = 0; c < 3; ++c) {
      const double extinction = static_cast<double>(water.absorption[static_cast<std::size_t>(c)]) +
                                static_cast<double>(water.scattering);
      // Radiance goes with the square of the index.
      EXPECT_NEAR(seen[c],
                  lamp.emission * (1.0 - reflected) / (1.333 * 1.333) * std::exp(-way * extinction),
                  1e-5);
    }
  }
}

TEST(ReferenceLight, WaterMirrorsWhatARayMeets) {
  // A wall of water, without ripples, and opposite to it one of lamps that begins at z = 8.
  const Island walls{world::Volume::from_voxels({-7, -9, -30}, {3, 9, 30}, [](world::IVec3 v) {
    if (v.x >= 0) return world::BlockId{world::block::kWater};
    return world::BlockId{v.x == -7 && v.z >= 8 ? world::block::kLamp : world::block::kAirBlock};
  })};
  const double emission = world::block_types()[world::block::kLamp].emission;
  for (const double slant : {0.5, 1.0, 2.0}) {
    const glm::dvec3 forward = glm::normalize(glm::dvec3(1.0, 0.0, slant));
    const Scene scene = seen_from({-3.0, 0.5, 0.5}, forward, {walls}, 1, 1e-6);
    const double r0 = std::pow(0.333 / 2.333, 2.0);
    const double reflected = r0 + (1.0 - r0) * std::pow(1.0 - forward.x, 5.0);
    const double met_at = 0.5 + slant * 9.0;  // z
    const double expected = met_at >= 8.0 ? emission * reflected : 0.0;
    EXPECT_NEAR(render(scene, samples(1)).radiance.pixels[0].x, expected, 1e-5) << slant;
  }
}

TEST(ReferenceLight, CornersDarkenAFaceByTheirStrength) {
  // A step: the floor's edge at x = 0 lies under a wall that fills x < 0.
  const Island step{world::Volume::from_voxels({-9, -2, -9}, {9, 3, 9}, [](world::IVec3 v) {
    return world::BlockId{v.y < 0 || v.x < 0 ? world::block::kStone : world::block::kAirBlock};
  })};
  for (const double strength : {0.0, 0.5, 1.0}) {
    Scene scene = seen_from({0.25, 4.0, 0.5}, {0.0, -1.0, 0.0}, {step}, 1, 1e-6);
    scene.bodies = {{{0.0, 1.0, 0.0}, glm::dvec3(kPi), 0.0}};
    scene.ao_strength = strength;
    // At the wall both corners have it beside and across: ao 1/3, a block away 1.
    const double ao = 1.0 / 3.0 + 0.25 * 2.0 / 3.0;
    EXPECT_NEAR(render(scene, samples(1)).radiance.pixels[0].x, 1.0 - strength * (1.0 - ao), 1e-5);
  }
}

}  // namespace
}  // namespace skerry::reference
