#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/building.hpp"
#include "simulation/plan_distortion.hpp"
#include "simulation/plan_picture.hpp"
#include "simulation/random_building.hpp"
#include "simulation/simulated_robot.hpp"

namespace smokemap {

constexpr std::uint64_t kDemoSeed = 7;

/// Where the commander says the robot starts, on the plan.
struct StartHint {
  Point2 layout_px = Point2::Zero();
  double heading_rad = 0;  ///< counter-clockwise from the picture's +x
};

/// A two-wing building (about 30 x 20 m) with a fire and smoke in part of the far wing, an evacuation plan of it that
/// is wrong the way real ones are (10 % local stretch, one wall not drawn, one drawn that is gone), a robot at the
/// entrance and the truth. The robot's first pose is the origin of `map`.
struct DemoScenario {
  std::uint64_t seed = kDemoSeed;
  FloorPlan building;  ///< frame world
  DistortedPlan plan;
  PlanPicture picture;
  TrueLayout truth;
  SimulatedWorld world;
  Pose2 T_world_start;
  StartHint start;  ///< with the error of a finger: about 0.2 m and 3 degrees
  StartHint true_start;
  Point2 p_world_fire = Point2::Zero();
  std::string far_room;  ///< a room that cannot be seen from the start; the way is hazy at most
  Point2 p_world_far_room = Point2::Zero();
  Point2 far_room_px = Point2::Zero();  ///< the same place on the plan

  Point2 to_map(const Point2& p_world) const { return T_world_start.inverse() * p_world; }
};

/// Variations of the demo, for measuring.
struct DemoParams {
  RandomBuildingParams building = demo_building();
  PlanDistortionParams distortion = demo_distortion();
  bool fire = true;
  double burning_s = 240;       ///< before the robot comes
  double sigma_start_m = 0.15;  ///< of the start hint, per coordinate
  double sigma_start_rad = 0.05;
  Result<Ok> validate() const;

  static RandomBuildingParams demo_building();    ///< a little furniture
  static PlanDistortionParams demo_distortion();  ///< one wall missing, one phantom
};

/// The same seed gives the same demo, byte for byte. Takes about 0.15 s. kInvalidArgument for bad parameters.
Result<DemoScenario> make_demo(std::uint64_t seed = kDemoSeed, const DemoParams& params = {});

/// The same around a building from elsewhere (its first room is where the robot starts, unless a start is given);
/// `params.building` is not used. kDegenerate as well if hardly a room can be reached.
Result<DemoScenario> make_demo_in(FloorPlan building, const std::optional<Pose2>& T_world_start, std::uint64_t seed,
                                  const DemoParams& params = {});

/// How a pose in the true building looks on the plan, which is wrong: what a person who knows both would point at.
StartHint point_on_plan(const DemoScenario& demo, const Pose2& T_world_robot);

/// The robot of the demo at its start.
SimulatedRobotParams demo_robot_params(const DemoScenario& demo);

}  // namespace smokemap
