#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "grids/grid_frame.hpp"
#include "simulation/building.hpp"
#include "simulation/segment_world.hpp"

namespace smokemap {

struct PathDriverParams {
  double radius_m = 0.25;
  double margin_m = 0.08;  ///< kept from walls besides the radius
  double cell_m = 0.1;
  double speed_mps = 0.5;
  double turn_rate_radps = 1.0;
  double look_ahead_m = 0.4;
  double arrive_m = 0.15;
  Result<Ok> validate() const;
};

struct VelocityCommand {
  double speed_mps = 0;
  double turn_rate_radps = 0;
};

/// A driver that knows the true world: plans with A* over its free space and follows the way. For making whole runs
/// without any other module; it sees what no robot sees.
class PathDriver {
 public:
  PathDriver(const SegmentWorld& world, const PathDriverParams& params = {});

  /// The way for a robot's centre, start and goal included. kDegenerate if there is none.
  Result<std::vector<Point2>> plan(const Point2& from, const Point2& to) const;
  /// Takes on a list of places to visit, in order. Places that cannot be reached are left out; returns how many are
  /// left.
  std::size_t visit(const Point2& from, const std::vector<Point2>& waypoints);
  /// What to tell the robot now; zero when everything was visited.
  VelocityCommand drive(const Pose2& T_world_robot);
  bool done() const { return next_ >= path_.size(); }

 private:
  PathDriverParams params_;
  GridFrame frame_;
  std::vector<float> clearance_m_;
  std::vector<Point2> path_;
  std::size_t next_ = 0;
};

/// One place in every room, nearest first from `from`: a tour. Corridors get a place at each end.
std::vector<Point2> room_tour(const FloorPlan& building, const Point2& from);
/// The same shared out: one robot after the other takes the place that is nearest to where it will be.
std::vector<std::vector<Point2>> room_tours(const FloorPlan& building, const std::vector<Point2>& from);

}  // namespace smokemap
